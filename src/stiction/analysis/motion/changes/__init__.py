"""Changes within a record: a drive that turns or changes its speed, and cycles of another kind."""
