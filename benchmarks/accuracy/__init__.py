"""Accuracy: known solutions, convergence, conservation, linear theory."""
