"""Checksums (CRC-32C, as in zarr's chunks), which reveal damaged data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import inf
from pathlib import Path
from typing import Any

import google_crc32c
import numpy as np

LENGTH = 4  # bytes that a checksum adds to a chunk
BLOCK = 2**20  # bytes of a file that are read at a time


def crc(content: Any) -> int:
    """Return the checksum of bytes or of an array."""
    return int(google_crc32c.value(content))


def with_checksum(content: bytes) -> bytes:
    """Append the checksum to bytes."""
    return content + crc(content).to_bytes(LENGTH, "little")


def crc_of_file(path: str | Path, size: float = inf) -> bytes:
    """Return the checksum of a file, or of its first `size` bytes."""
    found, left = 0, size
    with open(path, "rb") as file:
        while left > 0 and (block := file.read(int(min(left, BLOCK)))):
            found, left = google_crc32c.extend(found, block), left - len(block)
    return int(found).to_bytes(LENGTH, "little")


def without_checksum(content: bytes) -> bytes | None:
    """Return bytes without their checksum; None if the checksum does not match."""
    inner = content[:-LENGTH]
    return inner if with_checksum(inner) == content else None


def seal(parts: Mapping[str, Any]) -> str:
    """Return the checksums of named parts as text."""
    return json.dumps({name: f"{crc(content):08x}" for name, content in parts.items()})


def broken_parts(sealed: str, parts: Mapping[str, Any]) -> list[str]:
    """Return the parts that have changed since they were sealed, or are missing."""
    try:
        known = dict(json.loads(sealed))
    except (ValueError, TypeError):
        return ["checksums"]
    made = {name: f"{crc(parts[name]):08x}" for name in known if name in parts}
    return [name for name, value in known.items() if made.get(name) != value]


def bytes_of(values: np.ndarray) -> Any:
    """Return an array's values as bytes, in the same byte order on every machine."""
    if values.dtype.kind in "OUST":  # text
        return "\0".join(map(str, values.ravel())).encode()
    return np.ascontiguousarray(values.astype(values.dtype.newbyteorder("<"), copy=False))
