"""Analysis of runs and measured records: motion, cycles, creep, oscillation, energy."""
