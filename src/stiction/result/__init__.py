"""The result of a run: labelled tables, and the file that holds them."""
