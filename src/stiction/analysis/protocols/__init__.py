"""The results of named friction tests: healing, velocity steps, hysteresis, yaw sweeps."""
