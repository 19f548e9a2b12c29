"""Doubts about a record: contradictory numbers, and motion that the samples do not resolve."""
