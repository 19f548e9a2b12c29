"""The published systems of `stiction.presets`, each with the numbers that must come out."""

from __future__ import annotations

from functools import partial

import stiction as st
from benchmarks.cases.case import Case
from stiction.presets import PRESETS, Number, Preset


def published_cases(preset: Preset, rtol: float) -> list[Number]:
    """Run a preset; return its published numbers beside those found."""
    description = preset.make()
    settings = description.run.model_dump(exclude_none=True) | {"rtol": rtol}
    return preset.numbers(st.run(description._replace(run=st.Settings(**settings))))


CASES = tuple(
    Case(name, partial(published_cases, each), each.make().run.rtol)
    for name, each in PRESETS.items()
)
