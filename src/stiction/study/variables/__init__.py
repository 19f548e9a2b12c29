"""Variables that a study stores of each run: measures and traces."""
