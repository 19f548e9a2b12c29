"""The progress of long work: who is told, and how."""
