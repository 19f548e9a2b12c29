"""Drawings of the apparatus: from above, from the side, and its vectors."""
