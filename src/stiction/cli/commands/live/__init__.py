"""Commands with which one sees and hears a motion: each has one file."""
