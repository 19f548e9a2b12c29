"""Figures of runs: over time, side by side, and the law that they follow."""
