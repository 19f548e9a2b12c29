"""From a description to samples and stick intervals.

`integrate` runs one of three solvers over the `segments` of time in which drive and load are
smooth: `exact` for set-valued friction; `multiscale`, which also interpolates between cycles;
`smooth` for laws with internal state, and for regularised set-valued laws. `compilation` compiles
them; `reference` repeats the exact solver by textbook means, for readers and as a check.

The method is derived in docs/method.md; docstrings cite its equations as (M1), (M2), ...
"""
