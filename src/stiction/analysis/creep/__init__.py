"""Creep before slip: its curves, how they diverge, and the misalignment that they imply."""
