"""Doubts about a record: numbers that contradict each other, and what samples do not show."""
