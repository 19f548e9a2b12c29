"""The next test: the further test that narrows a parameter of a rig most."""
