"""Learning from a library: a summary of features, posteriors from it, and their calibration."""
