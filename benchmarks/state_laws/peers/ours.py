"""Our own solver, through the interface that everyone uses."""

from __future__ import annotations

from functools import cache

import numpy as np

import stiction as st
from benchmarks.harness.contestant import Contestant, Failed
from benchmarks.precision.case import PHI
from benchmarks.precision.peers.ours import slider as fig_3
from benchmarks.state_laws.cases import (
    AGEING,
    INERTIA_OVER_DIRECT_EFFECT,
    Bristles,
    Case,
    Floats,
    Smoothing,
)
from benchmarks.state_laws.peers import rows
from stiction.presets.preset import on_a_line

RTOL = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)


def contestants() -> list[Contestant]:
    """Return our rows."""
    return rows("stiction", solve, lambda case: [{"rtol": rtol} for rtol in RTOL])


@cache
def system(case: Case):
    """Return slider, start and the names of force and state; as the peers' constants, made once."""
    if isinstance(case.law, Smoothing):
        return fig_3(PHI), None, ("spring_x", "spring_y")
    pieces = [
        st.protocols.Constant(v, duration=d) if v else st.protocols.Hold(d) for d, v in case.pieces
    ]
    drive = st.protocols.DriveProgram(velocity=case.pieces[0][1], program=pieces)
    first = case.pieces[0][1]
    if isinstance(case.law, Bristles):
        law, mass = st.laws.LuGre(*case.law), case.mass
        start, state = st.Initial(v_x=first, v_y=0.0), "z_x"
    else:
        kind = st.laws.RateStateAgeing if case.kind == AGEING else st.laws.RateStateSlip
        law, state = kind(*case.law), "log_theta"
        fastest = max(v for _, v in case.pieces)
        least = INERTIA_OVER_DIRECT_EFFECT * case.law.a * case.law.D_c / fastest**2
        mass = case.mass or least
        start = st.Initial(u_x=law.coefficient(first) / case.k, v_x=0.0, v_y=0.0)
    slider = on_a_line(mass=mass, k_x=case.k, friction=law, drive=drive, driven="spring")
    return slider, start, ("spring_x", state)


def solve(case: Case, times: Floats, rtol: float) -> Floats:
    """Run a case; samples only if wanted."""
    slider, start, names = system(case)
    rate = (len(times) - 1) / times[-1] if len(times) > 2 else 0
    delta = case.law.delta if isinstance(case.law, Smoothing) else None
    run = st.simulate(
        slider, float(times[-1]), initial=start, sample_rate=rate, rtol=rtol, regularisation=delta
    )
    if not run.status.ok:
        raise Failed(str(run.status.value))
    if rate == 0:
        return np.empty((0, 2))
    found = np.stack([run.data[name].values for name in names], axis=1)
    return found * [1.0, case.law.sigma_0] if isinstance(case.law, Bristles) else found
