"""Figures of friction tests with a name."""
