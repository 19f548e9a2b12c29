"""The place of `stiction.text.units` up to version 0.4: laws of users, also in results, name it."""

from typing import Any

from stiction.names import warn_renamed
from stiction.text import units


def __getattr__(name: str) -> Any:
    found = getattr(units, name)
    if not name.startswith("__"):
        warn_renamed(f"{__name__}.{name}", f"{units.__name__}.{name}")
    return found
