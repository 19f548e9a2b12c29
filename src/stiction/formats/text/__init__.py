"""Tables in files of text."""
