"""Turning points, swings and kinds of motion of runs, whose samples have rates and no noise."""
