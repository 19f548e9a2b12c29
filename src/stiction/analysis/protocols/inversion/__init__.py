"""Inversion of a velocity step for a rate-and-state law: the fit of its curve on the rig."""
