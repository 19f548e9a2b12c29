"""What is simulated: slider, start and settings, read from a description and written back."""
