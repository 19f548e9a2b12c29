"""Common parts of figures: canvas, style, words, and units of axes."""
