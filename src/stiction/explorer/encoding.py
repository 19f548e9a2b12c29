"""One message to the page: a JSON head, then arrays as they lie in memory.

The first four bytes are the length of the head (little-endian); the head is padded with spaces so
that the arrays begin at a multiple of eight, as typed arrays of the browser need it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from struct import pack
from typing import Any

import numpy as np

ALIGNED = 8  # bytes


def encode(head: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return a message of a head and named arrays.

    Examples
    --------
    >>> message = encode({"reply": "run"}, {"time": np.array([0.0, 1.0])})
    >>> message[-16:] == np.array([0.0, 1.0]).tobytes()
    True
    """
    parts: list[bytes] = []
    places: list[list[Any]] = []
    offset = 0
    for name, values in arrays.items():
        content = values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes()
        places.append([name, values.dtype.str[1:], list(values.shape), offset])
        content += bytes(-len(content) % ALIGNED)
        parts.append(content)
        offset += len(content)
    text = json.dumps(finite({**head, "arrays": places}), allow_nan=False).encode()
    text += b" " * (-(len(text) + 4) % ALIGNED)
    return b"".join([pack("<I", len(text)), text, *parts])


def finite(value: Any) -> Any:
    """Return a value for JSON, which has neither NaN nor infinity: None stands for them."""
    if isinstance(value, Mapping):
        return {str(key): finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [finite(each) for each in value]
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not isfinite(value) else value
