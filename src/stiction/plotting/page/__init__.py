"""What every figure rests on: canvas, style, words and units along its axes."""
