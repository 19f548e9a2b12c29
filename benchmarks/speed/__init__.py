"""How fast: scaling, start-up, studies, memory."""
