"""Code of the user's own in a description or a study: found, run if it may be, and kept as text."""
