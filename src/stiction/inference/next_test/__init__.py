"""What to measure next: the further test that tells most about a parameter of a rig."""
