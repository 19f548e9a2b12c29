"""One apparatus under several friction laws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from stiction.description import MOST_SAMPLES, Description
from stiction.errors import DescriptionError, Fault
from stiction.friction import Law, name_of, parameters
from stiction.laws import exchanged, read_laws
from stiction.simulation import run
from stiction.trajectory import Trajectory


def compare(
    description: Description,
    laws: Sequence[Law | Mapping[str, Any] | str | Path],
    *,
    max_steps: int = 100_000_000,
    progress: Callable[[float], None] | None = None,
) -> dict[str, Trajectory]:
    """Simulate one apparatus under its own friction law and under others.

    Parameters
    ----------
    description : Description
        What is run; only its friction law is exchanged.
    laws : sequence of law, mapping, str or Path
        Each a friction law; a table as in a description; the same written as text, e.g.
        ``'{law = "coulomb", mu_0 = 0.15}'``; a description file, of which the table [friction]
        is taken; ``file.py:Class``; or a law's bare name, e.g. ``"coulomb"``. A law given by
        name alone gets parameters that make it comparable with the description's own, see
        `stiction.friction.likeness.traits`.
    max_steps : int, optional
        Each run gives up after so many steps.
    progress : callable, optional
        Called with the fraction of all runs done.

    Returns
    -------
    dict of str to Trajectory
        By the name of the law, with the parameters that differ where a name occurs twice; the
        description's own law first.

    Raises
    ------
    DescriptionError
        With every law that cannot be read, at once.
    """
    own = description.slider.law
    all_laws = [own, *read_laws(description, [laws] if isinstance(laws, str | Path) else laws)]
    settings = description.run
    samples = len(all_laws) * settings.duration * (settings.sample_rate or 0.0)
    if samples > MOST_SAMPLES:
        message = f"makes {samples:.3g} samples in {len(all_laws)} runs, more than {MOST_SAMPLES:g}"
        raise DescriptionError([Fault("run.sample_rate", f"{message}; lower it")])
    runs: dict[str, Trajectory] = {}
    for name, law in zip(labels(all_laws), all_laws, strict=True):
        part = None if progress is None else share(progress, len(runs), len(all_laws))
        runs[name] = run(exchanged(description, law), max_steps=max_steps, progress=part)
    return runs


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
