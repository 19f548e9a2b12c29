"""A run to hear and to watch: its transverse oscillation as sound, its motion as a film."""
