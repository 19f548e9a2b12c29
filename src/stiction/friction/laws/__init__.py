"""Friction laws, one file for each; `stiction.friction.LAWS` registers them."""
