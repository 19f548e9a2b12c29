"""The lines of a file of text in any usual encoding, which may be compressed with gzip."""

from __future__ import annotations

import codecs
import gzip
import re
import zlib
from pathlib import Path

from stiction.errors import ResultError
from stiction.formats import HEAD
from stiction.machine import largest_object
from stiction.storage.foreign import refuse_size

COPIES = 12  # of a file's bytes in memory: its text, its lines, its numbers
LINE_END = re.compile("\r\n|\n|\r")
GZIP = b"\x1f\x8b"
CONTROLS = {*range(32)} - {*b"\t\n\v\f\r\x1a\x1b"}  # bytes that no text has
MARKS = {  # byte-order marks, the longer first
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF32_LE: "utf-32",
    codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}


def lines_of(path: Path, largest: float) -> list[str]:
    """Return the lines of a file of text of `largest` bytes at most, perhaps packed by gzip.

    Raises
    ------
    ResultError
        If it is not text, or too large, for this machine too.
    """
    _refuse_length(path, path.stat().st_size, largest)
    raw = path.read_bytes()
    if raw.startswith(GZIP):
        raw = _unpack(path, largest)
    for mark, name in MARKS.items():
        if raw.startswith(mark):
            return _lines(path, raw, name)
    try:
        return _lines(path, raw, "utf-8")
    except ResultError:
        if b"\0" in raw[:4096]:
            raise
        return _lines(path, raw, "cp1252")  # Western instruments: µ and °


def _lines(path: Path, raw: bytes, encoding: str) -> list[str]:
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError as error:
        if set(raw[:HEAD]) & CONTROLS:
            raise ResultError(
                f"{path}: is not text, nor does it begin as a file of another kind that is read "
                "here; if it should, it is damaged: copy it again; save text as UTF-8"
            ) from None
        line = len(LINE_END.findall(raw[: error.start].decode("latin-1"))) + 1
        raise ResultError(
            f"{path}: line {line} is not text in {encoding}; save it as UTF-8"
        ) from None
    if "\0" in text:
        line = len(LINE_END.findall(text[: text.index("\0")])) + 1
        raise ResultError(f"{path}: line {line} holds a zero byte: this is not a file of text")
    return LINE_END.split(text)


def _unpack(path: Path, largest: float) -> bytes:
    most = int(min(largest, largest_object() / COPIES))
    try:
        with gzip.open(path) as file:
            raw = file.read(most + 1)
    except (OSError, EOFError, zlib.error) as error:
        raise ResultError(f"{path}: is damaged, gzip says: {error}; copy it again") from None
    _refuse_length(path, len(raw), largest)
    return raw


def _refuse_length(path: Path, size: int, largest: float) -> None:
    if size > largest:
        raise ResultError(f"{path}: has more than {largest:,.0f} bytes; thin its rows")
    refuse_size(path, COPIES * float(size))
