"""A load cell that rings after each slip: its swings, and the force to which it answered."""
