"""Energy budget: the work of the drive, dissipation, elastic and kinetic energy."""

from __future__ import annotations

from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike

from stiction.analysis.quadrature import integrals, states_at, steps_of
from stiction.arrays import Floats, xr
from stiction.drive import drive_stretches, jump
from stiction.drive.program import pick
from stiction.errors import ResultError, echo
from stiction.solver.accuracy import tolerance
from stiction.system.tensors import damping_tensor, mass_tensor
from stiction.trajectory import Trajectory

ENERGY_ROUNDING = 4e-16  # of a stored energy, in each step: its displacement by half as much
POWERS = 5  # of the energies, the first ones: they are integrals over time
# name: long name; all in J
ENERGIES = {
    "work": "work of the drive",
    "friction_x": "dissipated by friction along x",
    "friction_y": "dissipated by friction along y",
    "damper_x": "dissipated by the damper along x, or its own axis",
    "damper_y": "dissipated by the damper along y, or its own axis",
    "spring_x": "change of the energy of the spring along x",
    "spring_y": "change of the energy of the spring along y",
    "kinetic": "change of the kinetic energy",
    "residual": "work less what became of it",
    "quadrature": "bound of the error of the quadrature in the residual",
    "bound": "bound of the residual: quadrature, rounding, and what the tolerance allows",
}


def energy_budget(run: Trajectory, edges: ArrayLike | None = None) -> xr.Dataset:
    """Return the energy budget of a run, between each edge and the next.

    With slip velocity s, elongation u and friction F, the mass obeys M u'' + C u' + K u = F in
    the frame of the spring's far end; multiplied by the velocities,

        P = F.s + u'.C u' + d/dt (u.K u/2 + v.M v/2).

    A driven plate: the drive works on the plate, P = F.v_d, and v = u'. A driven spring: the drive
    works on the spring's end, P = v_d.(K u + C u'), and v = s. At a steady drive both are the same
    run in two frames. Friction reverses within no time where slip nearly vanishes, which a
    quadrature may miss; the spring's force does not. Therefore the work on the plate is computed as
    P = v_d.(M u'' + C u' + K u), its first term by partial integration.

    Each term is integrated independently from the run's states, and nothing is adjusted: the
    residual is the error of the solver. The local tolerance limits the energy error of each step,
    relative to the energy that it exchanges: also what springs and mass exchange in each swing.

    Neither friction during stick nor the normal load does work. The friction of a law with internal
    state can return work: it includes the energy stored in bristles.

    Parameters
    ----------
    run : Trajectory
        Sampled or not: it is solved again, sampled at the nodes of the quadrature, with some 0.5 kB
        for each transverse period.
    edges : array, optional
        (n + 1,), s, ascending: from each to the next is an interval, e.g. a cycle. By default
        the whole run.

    Returns
    -------
    Dataset
        Over ``interval``: ``start``, ``end`` (s), and in J ``work``, ``friction_x``,
        ``friction_y``, ``damper_x``, ``damper_y``, ``spring_x``, ``spring_y`` and ``kinetic``
        (changes), ``residual`` (work less all others), ``quadrature``, a bound of the part of
        the residual that is not the solver's, and ``bound``, one of the whole residual. Their
        sums over ``interval`` are those of the whole.

    Raises
    ------
    ResultError
        If the edges do not ascend, or lie outside the run.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), duration=0.1)
    >>> budget = st.analysis.energy_budget(run)
    >>> bool((abs(budget["residual"]) < budget["bound"]).all())
    True
    """
    borders = _edges(run, edges)
    rtol = run.description.run.rtol
    integrated = integrals(run, borders, lambda t, rows: _powers(run, t, rows), rtol, POWERS)
    sizes, rows = integrated.size, integrated.states
    powers, off = integrated.value[:POWERS], integrated.error[:POWERS]
    energies = _stored_energies(run, borders, rows)
    stored = np.diff(energies, axis=1)
    if run.slider.driven == "plate":
        powers[0] += _momentum_gain(run, borders, rows)
    spent = np.concatenate([powers[1:], stored])
    residual = powers[0] - spent.sum(axis=0)
    quadrature, exchanged = off.sum(axis=0), sizes.sum(axis=0) + np.abs(stored).sum(axis=0)
    rounding = ENERGY_ROUNDING * steps_of(run) * np.abs(energies).sum(axis=0).max()
    bound = quadrature + tolerance(rtol) * exchanged + rounding
    values = [powers[0], *spent, residual, quadrature, bound]
    variables = {
        name: ("interval", value, {"units": "J", "long_name": ENERGIES[name]})
        for name, value in zip(ENERGIES, values, strict=True)
    }
    seconds = {"units": "s"}
    return xr.Dataset(
        variables,
        {"start": ("interval", borders[:-1], seconds), "end": ("interval", borders[1:], seconds)},
    )


