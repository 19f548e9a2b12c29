"""What is to be run: a base, axes over its parameters, and how the runs lie along them."""
