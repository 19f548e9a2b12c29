"""Contestants, each library in a process of its own, timed side by side."""
