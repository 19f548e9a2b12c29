"""Fits, mechanisms and designs held against simulated records that no part has seen."""
