"""Studies: many runs over axes of parameters, in a store that can be continued.

`plan` defines the runs; `presets` are ready plans; `variables` are kept of each run; `store` writes
them in blocks; `execution` does the runs; `view` shows them.
"""
