"""Summary of a study's runs: how many succeeded, and why others failed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.study.plan.coordinates import values_at
from stiction.study.plan.study import Study
from stiction.study.store.store import COMPLETED, ENDS, PENDING, Store
from stiction.study.view.view import undetermined_in_words
from stiction.text.sections import Section, as_html, as_text


class Failure(NamedTuple):
    """A failed run: its coordinates with units, its status, and the reason."""

    at: Mapping[str, tuple[float, str]]
    end: str
    message: str

    def __str__(self) -> str:
        """Return the run's parameters and the message."""
        where = ", ".join(
            f"{path} = {value:.6g} {its}".rstrip() for path, (value, its) in self.at.items()
        )
        return f"{where}: {self.message}"


class Summary(NamedTuple):
    """Numbers of a study's runs by their outcome, and the first failure.

    Parameters
    ----------
    runs, pending : int
        Runs in all, and those not done.
    failed : mapping of str to int
        Number of failed runs for each way to fail.
    first : Failure or None
        The first failed run.
    store : Path
        The store of the runs.
    undetermined : sequence of str
        Why each run that ended well has no value for some measures.
    """

    runs: int
    pending: int
    failed: Mapping[str, int]
    first: Failure | None
    store: Path = Path()
    undetermined: Sequence[str] = ()

    def __repr__(self) -> str:
        """Return a one-line summary."""
        failed = sum(self.failed.values())
        return f"<Sweep {self.store}: {self.runs - self.pending} of {self.runs}, {failed} failed>"

    def __str__(self) -> str:
        """Return the report as text."""
        return as_text(self.tables())

    def tables(self) -> list[Section]:
        """Return how the runs ended, and the first failure, as sentences."""
        lines = [f"{self.runs - self.pending} of {self.runs} runs are done."]
        if self.first is not None:
            counts = (f"{count} {end.replace('_', ' ')}" for end, count in self.failed.items())
            many = sum(self.failed.values())
            lines.append(f"{many} failed ({', '.join(counts)}); the first at {self.first}")
        if self.undetermined:
            lines.append(f"{undetermined_in_words(self.undetermined, self.runs)}.")
        return [Section(str(self.store), lines)]

    def _repr_html_(self) -> str:
        from stiction.plotting.page.save import picture

        return as_html(self.tables()) + picture(self.plot)

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw the results; see `stiction.map`."""
        from stiction.study.view.mapping import map

        return map(self.store).plot(axes)


def summary(study: Study, store: Store) -> Summary:
    """Count how the runs in a store ended."""
    status = store.status()
    codes, counts = np.unique(status, return_counts=True)
    found = dict(zip(codes.tolist(), counts.tolist(), strict=True))
    pending = found.pop(PENDING, 0)
    found.pop(COMPLETED, None)
    failed = {ENDS[code]: count for code, count in found.items()}
    messages = store.messages()[status == COMPLETED]
    unknown = [str(each) for each in messages if each]
    first = None
    if failed:
        flat = int(np.argmax(status.ravel() > COMPLETED))
        index = tuple(int(i) for i in np.unravel_index(flat, status.shape))
        at = dict(zip(store.layout.dims, index, strict=True))
        first = Failure(values_at(study.coordinates, at), ENDS[status[index]], store.message(index))
    return Summary(status.size, pending, failed, first, store.path, unknown)
