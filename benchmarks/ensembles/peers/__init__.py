"""Ways to integrate the ensemble: one library a file, each with ``contestants()``."""
