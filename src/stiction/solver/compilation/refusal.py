"""The reasons why a user's law cannot be compiled, a line for each method."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from typing import Any

import numba
from numba.core.errors import NumbaError, UnsupportedBytecodeError

REFUSED = NumbaError, UnsupportedBytecodeError  # of numba; the latter derives from Exception alone
METHODS = {  # with arguments for a trial
    "coefficient": (1e-3,),
    "slope": (1e-3,),
    "force": ((1e-3, 0.0), 1.0),
    "change": ((1e-3, 0.0), 1.0),
}
REMEDY = (
    "use floats, tuples, `math` and the law's own fields, and decorate functions that it calls "
    "with numba.njit"
)


def reasons(law: Any) -> Iterator[str]:
    """Yield the reason for each method that cannot be compiled by itself."""
    law = getattr(law, "prepare", lambda: law)()
    for name, arguments in METHODS.items():
        method = getattr(type(law), name, None)
        if method is None:
            continue
        state = (law.settled(1e-3),) if name in ("force", "change") else ()
        try:
            numba.njit(error_model="numpy")(method)(law, *arguments, *state)
        except REFUSED as error:
            yield f"{name} cannot be compiled: {reason(error)}; {REMEDY}"


def reason(error: Exception) -> str:
    """Return the first informative line of numba's message, and the place in the file."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    telling = [line for line in lines if not line.startswith("Failed in nopython mode")]
    places = re.findall(r'File "([^"]+)", line (\d+)', text)
    where = next((p for p in places if f"numba{os.sep}" not in p[0]), None)
    at = f" ({os.path.basename(where[0])}, line {where[1]})" if where else ""
    return f"{telling[0].rstrip(':')}{at}" if telling else type(error).__name__
