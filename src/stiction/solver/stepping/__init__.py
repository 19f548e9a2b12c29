"""The common parts of both solvers' steps.

The collocation method (`radau`) and its linear equations (`block_algebra`), the rules for the end
of an iteration and the size of the next step (`control`), how long a step about steady sliding may
be (`limit`), and how small disturbances of it grow (`amplification`).
"""
