"""``python -m benchmarks.explore.rigs.sampling``: random rigs at several samplings.

Each run is judged with the samples that `st.simulate` takes by itself, with 4 and with 20 times as
many, and as a study sees it. Kind of motion and number of cycles must be the same in all four,
unless the motion is marginal: then a tighter tolerance of the solver changes them, too.
Deterministic in its seed; exit status 1 if a rig that is not marginal differs.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import NamedTuple

from rich.console import Console

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.report import show
from benchmarks.section import Section, Table
from stiction.analysis.measurement.run_record import record_of
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.regime.classify import regime_of
from stiction.study.variables.observed_run import observe_run

DENSER = (1.0, 4.0, 20.0)  # times as many samples as by default
PERIODS = (300.0, 1000.0, 3000.0)  # of the fast oscillation, in a run at most
ANGLES = (0.3, 1.0, 3.0, 6.0, 12.0, 30.0, 60.0, 85.0)  # deg
ONE, SHARE = 1, 0.01  # cycles by which counts may differ: of build-up, or cut by an end
TIGHTER = 1e-2  # times the tolerance of the solver: what is marginal comes out differently


class Judged(NamedTuple):
    """The kind of motion, and the number of cycles."""

    kind: str
    cycles: int

    def agrees(self, other: Judged) -> bool:
        """Return whether kind and number are the same, but for a cycle or so."""
        few = max(ONE, SHARE * max(self.cycles, other.cycles))
        return self.kind == other.kind and abs(self.cycles - other.cycles) <= few


class Seen(NamedTuple):
    """The judgements of one rig: at each of `DENSER`, and last that of a study."""

    number: int
    judged: tuple[Judged, ...]
    marginal: bool = False

    @property
    def differ(self) -> bool:
        """Whether any two judgements differ."""
        return not all(each.agrees(self.judged[-2]) for each in self.judged)


def rig(seed: int, number: int) -> tuple[st.Slider, float]:
    """Return a rig, and how long it is looked at, s."""
    draw = Draw(seed, number)
    phi, k_y, V = draw.among(ANGLES), draw.decades(1e3, 3e6), draw.decades(1e-4, 3e-2)
    laws = (
        st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f=draw.decades(1e-3, 1e-1)),
        st.Coulomb(mu_0=0.2),
        st.Coulomb(mu_0=0.2, mu_static=0.25),
    )
    slider = st.presets.nakano_popov_2020().replace(
        k_y=k_y,
        phi=f"{phi} deg",
        friction=draw.among(laws),
        drive=st.ConstantVelocity(V),
        c_x=draw.among((0.0, 1.0, 5.0)),
        c_y=draw.among((0.0, 2.0)),
    )
    loadings = slider.F_0 / (slider.k_x * V) + 3.0 / slider.natural_frequency_x
    most = draw.among(PERIODS) / slider.natural_frequencies[1]
    return slider, min(draw.among((6.0, 15.0)) * loadings, most)


def judge(slider: st.Slider, duration: float, times: float, rtol: float) -> Judged:
    """Return how an analysis judges a run of so many times as many samples as by default."""
    run = st.simulate(slider, duration, rtol=rtol)
    if times != 1.0:
        rate = times * (len(run.samples["time"]) - 1) / duration
        run = st.simulate(slider, duration, sample_rate=rate, rtol=rtol)
    record = record_of(run)
    found = swings(record)
    return Judged(regime_of(record, found).kind, len(found.lasting))


def observe(slider: st.Slider, duration: float) -> Judged:
    """Return how a study judges a run."""
    run = observe_run(st.Description.of(slider, duration), None)
    return Judged(run.regime, len(run.cycles.drop))


def look(seed: int, number: int) -> Seen:
    """Judge one rig at each sampling, and in a study."""
    drawn, rtol = rig(seed, number), st.Settings(duration=1.0).rtol
    judged = [judge(*drawn, times, rtol) for times in DENSER]
    seen = Seen(number, (*judged, observe(*drawn)))
    if not seen.differ:
        return seen
    tighter = judge(*drawn, DENSER[-1], TIGHTER * rtol)
    return seen._replace(marginal=not tighter.agrees(judged[-1]))


def section(seen: list[Seen]) -> tuple[Section, bool]:
    """Return how many rigs are judged alike, and whether all that are not marginal are."""
    counted = [each for each in seen if not each.marginal]
    names = [*(f"{times:g} times the samples" for times in DENSER[:-1]), "a study"]
    rows = []
    for name, at in zip(names, (*range(len(DENSER) - 1), -1), strict=True):
        pairs = [(each.judged[at], each.judged[-2]) for each in counted]
        kinds = sum(one.kind == other.kind for one, other in pairs)
        rows.append((name, kinds, sum(one.agrees(other) for one, other in pairs)))
    kinds = sorted({each.judged[0].kind for each in seen})
    drawn = [(kind, sum(each.judged[0].kind == kind for each in seen)) for kind in kinds]
    other = [each for each in seen if each.differ]
    lines = [
        (str(each.number), str([f"{its.kind}, {its.cycles}" for its in each.judged]), each.marginal)
        for each in other
    ]
    versus = f"as with {DENSER[-1]:g} times the samples"
    tables = [
        Table(f"{len(counted)} rigs {versus}", ("judged by", "kind", "kind and cycles"), rows),
        Table("Kinds of motion", ("kind", "rigs"), drawn),
        Table("Rigs that differ", ("number", "judged", "marginal"), lines),
    ]
    note = f"marginal, not counted: {len(seen) - len(counted)}"
    found = Section("Kinds of motion and samples", tables, [note])
    return found, not any(each.differ for each in counted)


def main() -> int:
    """Look at the rigs asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.rigs.sampling")
    parser.add_argument("--systems", type=int, default=200, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    with ProcessPoolExecutor(options.processes) as pool:
        seen = list(pool.map(partial(look, options.seed), range(options.systems)))
    found, keeps = section(seen)
    show(Console(), found)
    return 0 if keeps else 1


if __name__ == "__main__":
    sys.exit(main())
