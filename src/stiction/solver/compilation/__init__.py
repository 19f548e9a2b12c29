"""How the solver is compiled, kept on disk, and interrupted."""
