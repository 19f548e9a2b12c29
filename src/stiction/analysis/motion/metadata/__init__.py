"""What a record says of its apparatus, beside what is stated of it."""
