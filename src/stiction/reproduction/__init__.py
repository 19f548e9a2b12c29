"""Reproduction of the paper: its figures, and its numbers beside the computed ones."""
