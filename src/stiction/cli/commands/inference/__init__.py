"""Commands that infer from records: fit and design."""
