"""Random apparatus, each by its seed and number."""
