"""From a description to samples and stick intervals.

`integrate` runs one of three solvers over the `segments` of time in which drive and load are
smooth: `exact` for set-valued friction; `multiscale`, the same with many cycles at once; `smooth`
for laws with internal state, and for set-valued laws made smooth. `compilation` is how they are
compiled, `reference` is the exact solver once more by textbook means, to be read and to check it.

The method is derived in docs/method.md; docstrings cite its equations as (M1), (M2), ...
"""
