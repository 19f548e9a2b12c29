"""The solver of `stiction` beside its peers, on one case: ``python -m benchmarks``."""
