"""Taylor's method of heyoka on the regularised law: ensembles, of single runs and of batches."""

from __future__ import annotations

from functools import cache

import numpy as np

from benchmarks.ensembles.many import PHI
from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import drive, initial_state
from benchmarks.precision.peers.heyoka import regularise

SETTINGS = (
    {"delta": 3e-6, "tol": 1e-5},
    {"delta": 1e-6, "tol": 1e-6},
    {"delta": 1e-7, "tol": 1e-7},
)
LANES = 8  # numbers of double precision that the widest registers hold


def contestants() -> list[Contestant]:
    """Return the rows of both ways."""
    import heyoka as hy

    system = regularise(hy)
    states = np.array([initial_state(phi) for phi in PHI])
    drives = np.array([drive(phi) for phi in PHI])

    @cache
    def single(tol):
        return hy.taylor_adaptive(system, np.zeros(4), tol=tol)

    @cache
    def batch(tol):
        return hy.taylor_adaptive_batch(system, np.zeros((4, LANES)), tol=tol)

    def solve(times, *, delta, tol):
        def start(integrator, i):
            integrator.time, integrator.state[:] = 0.0, states[i]
            integrator.pars[:] = [*drives[i], delta]
            return integrator

        found = hy.ensemble_propagate_grid(single(tol), times, len(PHI), start)
        if any(run[1] != hy.taylor_outcome.time_limit for run in found):
            raise Failed("gave up")
        return np.array([run[-1][:, :2] for run in found])

    def solve_batches(times, *, delta, tol):
        def start(integrator, i):
            own = slice(i * LANES, (i + 1) * LANES)
            integrator.set_time(0.0)
            integrator.state[:] = states[own].T
            integrator.pars[:] = [*drives[own].T, np.full(LANES, delta)]
            return integrator

        found = hy.ensemble_propagate_grid_batch(batch(tol), times, len(PHI) // LANES, start)
        return np.concatenate([run[-1][:, :2].transpose(2, 0, 1) for run in found])

    return [
        *rows(f"heyoka, ensemble of batches of {LANES}", solve_batches, SETTINGS),
        *rows("heyoka, ensemble", solve, SETTINGS[:2]),
    ]
