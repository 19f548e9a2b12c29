"""Execution of a study: engines, tasks, the sweep over missing runs, refinement, repair."""
