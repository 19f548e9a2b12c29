"""Parts of compiled code, to be called from a test."""

import numba


def entry(part):
    """Return what Python can call in place of `part`, which compiled code alone can call."""
    return numba.njit(lambda *arguments: part(*arguments))
