"""Integrals over the time of a run, as accurate as the run itself.

The run is repeated with samples at the nodes of a quadrature. Samples never influence the steps, so
both runs are the same. Panels end where the motion is not smooth; each has Kronrod's fifteen
points, and the seven Gauss points among them give the error.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import pi
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats, Indices
from stiction.drive import drive_stretches, load_stretches
from stiction.errors import ResultError
from stiction.solver.integrate import integrate, is_smooth
from stiction.solver.segments import fastest_swing, segments
from stiction.trajectory import Trajectory

Integrand = Callable[[Floats, Floats], Floats]

PASSES = 6  # of splitting panels in four: down to a thousandth of the first
MOST_PANELS = 200_000  # panels that are split further at once
AGAIN = 100  # times the steps of a run it may take to make it once more, sampled
MOST_ENDS = 100_000  # steps of smooth friction to each of which a panel belongs
PER_STEP = 4  # panels to each of the solver's steps at first
STEPS_OF_A_CYCLE = 20  # that a return map has found
SUM_ROUNDING = 1e-13  # of an integral; sums of so many numbers are not closer

# R. Piessens et al., QUADPACK (Springer, 1983), routine qk15: nodes from the end of (-1, 1) to
# its middle; Gauss's are the second, fourth, ... of them
_NODES = (
    0.991455371120812639206854697526329,
    0.949107912342758524526189684047851,
    0.864864423359769072789712788640926,
    0.741531185599394439863864773280788,
    0.586087235467691130294144838258730,
    0.405845151377397166906606412076961,
    0.207784955007898467600689403773245,
)
_WEIGHTS = (
    0.022935322010529224963732008058970,
    0.063092092629978553290700663189204,
    0.104790010322250183839876322541518,
    0.140653259715525918745189590510238,
    0.169004726639267902826583426598550,
    0.190350578064785409913256402421014,
    0.204432940075298892414161999234649,
)
NODES = 0.5 * (1.0 + np.array([*(-x for x in _NODES), 0.0, *reversed(_NODES)]))
KRONROD = 0.5 * np.array([*_WEIGHTS, 0.209482141084727828012999174891714, *reversed(_WEIGHTS)])
GAUSS = np.zeros(15)
GAUSS[1::2] = 0.5 * np.polynomial.legendre.leggauss(7)[1]


class _AllTaken(Exception):
    """Raised where a repeated run has given its last row."""


class Integral(NamedTuple):
    """Integrals (quantity, interval), bounds of their error, and integrals of the magnitudes.

    `states` are the rows of `states_at` at the edges.
    """

    value: Floats
    error: Floats
    size: Floats
    states: Floats


def integrals(
    run: Trajectory, edges: Floats, integrand: Integrand, accuracy: float, wanted: int
) -> Integral:
    """Integrate functions of a run's state over time, between each edge and the next.

    Panels are split until the sum of their errors meets `accuracy`, or they can hardly be split
    further; the returned bound holds in both cases. It includes the rounding of times, which is
    much of a rapid slip after years.

    Parameters
    ----------
    run : Trajectory
        Sampled or not.
    edges : ndarray
        (n + 1,), s, ascending, within the run.
    integrand : callable
        Of times (m,), s, and rows (m, 7 or more) as in `stiction.solver.exact.sampling`; returns
        the quantities to integrate, (q, m), all in one unit.
    accuracy : float
        Wanted bound of the quadrature's error, as a share of the integral of the magnitude of
        the largest quantity.
    wanted : int
        The number of quantities, the first ones, whose integrals are to have it; of the others
        the magnitudes matter alone.

    Returns
    -------
    Integral
        Of shape (q, n).
    """
    starts, lengths = panels(run, edges)
    value = error = sizes = states = np.zeros((0, 0))
    left = 0.0
    for turn in range(PASSES):
        (part, off, size), rows = _rules(
            run, starts, lengths, integrand, edges if turn == 0 else edges[:0]
        )
        if turn == 0:
            states = rows
            value, error, sizes = np.zeros((3, len(part), len(edges) - 1))
            left = max(accuracy, SUM_ROUNDING) * size[:wanted].sum(axis=1).max()
        worst = off[:wanted].max(axis=0)
        poor = worst > _threshold(worst, left if turn == 0 else 0.5 * left)
        if turn == PASSES - 1 or poor.sum() > MOST_PANELS:
            poor[:] = False
        which = np.searchsorted(edges, starts[~poor], side="right") - 1
        late = np.spacing(np.abs(starts) + lengths) / lengths  # times are rounded
        for into, values in ((value, part), (error, off + late * size), (sizes, size)):
            for row, one in zip(into, values[:, ~poor], strict=True):
                row += np.bincount(which, one, len(row))
        if not poor.any():
            break
        left -= worst[~poor].sum()
        starts, lengths = split(starts[poor], lengths[poor], np.full(poor.sum(), 4))
    return Integral(value, error, sizes, states)


def _rules(
    run: Trajectory, starts: Floats, lengths: Floats, integrand: Integrand, edges: Floats
) -> tuple[Floats, Floats]:
    """Return the rules of all panels, (3, q, panels), and the rows at edges between panels.

    The rules: integrals, bounds of their error, and integrals of the magnitudes. The nodes are gone
    through block by block: all states of a long run together take gigabytes.
    """
    ends = np.append(starts[1:], starts[-1] + lengths[-1])  # times are rounded: no node lies beyond
    inside = np.minimum(starts[:, None] + lengths[:, None] * NODES, ends[:, None]).ravel()
    at = np.searchsorted(inside, edges)
    is_node = np.ones(len(inside) + len(edges), dtype=bool)
    is_node[at + np.arange(len(edges))] = False
    found, states, kept, seen, done = [], [], np.empty((0, 0)), 0, 0

    def take(rows: Floats) -> None:
        nonlocal kept, seen, done
        among = is_node[seen : seen + len(rows)]
        seen += len(rows)
        states.append(rows[~among])
        rows = np.concatenate([kept, rows[among]]) if len(kept) else rows[among]
        whole = len(rows) // len(NODES)
        kept = rows[whole * len(NODES) :].copy()
        if whole:
            times = inside[done * len(NODES) : (done + whole) * len(NODES)]
            values = integrand(times, rows[: len(times)]).reshape(-1, whole, len(NODES))
            off, size = np.abs(values @ (KRONROD - GAUSS)), np.abs(values) @ KRONROD
            found.append(np.stack([values @ KRONROD, off, size]))
            done += whole

    go_through(run, np.insert(inside, at, edges), take)
    return lengths * np.concatenate(found, axis=2), np.concatenate(states)


def _threshold(errors: Floats, left: float) -> float:
    """Return the largest error up to which errors add up to at most `left`."""
    ascending = np.sort(errors)
    within = np.searchsorted(np.cumsum(ascending), left, side="right")
    return float(ascending[within - 1]) if within else 0.0


def panels(run: Trajectory, edges: Floats) -> tuple[Floats, Floats]:
    """Return starts and lengths (s) of panels within which no stick begins or ends.

    No panel contains an edge, or a jump or bend of the drive or load. Under set-valued friction
    none is longer than the shortest period: that of springs and programs during slip, of programs
    alone during stick. Smooth friction is stiff: its slips may be a millionth of the run, between
    all nodes of equal panels, and swings are damped away. There each step of the solver is a panel.
    Where the solver's steps are far longer than periods, there are some panels to a step, and more
    where the first ones do not suffice (see `integrals`).
    """
    slider, first, last = run.slider, edges[0], edges[-1]
    smooth = is_smooth(run.description)
    own = step_ends(run) if smooth else run.stick_intervals.ravel()
    programs = [end for end, _ in drive_stretches(slider.motion)]
    programs += [end for end, _ in load_stretches(slider.normal_load, slider.load)]
    breaks = np.unique(np.concatenate([edges, own, programs]))
    breaks = breaks[(breaks >= first) & (breaks <= last)]
    starts, lengths = breaks[:-1], np.diff(breaks)
    imposed = max((fastest_swing(s.problem) for s in segments(slider, first, last)), default=0.0)
    natural = 0.0 if smooth else 2.0 * pi * slider.natural_frequencies[1]
    held = np.searchsorted(run.stick_intervals[:, 0], starts, side="right")
    stuck = starts < np.append(run.stick_intervals[:, 1], -np.inf)[held - 1]
    omega = np.where(stuck, imposed, max(imposed, natural))
    counts = np.ceil(np.maximum(1.0, omega * lengths / (2.0 * pi))).astype(np.intp)
    share = PER_STEP * (steps_of(run) + 100) / counts.sum()
    if share < 1.0:
        counts = np.ceil(share * counts).astype(np.intp)
    return split(starts, lengths, counts)


def steps_of(run: Trajectory) -> int:
    """Return how many steps a run took, or would have without a map of its cycles."""
    took = run.statistics
    return max(took.steps, 0) + STEPS_OF_A_CYCLE * max(took.mapped, 0)


def step_ends(run: Trajectory) -> Floats:
    """Return when the solver's steps end (s); of very many, of every some."""
    _, initial, settings = run.description
    shares: list[float] = []
    every = 1 + steps_of(run) // MOST_ENDS
    integrate(run.description, np.empty(0), _budget(run), shares.append, pause=every)
    return initial.time + settings.duration * np.array(shares)