def _edges(run: Trajectory, edges: ArrayLike | None) -> Floats:
    """Return the edges, if they are valid."""
    first, last = (float(run.samples["time"][i]) for i in (0, -1))
    if first == last:
        raise ResultError(
            f"the run has one sample, at {first:g} s, and no time between samples; simulate it "
            "with a higher sample_rate"
        )
    if edges is None:
        return np.array([first, last])
    try:
        found = np.asarray(edges, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        found = np.zeros(0)
    if found.ndim != 1 or len(found) < 2 or not (np.diff(found) > 0.0).all():
        raise ResultError(f"edges must be two times or more that ascend, are {echo(edges)}")
    if found[0] < first or found[-1] > last:
        raise ResultError(
            f"the run goes from {first:g} s to {last:g} s, the edges from {found[0]:g} s to "
            f"{found[-1]:g} s; leave out those that lie outside"
        )
    return found


def _powers(run: Trajectory, t: Floats, rows: Floats) -> Floats:
    """Return the first powers of `ENERGIES`, and the power into each spring along x, y (W)."""
    s = run.slider
    u_x, u_y, s_x, s_y, f_x, f_y = rows[:, :6].T
    d_x, d_y = s.along_axes(*s.motion.rate(t))
    v_x, v_y = d_x - s_x, d_y - s_y
    M, C, v = mass_tensor(s), damping_tensor(s), np.stack([v_x, v_y])
    c_x, c_y = C @ v
    work = (s.k_x * u_x + c_x) * d_x + (s.k_y * u_y + c_y) * d_y
    if s.driven == "plate":
        changes = pick(drive_stretches(s.motion), t, lambda course, at, _: course.rate_change(at))
        a_x, a_y = s.along_axes(*changes)
        p_x, p_y = M @ v
        work = work - (p_x * a_x + p_y * a_y)
    angle = s.damping_angle - s.turn
    cos_d, sin_d = cos(angle), sin(angle)
    along, across = cos_d * v_x + sin_d * v_y, cos_d * v_y - sin_d * v_x
    spent = [f_x * s_x, f_y * s_y, s.c_x * along**2, s.c_y * across**2]
    return np.stack([work, *spent, s.k_x * u_x * v_x, s.k_y * u_y * v_y])


def _momentum_gain(run: Trajectory, borders: Floats, rows: Floats) -> Floats:
    """Return u'.M v_d over the smooth stretches of a plate's drive, end less start, J.

    Added to the work of spring and dampers on the plate, minus the integral of u'.M a_d, it yields
    the integral of F.v_d = v_d.(M u'' + C u' + K u). A jump of the plate's velocity leaves the mass
    unaffected. The rows are the states at the borders.
    """
    s = run.slider
    jumps = [end for end, _ in drive_stretches(s.motion) if borders[0] <= end < borders[-1]]
    times = np.union1d(borders, jumps)
    states = rows if len(times) == len(borders) else states_at(run, times)
    d = np.reshape(s.along_axes(*s.motion.rate(times)), (2, -1))  # one column for a steady drive
    momentum = mass_tensor(s) @ (d - states[:, 2:4].T)
    carried = (momentum * d).sum(axis=0)
    leaps = np.array([s.along_axes(*jump(s.motion, t)) for t in times[:-1].tolist()]).T
    inside = np.searchsorted(times, borders)
    gained = np.add.reduceat((momentum[:, :-1] * leaps).sum(axis=0), inside[:-1])
    found: Floats = np.diff(carried[inside]) - gained
    return found


def _stored_energies(run: Trajectory, t: Floats, rows: Floats) -> Floats:
    """Return the energies (J) of the springs along x and y, and of the moving mass."""
    s = run.slider
    u_x, u_y, v_x, v_y = rows[:, :4].T
    if s.driven == "plate":
        d_x, d_y = s.along_axes(*s.motion.rate(t))
        v_x, v_y = d_x - v_x, d_y - v_y
    M = mass_tensor(s)
    kinetic = 0.5 * (M[0, 0] * v_x**2 + 2.0 * M[0, 1] * v_x * v_y + M[1, 1] * v_y**2)
    return np.stack([0.5 * s.k_x * u_x**2, 0.5 * s.k_y * u_y**2, kinetic])
