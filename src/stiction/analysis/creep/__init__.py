"""Creep before slip: its curves, their divergence, and the implied misalignment."""
