"""Whether the friction force turns, of random rigs with a force across the drive."""
