"""Laws of the user's own: found, run or not, kept with their text, and checked."""
