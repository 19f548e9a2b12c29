"""A solver written from ``docs/method.md`` alone takes the steps of the compiled one."""

from functools import cache
from math import atan2, hypot

import numpy as np
import pytest
from tests.rebuilt.return_map import Patch, angle
from tests.rebuilt.run import Solver

import stiction as st

PAPER = st.presets.nakano_popov_2020()
DAMPED = PAPER.replace(
    phi="5 deg", k_y="1 MN/m", c_x=3.0, c_y=20.0, drive=st.ConstantVelocity("2 mm/s")
)
SOFT = PAPER.replace(phi="10 deg", k_y="10 kN/m", drive=st.ConstantVelocity("20 mm/s"))
ELLIPSE = st.laws.Anisotropic(st.ExponentialWeakening(0.2, 0.1, "10 mm/s"), 1.4, "30 deg")
CASES = {
    "Fig. 3": (PAPER, 0.05),
    "damped": (DAMPED, 0.3),
    "strongly damped": (DAMPED.replace(c_x=20.0, c_y=500.0), 0.3),
    "ellipse": (DAMPED.replace(friction=ELLIPSE), 0.3),
    "static coefficient": (DAMPED.replace(friction=st.Coulomb(0.2, 0.25)), 0.3),
    "soft": (SOFT, 1.0),
    "settling": (DAMPED.replace(phi="30 deg", drive=st.ConstantVelocity("50 mm/s")), 0.1),
}
BEFORE_SLIP = {"u_x": 1.98e-3, "u_y": 2e-7}


def check_agreement(run, rebuilt, duration):
    """Compare steps, sticks and elongations.

    They differ by rounding, which thousands of cycles amplify by hundreds.
    """
    counts = run.statistics
    found = rebuilt.steps, rebuilt.rejected, rebuilt.iterations
    assert found == (counts.steps, counts.rejected, counts.iterations)
    sticks = np.reshape(rebuilt.sticks, (-1, 2))
    assert sticks == pytest.approx(run.stick_intervals, rel=0, abs=1e-13 * duration)
    u = [float(run.data[name][-1]) for name in ("u_x", "u_y")]
    assert rebuilt.u == pytest.approx(u, rel=1e-12)


@cache
def solution(name):
    slider, duration = CASES[name]
    return Solver(slider, 1e-6).run(duration)


@pytest.mark.parametrize("name", CASES)
def test_the_rebuilt_solver_takes_the_same_steps(name):
    slider, duration = CASES[name]
    run = st.simulate(slider, duration, rtol=1e-6, sample_rate=0)
    check_agreement(run, solution(name), duration)


@pytest.mark.parametrize("rtol", [1e-3, 1e-8])
def test_it_does_at_any_tolerance(rtol):
    run = st.simulate(PAPER, 0.05, rtol=rtol, sample_rate=0)
    check_agreement(run, Solver(PAPER, rtol).run(0.05), 0.05)


def test_it_takes_the_same_steps_through_a_rapid_slip():
    """Begun at rest under nearly the whole friction force."""
    v_x, v_y = PAPER.drive.velocity * np.array(PAPER.direction)
    initial = st.Initial(**BEFORE_SLIP, v_x=v_x, v_y=v_y)
    run = st.simulate(PAPER, 0.1, rtol=1e-6, sample_rate=0, initial=initial)
    rebuilt = Solver(PAPER, 1e-6, tuple(BEFORE_SLIP.values()), (0.0, 0.0)).run(0.1)
    assert rebuilt.u[0] < 0.7 * BEFORE_SLIP["u_x"]
    check_agreement(run, rebuilt, 0.1)


def test_the_kinds_of_steps():
    kinds = {kind for name in CASES for kind in solution(name).kinds}
    assert kinds == {"take-off", "slip", "landing", "laid over", "plain", "long"}


def test_elongation_and_friction_of_fig_3():
    """At any time, by a run that ends then; in Newton's error of 1e-10 (M34)."""
    run = st.simulate(PAPER, 0.05, rtol=1e-6, sample_rate=200)
    data = {name: run.data[name].values for name in ("time", "u_x", "u_y", "friction", "theta")}
    for k in range(3, len(data["time"])):
        rebuilt = Solver(PAPER, 1e-6).run(data["time"][k])
        assert rebuilt.u == pytest.approx([data["u_x"][k], data["u_y"][k]], rel=1e-8)
        force = rebuilt.friction_force()
        assert hypot(*force) == pytest.approx(data["friction"][k], rel=1e-8)
        angle = np.degrees(atan2(*force[::-1]))
        assert angle == pytest.approx(data["theta"][k], abs=1e-6)


def test_the_rebuilt_return_map():
    """A few cycles stand for hundreds; (M58) shifts times by 2 epsilon at most (section 15)."""
    rtol, duration = 1e-6, 0.4
    sticks = st.simulate(PAPER, duration, rtol=1e-10, sample_rate=0).stick_intervals
    first = int(np.searchsorted(sticks[:, 1], 0.1))
    start = Solver(PAPER, 1e-10).run(duration, sticks=first + 1)
    patch = Patch(PAPER, rtol, angle(start.holding(start.u)), reach=-0.2)
    found = np.array(list(patch.sticks(start.t)))[: len(sticks) - first - 1]
    assert len(patch.coefficients) < 12
    assert len(found) > 200
    wanted = sticks[first + 1 :][: len(found)]
    assert found == pytest.approx(wanted, rel=0, abs=2 * 0.03 * rtol * duration)
