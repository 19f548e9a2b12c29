"""The drive of a record, as its measured displacement shows it."""
