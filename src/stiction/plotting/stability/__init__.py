"""Figures of linear stability: modes, boundaries, damping, onset."""
