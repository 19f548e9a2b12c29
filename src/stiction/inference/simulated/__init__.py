"""Records simulated with parameters drawn from the priors, jitter and sensor inside."""

SIMULATIONS = 4000  # of a library, by default
