"""Exploration at random: what a docstring promises, held on thousands of systems."""
