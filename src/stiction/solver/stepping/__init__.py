"""What the steps of both solvers share.

The collocation method (`radau`) and its linear equations (`block_algebra`), the rules for the end
of an iteration and the size of the next step (`control`), and how small disturbances of steady
sliding grow (`amplification`).
"""
