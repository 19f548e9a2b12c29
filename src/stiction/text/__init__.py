"""Text: quantities with units, TOML, faults by path, and what reports are made of."""
