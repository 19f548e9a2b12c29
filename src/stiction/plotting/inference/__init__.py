"""Figures of fits: the knowledge of parameters before and after a measurement."""
