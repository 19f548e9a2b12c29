"""A measured record beside an audit: fit, predictive check, and a verdict."""
