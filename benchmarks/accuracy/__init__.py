"""How right: known solutions, convergence, conservation, linear theory."""
