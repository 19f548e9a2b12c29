"""The paper reproduced: its figures and numbers, each beside what is computed."""
