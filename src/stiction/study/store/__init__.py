"""The store of a study: layout, creation, writing, sealing and checking."""
