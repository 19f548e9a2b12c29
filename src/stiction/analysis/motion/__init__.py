"""Which motion a force shows: its cycles, its regime, its friction, and what is doubtful."""
