"""Users' laws: finding, loading, storing with their text, and checking them."""
