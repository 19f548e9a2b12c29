"""User code in a description or a study: found, run if permitted, and stored as text."""
