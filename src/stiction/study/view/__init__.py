"""What is seen of a study: cuts through it, its map, and how its runs ended."""
