"""The complete analysis of a run or a record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.assessment import assess_record, assess_run
from stiction.analysis.creep.curve import stick_phases
from stiction.analysis.creep.divergence import Divergence
from stiction.analysis.creep.findings import attempt, find_creep
from stiction.analysis.creep.misalignment import Misalignment
from stiction.analysis.export import export
from stiction.analysis.measured_line import strongest_line
from stiction.analysis.measurement.excerpt import excerpt, excerpt_of_record
from stiction.analysis.measurement.reading import read_source
from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.motion.cycle_columns import CycleTable, summary
from stiction.analysis.motion.doubts.hum import subtracted_lines
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.regime.classify import classify_record
from stiction.analysis.motion.regime.evidence import Regime
from stiction.analysis.oscillation import apart, oscillation_by_phase, transverse_oscillation
from stiction.analysis.parts import functions
from stiction.analysis.parts.procedure import with_test
from stiction.analysis.record import Record
from stiction.analysis.rotation.findings import GROWING
from stiction.arrays import TINY, xr
from stiction.formats.table import number_of
from stiction.names import draw, page_of, warn_renamed
from stiction.text.sections import Report, Section
from stiction.text.units import Quantity
from stiction.trajectory import Trajectory

HARMONICS = 10.0  # of the stick-slip; oscillations are sought above them
BINS = 20.0  # least number in a stick phase for averages


@dataclass(frozen=True, eq=False, repr=False)
class Analysis(Report):
    """The analysis of a run or a record; for each None, `missing` gives the reason.

    Parameters
    ----------
    source : Trajectory or Record
        The run or record that was analysed.
    record : Record
        Its force over time.
    regime : Regime
        The kind of motion, its confidence and evidence.
    cycles, summary : Dataset
        A row for each cycle (`stiction.analysis.find_cycles`); mean and spread of each quantity.
    curves, creep : Dataset or None
        The creep of each stick phase, and the mean of all (`stiction.analysis.mean_creep`).
    divergence : Divergence or None
        The divergence of creep towards slip.
    misalignment : Misalignment or None
        The misalignment implied by the creep.
    oscillation : Dataset or None
        The transverse oscillation over time (`stiction.analysis.transverse_oscillation`); for a
        record, its strongest fast line (`stiction.analysis.strongest_line`).
    phases : Dataset or None
        Rest and ring-down in each stick phase (`stiction.analysis.oscillation_by_phase`); for
        runs only.
    missing : dict
        The reason for each part that is None, and for each missing column.
    friction : Friction
        Friction at the break-away, static and kinetic.
    warnings : tuple of str
        To be read first: drift, impossible numbers, hum that was subtracted.
    parts : dict
        The findings of all other parts, by name; see `stiction.analysis.parts`.

    Examples
    --------
    >>> import stiction as st
    >>> found = st.analyse(st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="1 kHz"))
    >>> found.regime.kind, found.cycles.sizes["cycle"]
    ('stick-slip', 3)
    """

    source: Trajectory | Record
    record: Record
    regime: Regime
    cycles: xr.Dataset
    summary: xr.Dataset
    curves: xr.Dataset | None
    creep: xr.Dataset | None
    divergence: Divergence | None
    misalignment: Misalignment | None
    oscillation: xr.Dataset | None
    phases: xr.Dataset | None
    missing: dict[str, str]
    friction: Friction
    warnings: tuple[str, ...]
    parts: dict[str, Any]

    def __eq__(self, other: object) -> bool:
        """Compare source and record, from which all findings follow."""
        known = self.source, self.record
        return isinstance(other, Analysis) and known == (other.source, other.record)

    @property
    def energy(self) -> xr.Dataset | None:
        """The energy budget of each cycle (`stiction.analysis.energy_budget`); for runs only."""
        found: xr.Dataset | None = self.parts["energy"]
        return found

    @property
    def song(self) -> xr.Dataset | None:
        """Old name of `oscillation`, which works until the next version."""
        warn_renamed("Analysis.song", "Analysis.oscillation")
        return self.oscillation

    def __dir__(self) -> list[str]:
        """Return the names of attributes, without the old one."""
        return [name for name in object.__dir__(self) if name != "song"]

    def __repr__(self) -> str:
        """Return a one-line summary."""
        found = f"{self.regime.kind}, {number_of(self.cycles.sizes['cycle'], 'cycle')}"
        missing = f"; missing: {', '.join(self.missing)}" if self.missing else ""
        return f"<Analysis: {found}{missing}>"

    def tables(self) -> list[Section]:
        """Return the report as sections of sentences and tables."""
        doubts = Section("Warnings", list(self.warnings)) if self.warnings else None
        brief, *parts = (section(self) for _, section in functions("section"))
        return [each for each in (brief, doubts, *parts) if each is not None]

    def export(self, path: str | Path) -> list[Path]:
        """Write its tables for another program, see `stiction.analysis.export.export`."""
        return export(self, path)

    def write_html(self, path: str | Path, name: str = "a record") -> Path:
        """Write the report as a self-contained page with figures; return the path.

        Raises
        ------
        ResultError
            If the file cannot be written.
        """
        return page_of(self, path, name)

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw the force with its cycles; see `stiction.plotting.plot_analysis`."""
        drawn: NDArray[np.object_] = draw("plot_analysis", self, axes)
        return drawn


