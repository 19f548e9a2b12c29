"""The plan of a study: a base description, axes over its parameters, and the grid of runs."""
