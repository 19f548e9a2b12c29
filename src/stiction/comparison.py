"""One apparatus under several friction laws."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import pi, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.slip import Outcome, cell_symbol, outcome
from stiction.arguments import read_together
from stiction.errors import DescriptionError, Fault
from stiction.friction import LAWS, Anisotropic, Law, has_state, name_of, parameters, read_law
from stiction.friction.equivalent import Traits, like, traits
from stiction.friction.law import static_coefficient
from stiction.friction.user.loading import finder_for_descriptions
from stiction.machine import shortage
from stiction.names import draw
from stiction.progress.audience import with_progress
from stiction.result.rest import REST
from stiction.simulation import MOST_STEPS, automatic_times, run
from stiction.system.description import SAMPLE, Description, description_of
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.text.quantity.wording import ALL, in_words
from stiction.text.sections import Report, Section, Table
from stiction.text.toml import read_toml
from stiction.text.units import Quantity
from stiction.text.validation import unknown_name
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEADINGS = (
    "law", "sticks", "stuck", "largest {}/W", "fastest slip", "slowest slip while loading",
    "median slip while loading",
)  # fmt: skip
SLOWEST = 1e-12  # m/s: slower motion of a law with states, which never rests, has no number
ROUNDED = 1.0 + 1e-9  # times the speed of the release, which is not a slip
BRISTLES = 100.0  # of a spring's stiffness: sigma_0 of Canudas de Wit et al. (1995) over 1 kN/m
MEMORY = 200.0  # memory lengths in a slip length: 10 µm in the 2 mm of Nakano & Popov
EXAMPLE = """'{law = "coulomb", mu_0 = 0.15}'"""


class Comparison(Report, dict[str, Trajectory]):
    """Runs of one apparatus under several friction laws, by the law's name.

    The description's own law is the first.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> found = st.compare(base, ["coulomb"])
    >>> found.ok, found["coulomb"].slider.law.mu_0
    (True, 0.15)
    """

    def __repr__(self) -> str:
        """Name the laws."""
        return f"<Comparison of {'; '.join(self)}>"

    @property
    def ok(self) -> bool:
        """Whether every run reached its duration."""
        return all(run.status.ok for run in self.values())

    def tables(self) -> list[Section]:
        """Return a table with a row for each law."""
        outcomes = [outcome(run) for run in self.values()]
        rows = [row(*each, o) for each, o in zip(self.items(), outcomes, strict=True)]
        early = [
            f"{label} ended early: {run.status.value}."
            for label, run in self.items()
            if not run.status.ok
        ]
        if any(o.hidden for o in outcomes):
            early.append("> marks slips that are faster still, between samples: take more of them.")
        force = next((cell_symbol(run.slider) for run in self.values()), "")
        headings = tuple(each.format(force) for each in HEADINGS)
        return [Section("Friction laws", early, Table(headings, rows))]

    def plot(
        self, axes: Any = None, *, window: Sequence[Quantity] | None = None
    ) -> dict[str, Axes]:
        """Draw the runs together; see `stiction.plotting.plot_comparison`."""
        drawn: dict[str, Axes] = draw("plot_comparison", self, axes, window=window)
        return drawn


def row(label: str, run: Trajectory, o: Outcome) -> tuple[str, ...]:
    """Return the table row of one law."""
    initial = run.description.initial
    drive = float(np.hypot(run.data["drive_X"], run.data["drive_Y"]).max())
    release = ROUNDED * initial.epsilon if initial.v_x is None else 0.0
    least = drive * (REST if o.fastest > release * drive else release)  # it sticks at once
    creeps = has_state(run.slider.law)
    speeds = [speed_in_words(v, least, creeps) for v in (o.fastest, o.slowest, o.creep)]
    speeds[0] = f"> {speeds[0]}" if o.hidden and o.fastest > least else speeds[0]
    stuck = share_in_words(o.time_stuck, float(run.samples["time"][-1] - run.samples["time"][0]))
    return label, str(o.sticks), stuck, f"{o.peak:.4f}", *speeds


def speed_in_words(speed: float, least: float, creeps: bool) -> str:
    """Return a speed (m/s), which is rest up to a least one; a law that `creeps` never rests.

    >>> speed_in_words(1e-9, 1e-8, False), speed_in_words(1e-9, 1e-8, True)
    ('0 m/s', '1 nm/s')
    >>> speed_in_words(3e-41, 1e-8, True), speed_in_words(float("nan"), 1e-8, True)
    ('< 1 pm/s', 'none')
    """
    if creeps:
        return f"< {in_words(SLOWEST, 'm/s')}" if speed < SLOWEST else in_words(speed, "m/s", 3)
    return in_words(0.0 if speed <= least else speed, "m/s", 3)


def share_in_words(lasts: float, whole: float) -> str:
    """Return how long something lasts (s): not the whole time, if it is less."""
    text = in_words(lasts, "s", 3)
    if whole - lasts <= ALL * whole or text != in_words(whole, "s", 3):
        return text
    return f"all but {in_words(whole - lasts, 's', 2)}"


def add_sample_rate(description: Description) -> Description:
    """Return the description with a sample rate for figures over time.

    If it has none, all laws use the rate that `simulate` chooses for the description's own law.
    """
    if description.run.sample_rate:
        return description
    settings = description.run.model_dump(exclude_none=True)
    rate = (len(automatic_times(description)) - 1) / description.run.duration
    return description._replace(run=type(description.run)(**(settings | {"sample_rate": rate})))


@read_together
@with_progress("simulating")
def compare(
    description: Slider | Description | str | Path,
    laws: Sequence[Law | Mapping[str, Any] | str | Path],
    *,
    duration: Quantity | None = None,
    max_steps: int = MOST_STEPS,
    progress: Callable[[float], None] | None = None,
) -> Comparison:
    """Simulate one apparatus under its own friction law and under others.

    Parameters
    ----------
    description : Slider, Description, str or Path
        The system, its description, or its file; only its friction law is replaced.
    laws : sequence of FrictionLaw, StateLaw, mapping, str or Path
        Each is a friction law; a table as in a description; the same as text, e.g.
        ``'{law = "coulomb", mu_0 = 0.15}'``; a description file, whose table [friction] is
        used; ``file.py:Class``; or a law's name, e.g. ``"coulomb"``. A name alone gets
        parameters that make the law comparable with the description's own, see `comparable`;
        the name of the description's own law means that law, which is run once.
    duration : float or str, optional
        How long each run lasts, s: of a slider, or in place of that of a description.
    max_steps : int, optional
        Limit of the steps of each run.
    progress : callable, optional
        Called with the fraction of all runs done; without it, a terminal or a notebook shows a
        bar or lines.

    Returns
    -------
    Comparison
        The runs by the name of the law, the description's own first. Where a name occurs twice,
        the parameters that differ are added to it. It has ``tables()`` and ``plot()``.

    Raises
    ------
    DescriptionError
        With every law that cannot be read.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> list(st.compare(base, ["coulomb", "lugre"]))
    ['exponential-weakening', 'coulomb', 'lugre']
    >>> st.compare(slider, ["coulomb"], duration="20 ms")["coulomb"].status.ok
    True
    """
    description = add_sample_rate(description_of(description, duration))
    own = description.slider.law
    others = read_laws(description, [laws] if isinstance(laws, str | Path) else laws)
    all_laws = [own, *(law for law in others if law is not own)]
    settings = description.run
    samples = len(all_laws) * settings.duration * (settings.sample_rate or 0.0)
    if short := shortage(SAMPLE * samples):
        message = f"makes {samples:.3g} samples in {len(all_laws)} runs, which {short}"
        raise DescriptionError.of("run.sample_rate", f"{message}; lower it")
    runs: dict[str, Trajectory] = {}
    for name, law in zip(labels(all_laws), all_laws, strict=True):
        part = None if progress is None else share(progress, len(runs), len(all_laws))
        runs[name] = run(exchange_law(description, law), max_steps=max_steps, progress=part)
    return Comparison(runs)


def share(progress: Callable[[float], None], done: int, runs: int) -> Callable[[float], None]:
    """Return a callback that turns one run's progress into the progress of all runs."""
    return lambda fraction: progress((done + fraction) / runs)


