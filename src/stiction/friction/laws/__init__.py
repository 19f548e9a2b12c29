"""Friction laws, one file a law; `stiction.friction.LAWS` registers them."""
