"""The statements of the lines above the samples: interval, number of samples, wall clock."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from stiction.formats.table import Remark
from stiction.formats.units import size_of

NUMBER = r"([+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?)"
INTERVAL = re.compile(
    r"\b(?:(?:sampl\w*|scan|time)[ _-]?(?:interval|period|step|increment)|interval|dt|"
    r"delta[ _]?[tx]|abtast(?:zeit|intervall))\b"
    rf"\W{{0,6}}(?:\[(\w+)\]\W*|\((\w+)\)\W*)?{NUMBER}\s*([a-zA-Zµμ]*)",
    re.I,
)
RATE = re.compile(
    r"(?:sampl\w*|scan|acquisition|abtast\w*|data)[ _]?(?:rate|frequency|freq|frequenz)"
    rf"\W{{0,6}}(?:\[([\w/]+)\]\W*|\(([\w/]+)\)\W*)?{NUMBER}\s*([a-zA-Z]*(?:/s)?)",
    re.I,
)
COUNT = re.compile(
    r"(?:(?:number|no\.?|#) of |n_?|num_?|total )?(?:samples|points|rows|values|data points|"
    r"messwerte|anzahl)\W{1,6}(\d+)\W*$",
    re.I,
)
WALL = re.compile(
    r"(\d{4}-\d{2}-\d{2}[ T]\d{2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?|"
    r"(?:\d{1,2}[./]\d{1,2}[./]\d{2,4}\W{1,3})?\d{1,2}:\d{2}:\d{2}(?:[.,]\d+)?(?: ?[AP]M)?)"
)
HERTZ = {"hz": 1.0, "khz": 1e3, "mhz": 1e6, "s/s": 1.0, "": 1.0, "sps": 1.0, "/s": 1.0}


class Said(NamedTuple):
    """The statements of remarks, each None or '' without one."""

    interval: float | None
    stated: str
    promised: int | None
    start: str


def what_is_said(remarks: Iterable[Remark]) -> Said:
    """Return interval (s), its text, number of samples and wall clock; the last of each counts."""
    interval, stated, promised, start = None, "", None, ""
    for remark in remarks:
        text = remark.text.strip().strip('"')[:400]
        if found := INTERVAL.search(text):
            size = size_of(found[4] or found[1] or found[2] or "s", "s")
            value = _number(found[3])
            if size is not None and value > 0.0:
                interval, stated = value * size.value, f"{found[3]} {found[4] or 's'}"
        if found := RATE.search(text):
            size_hz = HERTZ.get((found[4] or found[1] or found[2] or "").lower())
            value = _number(found[3])
            if size_hz is not None and value > 0.0:
                interval, stated = 1.0 / (value * size_hz), f"1/({found[3]} {found[4] or 'Hz'})"
        if found := COUNT.search(text):
            promised = int(found[1][:15])
        if found := WALL.search(text):
            start = found[1]
    return Said(interval, stated, promised, start)


def _number(text: str) -> float:
    return float(text.replace(",", "."))
