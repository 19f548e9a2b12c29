"""Files of measured records: their columns, and what each column is."""
