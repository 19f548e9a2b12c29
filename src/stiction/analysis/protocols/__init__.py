"""What a friction test with a name measures: healing, velocity steps, hysteresis, yaw sweeps."""
