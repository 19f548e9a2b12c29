"""The speed of this tree against another revision of it: ``python -m benchmarks.against``."""
