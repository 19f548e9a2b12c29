"""Inference: estimation of a rig's parameters from records, with uncertainties."""
