"""Measured records: which column of a file is which channel, and what is known beside it."""
