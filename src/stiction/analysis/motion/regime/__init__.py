"""The kind of motion in a record: its confidence, and its evidence."""
