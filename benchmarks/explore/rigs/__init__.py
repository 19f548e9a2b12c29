"""Random planar rigs against the readable reference."""
