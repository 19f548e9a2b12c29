"""Commands of studies: sweep, map."""
