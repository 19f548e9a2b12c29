"""One quantity as text: read, and written."""
