"""The properties of the apparatus that a record shows, beside the stated ones."""
