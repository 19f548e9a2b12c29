"""The store of a study: how it is laid out, made, written, sealed, checked and repaired."""
