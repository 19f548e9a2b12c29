"""Ways to integrate the case, ours and other people's: one library a file.

Each has a function ``contestants()``, called in a process of its own, in which it imports what it
needs; an ImportError says that the library is not there.
"""

from __future__ import annotations

from typing import NamedTuple


class Peer(NamedTuple):
    """A library: the module here that uses it, and how it is called."""

    module: str
    name: str
    interpreter: str | None = None  # where it is not the one that runs


# those that take long come last: each may use what the ones before it leave of the time
PEERS = (
    Peer("ours", "stiction"),
    Peer("numbalsoda", "numbalsoda"),
    Peer("scipy", "SciPy"),
    Peer("sundae", "CVODE (scikit-sundae)"),
    Peer("jitcode", "JiTCODE"),
    Peer("siconos", "Siconos", "/usr/bin/python3"),  # Debian's
    Peer("runge_kutta", "RK4, fixed step"),
    Peer("heyoka", "heyoka"),
    Peer("diffrax", "diffrax"),
)
