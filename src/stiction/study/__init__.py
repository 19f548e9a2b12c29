"""Studies: many runs over axes of parameters, kept in a store that can be gone on with.

What to run: a `plan` has `axes` over `parameters`, whose `coordinates` lie in a `layout` of
blocks; `presets` are ready ones. What to keep: `measures` and `traces` of what was `observed`,
by its `features` and `regimes`. Doing it: `sweeping` has an engine (`engines`, `cluster`) do each
block, a `task`, into the `store`; `refining` halves `intervals` in which the motion changes.
Looking at it: a `view` of the store, `mapping` with the `boundaries` that theory expects.
"""
