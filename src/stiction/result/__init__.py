"""The result of a run: labelled tables and their file."""
