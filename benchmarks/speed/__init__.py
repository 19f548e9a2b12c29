"""Speed: scaling, start-up, studies, memory."""
