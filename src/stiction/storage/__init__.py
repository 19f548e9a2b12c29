"""Files: written whole or not at all, with checksums, and checked before they are read."""
