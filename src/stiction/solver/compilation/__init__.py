"""Compilation of the solver, its cache on disk, and interrupts."""
