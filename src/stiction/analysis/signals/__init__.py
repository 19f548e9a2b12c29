"""Signals: turning points, lines, spectra and wild samples of any series of numbers."""
