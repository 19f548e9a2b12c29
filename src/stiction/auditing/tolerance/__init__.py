"""The tolerance budget of a rig: what a test reads over the range of an uncertain misalignment."""
