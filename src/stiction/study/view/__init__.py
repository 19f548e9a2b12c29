"""Views of a study: cuts, maps, and a summary of how its runs ended."""