def split(starts: Floats, lengths: Floats, counts: Indices) -> tuple[Floats, Floats]:
    """Split each interval into `counts` equal parts; return starts and lengths (s)."""
    which = np.repeat(np.arange(len(counts)), counts)
    part = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    length = (lengths / counts)[which]
    return starts[which] + part * length, length


def _budget(run: Trajectory) -> int:
    """Return the most steps that a run may take once more."""
    took = run.statistics
    return AGAIN * (max(took.steps, 0) + max(took.mapped, 0) + 1000)


def states_at(run: Trajectory, times: Floats) -> Floats:
    """Return rows as in `stiction.solver.exact.sampling` at `times` (ascending, s) of the run."""
    blocks: list[Floats] = []
    go_through(run, times, lambda rows: blocks.append(rows.copy()))
    return np.concatenate(blocks)


def go_through(run: Trajectory, times: Floats, take: Callable[[Floats], None]) -> None:
    """Repeat a run, and call `take` with the rows of `states_at`, block by block.

    It is the whole run until the last row is there: steps know of its end.
    """
    count = 0

    def count_and_take(rows: Floats) -> None:
        nonlocal count
        count += len(rows)
        take(rows)
        if count == len(times):
            raise _AllTaken

    with suppress(_AllTaken):
        integrate(run.description, times, _budget(run), None, count_and_take)
    if count < len(times):
        raise ResultError(f"the repeated run ends before {times[-1]:g} s; simulate it again")
