"""Figures of an analysis: cycles, creep, oscillation, energy."""
