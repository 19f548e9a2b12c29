"""Views of a study: cuts, maps, and a summary of its runs."""
