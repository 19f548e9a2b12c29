"""What a step of the drive tells of a rate-and-state law: the fit of its curve on the rig."""
