"""Studies: many runs over axes of parameters, kept in a store that can be gone on with.

`plan` says what to run (`axes`, `parameters`, `coordinates`), `layout` in which blocks. A `task`
does one block: it runs (`observed`), takes `measures` and writes the `store`. `engines` have
tasks done, and `sweeping` puts it together.
"""
