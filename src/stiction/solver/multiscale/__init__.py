"""Many stick-slip cycles at once, by the return map from one stick to the next."""