def labels(laws: Sequence[Law]) -> list[str]:
    """Return a name for each law; equal names get the parameters that differ, if they are set."""
    names = [name_of(law) for law in laws]
    written = [
        {key: f"{v:.6g}" for key, v in set_parameters(law).items() if isinstance(v, int | float)}
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


def set_parameters(law: Law) -> dict[str, Any]:
    """Return the parameters of a law that differ from their defaults."""
    inner = law.law if isinstance(law, Anisotropic) else law
    defaults: dict[str, Any] = getattr(inner, "_field_defaults", {})
    known = parameters(law)
    return {key: known[key] for key in known if key not in defaults or known[key] != defaults[key]}


def exchange_law(description: Description, law: Law) -> Description:
    """Return the same description with another friction law.

    Initial internal states are kept only for a law of the same type.
    """
    initial = description.initial
    if initial.states is not None and type(law) is not type(description.slider.law):
        initial = Initial(**initial.model_dump(exclude={"states"}, exclude_unset=True))
    slider = description.slider.replace(friction=law)
    return description._replace(slider=slider, initial=initial)


def read_laws(description: Description, laws: Sequence[Any]) -> list[Law]:
    """Read the laws in any form that `stiction.compare` accepts."""
    made: list[Law] = []
    found: list[Fault] = []
    for count, value in enumerate(laws, 1):
        try:
            made.append(exchange_law(description, read(description, value)).slider.law)
        except DescriptionError as error:
            where = f"law {value}" if value and isinstance(value, str | Path) else f"law {count}"
            found += [Fault(where, ": ".join(within(fault, str(value)))) for fault in error.faults]
    if found:
        raise DescriptionError(found)
    return made


def within(fault: Fault, text: str) -> Iterator[str]:
    """Yield the path of a fault inside its law, if it has one, and the message."""
    key = fault.at().path
    if key not in ("", "law", "friction") and fault.path != text:
        yield key
    yield fault.message


def read(description: Description, value: Any) -> Law:
    """Read the law of one list entry."""
    if isinstance(value, Mapping):
        return read_law(dict(value))
    if not isinstance(value, str | Path):
        law: Law = value  # the slider refuses anything else
        return law
    text = str(value).strip()
    if text.startswith("{"):
        return read_law(inline(text))
    if text.endswith(".toml"):
        return read_law(friction_table(text), finder_for_descriptions(Path(text).parent))
    if ":" in text:  # named by the user, not by a file
        return read_own_law(description, text)
    if text in LAWS:
        return comparable(LAWS[text], description)
    other = f"(or a table {EXAMPLE}, a .toml file, file.py:Class)"
    raise DescriptionError.of("law", f"{unknown_name('law', text, LAWS)} {other}")


def read_own_law(description: Description, name: str) -> Law:
    """Read a user's law by its name: with its defaults, or comparable if it lacks some of them."""
    located: list[Any] = []
    find = finder_for_descriptions(Path(), trust=True)

    def locate(name: str, text: str | None) -> type[Any]:
        located.append(find(name, text))
        kind: type[Any] = located[0]
        return kind

    try:
        return read_law({"law": name}, locate)
    except DescriptionError:
        kind = located[0] if located else None
        if set(getattr(kind, "_fields", ())) <= set(getattr(kind, "_field_defaults", ())):
            raise
    return comparable(kind, description)


def comparable(kind: Any, description: Description) -> Law:
    """Return a law of `kind` that is comparable with the description's own.

    The description's own law is returned if it is of that kind. Of rate and state, only the law of
    the state changes: a, b, D_c, mu_star and V_star are the described ones. Bristles are a hundred
    times as stiff as the spring whose axis is nearest to the drive, and critically damped; the
    memory length is a two-hundredth of the slip length on that spring, or that of the described
    law. For the apparatus of Nakano & Popov these are the published values of both laws.
    """
    slider = description.slider
    if isinstance(slider.law, kind):
        described: Law = slider.law
        return described
    if has_state(slider.law) and slider.law._fields == kind._fields:
        twin: Law = kind(**slider.law._asdict())
        return twin
    made: Any = like(kind, shared_traits(description))
    known = slider.law._asdict() if hasattr(slider.law, "_asdict") else {}  # a user's class
    across = abs(slider.misalignment) > 0.25 * pi
    k, m = (slider.k_x, slider.k_y)[across], slider.masses[across]
    sigma_0, memory = BRISTLES * k, slider.F_0 / k / MEMORY
    own = {"sigma_0": sigma_0, "sigma_1": 2.0 * sqrt(sigma_0 * m)}
    own |= {"D_c": memory, "D_1": memory, "D_2": 10.0 * memory}
    chosen = {
        name: known.get(name, float(f"{value:.4g}"))
        for name, value in own.items()
        if name in kind._fields
    }
    suited: Law = made._replace(**chosen) if chosen else made
    return suited


def inline(text: str) -> dict[str, Any]:
    """Return the inline TOML table in a text."""
    try:
        table: dict[str, Any] = tomllib.loads(f"law = {text}")["law"]
    except (ValueError, RecursionError) as error:
        message = f"is not a TOML table: {error}; write for example {EXAMPLE}"
        raise DescriptionError.of("law", message) from None
    return table


def friction_table(path: str) -> dict[str, Any]:
    """Return the table [friction] of a file."""
    table = read_toml(path).get("friction")
    if not isinstance(table, dict):
        raise DescriptionError.of(path, "has no table [friction]; write one in it")
    return table


def shared_traits(description: Description) -> Traits:
    """Return the traits of the description's own law, at the speeds of the apparatus.

    The fastest slip is the drive's speed plus that of the mass released by its loaded spring.
    """
    slider, start = description.slider, description.initial.time
    times = np.linspace(start, start + description.run.duration, 513)
    drive = max(float(np.hypot(*slider.motion.rate(float(time)))) for time in times)
    law = slider.law
    mu = law.coefficient(drive or 1e-6) if has_state(law) else static_coefficient(law)
    free = mu * slider.normal_load / sqrt(min(slider.masses) * min(slider.k_x, slider.k_y))
    return traits(law, drive, drive + free or 1.0)
