"""Drives and loads that follow a recorded table."""
