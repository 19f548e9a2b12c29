"""Commands that infer from records: fit."""