def analyse(
    source: Trajectory | Record | str | Path,
    *,
    window: Sequence[Quantity] | None = None,
    trust: bool = False,
) -> Analysis:
    """Analyse a run or a record completely.

    Parameters
    ----------
    source : Trajectory, Record, str or Path
        A run, sampled several times per transverse period for creep and oscillation; a measured
        force with the known parameters of its apparatus; or the file of either, which
        `stiction.read_record` reads where it is not that of a run.
    window : tuple of float or str, optional
        Start and end of the part to analyse, in the times of the run or record; by default all.
    trust : bool, optional
        For a file; see `stiction.load`.

    Returns
    -------
    Analysis
        Its text is a report; each finding is an attribute.

    Raises
    ------
    ResultError
        If a file cannot be read; see `stiction.read_record` and `stiction.load`. If the window is
        not a part of the run or record. What a run or
        record does not tell is not an error: `Analysis.missing` says why.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> found = st.analyse(st.simulate(slider, duration=5.0, sample_rate=10e3))
    >>> found.regime.kind, found.cycles.sizes["cycle"]
    ('stick-slip', 3)
    """
    if isinstance(source, str | Path):
        source = read_source(source, trust=trust)
    if isinstance(source, Trajectory):
        source = excerpt(source, window)
    elif isinstance(source, Record):
        source = excerpt_of_record(source, window)
    run = source if isinstance(source, Trajectory) else None
    record = as_record(source)
    _, found, regime = classify_record(record, run)
    missing: dict[str, str] = {}
    dataset = cache(CycleTable.as_dataset)  # some of the tables are one and the same
    cycles = dataset(found.lasting)
    oscillation = attempt(missing, "oscillation", lambda: _oscillation(record, run, cycles))
    its = assess_run(run, record, found, regime) if run else assess_record(record, found, regime)
    sticking = dataset(its.sticking)
    width = _free_of_hum(oscillation, sticking) if run is None else None
    taken_out = subtracted_lines(found.lines, found.ringing, found.cell)
    answered = found.without_cell(record)
    creep = find_creep(run or answered, answered, sticking, width)
    phases = None
    if run is not None and oscillation is not None:
        phases = oscillation_by_phase(oscillation, run, stick_phases(run, sticking))
    analysis = Analysis(
        source, record, regime, dataset(its.cycles), summary(dataset(its.usual)),
        creep.curves, creep.mean, creep.divergence, creep.misalignment, oscillation, phases,
        missing | creep.missing | its.missing, its.friction,
        its.warnings + taken_out,
        {"metadata": its.stated, "zero": its.zero, "levels": found.levels},
    )  # fmt: skip
    return _with_parts(analysis)


def _with_parts(analysis: Analysis) -> Analysis:
    """Return an analysis with the findings of each of its parts, those of its test first."""
    missing, finders = {**analysis.missing}, dict(functions("find"))
    test = attempt(missing, "procedure", partial(finders.pop("procedure"), analysis))
    analysis = with_test(analysis, test)
    found = {
        name: attempt(missing, name, partial(find, analysis)) for name, find in finders.items()
    }
    parts = analysis.parts | {"procedure": test} | found
    return _agreeing(replace(analysis, parts=parts, missing=missing))


def _agreeing(analysis: Analysis) -> Analysis:
    """Return an analysis without an angle of friction that turns where it is seen to grow."""
    shown = analysis.parts["rotation"]
    if shown is None or shown.kind != GROWING:
        return analysis
    known = analysis.missing.get("misalignment", "not determined")
    if analysis.misalignment is None and known.startswith("not determined"):
        return analysis  # else a bound of the angle, too, supposes what is not so
    why = (
        "not determined: Eq. (7) supposes that friction turns, and the force across shows that it "
        "grows (see Rotation of the force)"
    )
    missing = analysis.missing | {"misalignment": why}
    return replace(analysis, misalignment=None, missing=missing)


analyze = analyse


def _oscillation(record: Record, run: Trajectory | None, cycles: xr.Dataset) -> xr.Dataset:
    """Follow the transverse oscillation of a run, or the strongest line of a record."""
    if run is not None:
        return apart(transverse_oscillation(run), cycles)
    fastest = cycles["period"].values.min() if cycles.sizes["cycle"] else record.duration / 10.0
    return strongest_line(record, HARMONICS / max(float(fastest), TINY), cycles=cycles)


def _free_of_hum(oscillation: xr.Dataset | None, cycles: xr.Dataset) -> float | None:
    """Return the width of bins (s) that average out a persistent line: two of its periods.

    None if there is no such line, or stick phases are too short.
    """
    if oscillation is None or not cycles.sizes["cycle"]:
        return None
    seen = oscillation["frequency"].values
    rises = cycles["peak_time"].values - cycles["start"].values
    if np.isfinite(seen).mean() < 0.5:
        return None
    width = 2.0 / float(np.nanmedian(seen))
    return width if width * BINS < float(np.median(rises)) else None
