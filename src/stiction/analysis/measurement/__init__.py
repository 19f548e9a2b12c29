"""Measured records: read from files, made from runs, and compared with stated values."""
