"""The apparatus of a rig as its records measured it."""
