"""Measured records: the channels of a file's columns, and the further knowledge of them."""
