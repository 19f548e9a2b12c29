"""What a study keeps of each run: measures and traces, and how they are found."""
