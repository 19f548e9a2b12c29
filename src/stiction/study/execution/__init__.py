"""Doing a study: engines, the tasks they do, the sweep over what is missing, and refinement."""
