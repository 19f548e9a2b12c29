"""The report of an audit in words and tables: a section a file."""
