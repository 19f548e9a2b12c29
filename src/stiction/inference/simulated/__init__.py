"""Records simulated with parameters drawn from the priors, jitter and sensor inside."""
