"""Random planar rigs against the readable twin."""
