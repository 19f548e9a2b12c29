"""Draws what it is given, on the axes it is given; nothing global, nothing shown."""
