"""Studies: many runs over axes of parameters, kept in a store that can be gone on with.

What to run: a `plan` has `axes` over `parameters`; `presets` are ready ones. What to keep of each
run: `variables`. Where: a `store`, in blocks. Doing it: `execution`. Looking at it: `view`.
"""
