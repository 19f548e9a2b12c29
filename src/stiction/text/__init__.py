"""Text: quantities with units, TOML, faults with their paths, sections of reports."""
