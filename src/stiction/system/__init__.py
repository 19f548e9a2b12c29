"""Slider, initial state and settings of a run, read from a description and written back."""
