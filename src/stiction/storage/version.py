"""The version of this package, which files and results state."""

from functools import cache
from importlib.metadata import version


@cache
def own_version() -> str:
    """Return the installed version, read once: its file takes a millisecond to parse."""
    return version("stiction")
