"""Variables that a study keeps of each run: measures and traces."""
