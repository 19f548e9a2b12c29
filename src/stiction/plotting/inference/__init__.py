"""Figures of fits: what is known before and after a measurement."""
