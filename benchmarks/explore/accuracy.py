"""Errors of runs at `rtol`, in steps, by default and with a map, against the bounds of `simulate`.

The error is held against the response: what the apparatus itself would do if its mass, or its
normal load, were greater by the share to which each step is kept. Where that alone changes
everything, as it does where motion is chaotic, no tolerance could tell more. Both are the largest
difference of the force of the springs over the run. A system above a bound is left out as chaotic
only if its reference is not known: it changes with its own tolerance as much as the response is.
Single samples beside a rapid slip do not count: its instant is told by those after it.
"""

from __future__ import annotations

from operator import gt
from typing import Literal, NamedTuple

import numpy as np

from benchmarks.explore.deviation import (
    FINER,
    FINEST,
    deviation,
    forces,
    response,
    without_instants,
)
from benchmarks.explore.systems.general import general_system
from benchmarks.explore.systems.seismic import seismic_system
from benchmarks.explore.systems.set_valued import System, system
from benchmarks.explore.systems.slow import slow_system
from benchmarks.explore.systems.unsteady import unsteady_system
from benchmarks.explore.systems.with_state import state_system
from benchmarks.section import Section, Table
from stiction.solver.accuracy import tolerance
from stiction.solver.multiscale.return_map import STEP_SHARE

IN_STEPS = 30.0  # the bound of the error over the response
# With `multiscale=True` steps are held to a share of the tolerance; the map adds little. By default
# they are from where a map is tried
BOUNDS = {"in steps": IN_STEPS, "by default": IN_STEPS, "multiscale": STEP_SHARE * IN_STEPS}
MODES: tuple[bool | Literal["auto"], ...] = (False, "auto", True)
# Of the response: by so much a reference may change with a tenth of its tolerance. That of a system
# which is not chaotic changes by the bound times `FINER` at most, 0.03
KNOWN = 0.1
DRAWN = {
    "set-valued": system,
    "state": state_system,
    "unsteady": unsteady_system,
    "general": general_system,
    "slow": slow_system,
    "seismic": seismic_system,
}
SHARES = (0.5, 0.9, 0.99, 0.999, 1.0)
WORST = 10
CHAOTIC = "chaotic: the reference changes with its own tolerance as much as the response is"


class Seen(NamedTuple):
    """What was seen of one system.

    `off` is the error over the response, `mapped` the sticks that were interpolated, of a run in
    each of the modes; `left_out` is why they do not count, empty if they do.
    """

    number: int
    law: str
    rtol: float
    response: float
    off: tuple[float, ...]
    mapped: tuple[int, ...]
    left_out: str


def look(seed: int, number: int, longer: float = 1.0, kind: str = "set-valued") -> Seen:
    """Look at one system that is drawn at random, for `longer` times its duration."""
    drawn = DRAWN[kind](seed, number)
    return look_at(drawn._replace(duration=longer * drawn.duration), number)


def look_at(drawn: System, number: int = 0) -> Seen:
    """Run a system in all modes, and as it would be if it were a little other."""
    slider, rtol = drawn.slider, drawn.rtol
    finer = max(FINER * rtol, FINEST)
    sharp, reference = forces(drawn, finer)
    moved = response(drawn, tolerance(rtol), finer, sharp)
    runs = [forces(drawn, rtol, mode) for mode in MODES]
    left_out = "" if moved > FINEST else "nothing depends on mass or load: it never slipped"
    for run in (reference, *(run for _, run in runs)):
        left_out = left_out if run.status.ok else run.status.value
    off = tuple(
        deviation(without_instants(found, sharp, bound * moved), sharp) / (moved or 1.0)
        for (found, _), bound in zip(runs, BOUNDS.values(), strict=True)
    )
    if not left_out and any(map(gt, off, BOUNDS.values())):
        sharper, _ = forces(drawn, finer / 10.0)
        known = without_instants(sharper, sharp, KNOWN * moved)
        if deviation(known, sharp) > KNOWN * moved:
            left_out = CHAOTIC
    return Seen(
        number=number,
        law=type(slider.law).__name__,
        rtol=rtol,
        response=moved,
        off=off,
        mapped=tuple(run.statistics.mapped for _, run in runs),
        left_out=left_out,
    )


def section(seen: list[Seen]) -> tuple[Section, bool]:
    """Return what was seen of all systems, and whether every bound is kept."""
    counted = [each for each in seen if not each.left_out]
    tables, kept = [left_out(seen)], True
    for place, (name, bound) in enumerate(BOUNDS.items()):
        those = [each for each in counted if name == "in steps" or each.mapped[place]]
        if not those:
            continue
        ratios = np.array([each.off[place] for each in those])
        broken = int((ratios > bound).sum())
        kept = kept and not broken
        rows = [(f"{share:.1%} below", float(np.quantile(ratios, share))) for share in SHARES]
        rows += [("bound", bound), ("systems", len(those)), ("above the bound", broken)]
        tables.append(Table(f"Error over response: {name}", ("share of systems", "ratio"), rows))
        worst = sorted(those, key=lambda each: -each.off[place])[:WORST]
        headings = ("number", "ratio", "law", "rtol", "response")
        tables.append(
            Table(
                f"Worst systems: {name}",
                headings,
                [
                    (str(one.number), one.off[place], one.law, one.rtol, one.response)
                    for one in worst
                ],
            )
        )
    note = "one system again, with its description: --only NUMBER"
    return Section("Accuracy of random systems", tables, [note]), kept


def left_out(seen: list[Seen]) -> Table:
    """Return how many systems do not count, and why."""
    reasons = sorted({each.left_out for each in seen})
    rows = [(why or "counted", sum(each.left_out == why for each in seen)) for why in reasons]
    return Table("Systems", ("", "number"), rows)
