"""The kind of motion in a record: its confidence, and what it rests on."""
