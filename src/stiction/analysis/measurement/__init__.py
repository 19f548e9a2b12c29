"""Measured records: read from files, made from runs, and checked against what is stated."""
