"""Inference: what records say about the parameters of a rig, and how surely."""
