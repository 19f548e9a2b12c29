"""Whether this tree is slower than another revision of it: ``python -m benchmarks.against``."""
