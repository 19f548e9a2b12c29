"""One apparatus under several friction laws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from stiction.analysis.slip import outcome
from stiction.errors import DescriptionError, Fault
from stiction.friction import Law, name_of, parameters
from stiction.laws import exchanged, read_laws
from stiction.machine import shortage
from stiction.simulation import automatic_times, run
from stiction.system.description import SAMPLE, Description, description_of
from stiction.text.sections import Section, Table, as_html, as_text
from stiction.trajectory import Trajectory

HEADINGS = (
    "law", "sticks", "stuck (s)", "largest k_x u_x/W", "fastest slip (m/s)",
    "slowest in load-up (m/s)", "median in load-up (m/s)",
)  # fmt: skip


REST = 1e-9  # of the drive's speed: what is slower rests, in any test


class Comparison(dict[str, Trajectory]):
    """Runs of one apparatus under several friction laws, by the name of the law.

    The description's own law is the first.
    """

    def __repr__(self) -> str:
        """Name the laws."""
        return f"<Comparison of {', '.join(self)}>"

    def __str__(self) -> str:
        """Return the report as text."""
        return as_text(self.tables())

    def _repr_html_(self) -> str:
        return as_html(self.tables())

    @property
    def ok(self) -> bool:
        """Whether every run reached its duration."""
        return all(run.status.ok for run in self.values())

    def tables(self) -> list[Section]:
        """Return a table with a row for each law."""
        rows = [row(label, run) for label, run in self.items()]
        early = [
            f"{label} ended early: {run.status.value}."
            for label, run in self.items()
            if not run.status.ok
        ]
        return [Section("Friction laws", early, Table(HEADINGS, rows))]

    def plot(self, axes: Any = None) -> Any:
        """Draw the runs together; see `stiction.plotting.plot_comparison`."""
        from stiction.plotting import plot_comparison

        return plot_comparison(self, axes)


def row(label: str, run: Trajectory) -> tuple[str, ...]:
    """Return the row of one law."""
    o = outcome(run)
    least = REST * float(np.hypot(run.data["drive_X"], run.data["drive_Y"]).max())
    speeds = (f"{v if v > least else 0.0:.3g}" for v in (o.fastest, o.slowest, o.creep))
    stuck = (str(o.sticks), f"{o.time_stuck:.3g}")
    return label, *stuck, f"{o.peak:.4f}", *speeds


def sampled(description: Description) -> Description:
    """Return the description with a sample rate, which a figure over time needs.

    Where it asks for none it is that of `simulate`, of the description's own law for all.
    """
    if description.run.sample_rate:
        return description
    settings = description.run.model_dump(exclude_none=True)
    rate = (len(automatic_times(description)) - 1) / description.run.duration
    return description._replace(run=type(description.run)(**(settings | {"sample_rate": rate})))


def compare(
    description: Description | str | Path,
    laws: Sequence[Law | Mapping[str, Any] | str | Path],
    *,
    max_steps: int = 100_000_000,
    progress: Callable[[float], None] | None = None,
) -> Comparison:
    """Simulate one apparatus under its own friction law and under others.

    Parameters
    ----------
    description : Description, str or Path
        What is run, or its file; only its friction law is exchanged.
    laws : sequence of law, mapping, str or Path
        Each a friction law; a table as in a description; the same written as text, e.g.
        ``'{law = "coulomb", mu_0 = 0.15}'``; a description file, of which the table [friction]
        is taken; ``file.py:Class``; or a law's bare name, e.g. ``"coulomb"``. A law given by
        name alone gets parameters that make it comparable with the description's own, see
        `stiction.laws.comparable`; the name of the description's own law means that one, which
        is run once.
    max_steps : int, optional
        Each run gives up after so many steps.
    progress : callable, optional
        Called with the fraction of all runs done.

    Returns
    -------
    Comparison
        A mapping: the run by the name of the law, with the parameters that differ where a name
        occurs twice; the description's own law first. With ``tables()`` and ``plot()``.

    Raises
    ------
    DescriptionError
        With every law that cannot be read, at once.
    """
    description = sampled(description_of(description))
    own = description.slider.law
    others = read_laws(description, [laws] if isinstance(laws, str | Path) else laws)
    all_laws = [own, *(law for law in others if law is not own)]
    settings = description.run
    samples = len(all_laws) * settings.duration * (settings.sample_rate or 0.0)
    if short := shortage(SAMPLE * samples):
        message = f"makes {samples:.3g} samples in {len(all_laws)} runs, which {short}"
        raise DescriptionError([Fault("run.sample_rate", f"{message}; lower it")])
    runs: dict[str, Trajectory] = {}
    for name, law in zip(labels(all_laws), all_laws, strict=True):
        part = None if progress is None else share(progress, len(runs), len(all_laws))
        runs[name] = run(exchanged(description, law), max_steps=max_steps, progress=part)
    return Comparison(runs)


def share(progress: Callable[[float], None], done: int, runs: int) -> Callable[[float], None]:
    """Return what reports the progress of one run as a part of that of all."""
    return lambda fraction: progress((done + fraction) / runs)


def labels(laws: Sequence[Law]) -> list[str]:
    """Return a name for each law, with the parameters that differ where a name occurs twice."""
    names = [name_of(law) for law in laws]
    written = [
        {key: f"{v:.6g}" for key, v in parameters(law).items() if isinstance(v, int | float)}
        for law in laws
    ]
    full = []
    for its, name in zip(written, names, strict=True):
        same = [other for other, also in zip(written, names, strict=True) if also == name]
        differ = (key for key in its if any(other.get(key) != its[key] for other in same))
        full.append(", ".join([name, *(f"{key} = {its[key]}" for key in differ)]))
    seen: Counter[str] = Counter()
    for at, label in enumerate(full):
        seen[label] += 1
        if seen[label] > 1:
            full[at] = f"{label} ({seen[label]})"
    return full
