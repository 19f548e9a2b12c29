"""Cases with a solution in closed form, or that others have published, to the digits given.

They are one-dimensional: with phi = 0 and nothing moving along y, x is a classical oscillator with
friction. The digits hold for rtol = 1e-10: the error of a run is about 100 rtol of what it swings
through here, far below half a digit.
"""

from math import atan, pi, sqrt, tan

import numpy as np
import pytest

import stiction as st


def oscillator(friction, drive, normal_load=1.0):
    """m = k = 1."""
    return st.Slider(
        mass=1.0,
        k_x=1.0,
        k_y=1.0,
        phi="0 deg",
        normal_load=normal_load,
        friction=friction,
        drive=drive,
    )


# --- forced vibration with Coulomb friction: Den Hartog, Trans. ASME APM-53-9 (1931) ------------


def swinging(amplitude, omega):
    """A drive that swings along X: d = amplitude cos(omega t)."""
    return st.DriveProgram(along=st.Modulation(-amplitude * omega, omega / (2 * pi)))


@pytest.mark.parametrize(
    ("r", "S", "wanted"),
    [(0.7, 0.2, 1.9277745), (1.5, 0.3, 0.7211103), (2.0, 0.4, 0.2666667)],
)
def test_den_hartog_forced_vibration_without_stops(r, S, wanted):
    """x_0 k/P_0 = sqrt(U^2 - (S W)^2), U = 1/(1 - r^2), W = tan(pi/2r)/r, S = F/P_0.

    With x = d - u, what has been slid, Eq. (1) is m x'' + k x = m d'' + k d - F sign(x'): the
    drive d acts as the force P_0 cos(omega t), P_0 = (k - m omega^2) times its amplitude.
    """
    U, W = 1 / (1 - r * r), tan(pi / (2 * r)) / r
    x_0 = sqrt(U**2 - (S * W) ** 2)
    assert x_0 == pytest.approx(wanted, abs=5e-8)

    slider = oscillator(st.Coulomb(mu_0=S), swinging(1 / (1 - r * r), r))
    period = 2 * pi / r
    settled = st.simulate(slider, 100 * period, rtol=1e-10).final
    start = st.Initial(
        u_x=settled["u_x"].item(),
        v_x=settled["v_x"].item(),
        v_y=0.0,
        time=settled["time"].item(),
    )
    # so many samples a period that one is within (pi/20000)^2/2 = 1e-8 of each turning point
    last = st.simulate(slider, period, initial=start, sample_rate=20_000 / period, rtol=1e-10)
    assert len(last.sticks) == 0
    d = np.cos(r * last.data["time"].values) / (1 - r * r)
    x = d - last.data["u_x"].values
    assert x.max() == pytest.approx(x_0, abs=5e-8)
    assert x.min() == pytest.approx(-x_0, abs=5e-8)


# --- free vibration with Coulomb friction: Siconos' example FrictionOscillator ------------------


def test_free_vibration_loses_the_same_at_every_turn():
    """x'' + x = -sign(x'), x(0) = 12, x'(0) = 6: half circles about -1 and 1, until |x| < 1."""
    slider = oscillator(st.Coulomb(mu_0=1.0), st.ConstantVelocity(0.0))
    start = st.Initial(u_x=12.0, v_x=6.0, v_y=0.0)
    first = atan(6 / 13)
    ends = []
    for n in range(7):
        run = st.simulate(slider, first + n * pi, initial=start, rtol=1e-10)
        ends.append(run.final["u_x"].item())
    radius = sqrt(13**2 + 6**2) - 1
    turns = [(-1) ** n * (radius - 2 * n) for n in range(7)]
    assert turns[:2] == pytest.approx([13.317821, -11.317821], abs=5e-7)
    assert ends == pytest.approx(turns, abs=5e-7)

    run = st.simulate(slider, 30.0, initial=start, rtol=1e-10)
    assert run.sticks == pytest.approx(np.array([[22.42356, 30.0]]), abs=5e-6)
    assert run.sticks[0, 0] == pytest.approx(first + 7 * pi, abs=5e-7)
    assert run.final["u_x"].item() == pytest.approx(0.682179, abs=5e-7)


# --- friction that drops in a narrow range of slip speed ----------------------------------------


@pytest.mark.parametrize("d", [2.0, 10.0])
def test_rtol_controls_a_drop_that_does_not_begin_at_rest(d):
    """Stribeck's slope is zero at rest, its drop far below the drive's speed."""
    slider = st.presets.nakano_popov_2020().replace(
        k_y="100 kN/m",
        phi="0 deg",
        c_x=2.0,
        drive=st.ConstantVelocity(5e-3),
        friction=st.Stribeck(mu_s=0.2, mu_c=0.15, v_s=1e-6, d=d),
    )
    exact = st.simulate(slider, 1.0, rtol=1e-12).final["u_x"].item()
    for rtol in (1e-6, 1e-8):
        # many sticks and slips: ten times the tolerance
        found = st.simulate(slider, 1.0, rtol=rtol).final["u_x"].item()
        assert found == pytest.approx(exact, rel=10 * rtol)


# --- stick-slip of a block on a belt: Leine et al., Nonlinear Dynamics 16 (1998) ----------------


def test_leine_block_on_a_belt():
    """k = m = F_s = 1, d = 3, belt speed 0.2."""
    slider = oscillator(st.HyperbolicWeakening(mu_0=1.0, v_h=1 / 3), st.ConstantVelocity(0.2))
    run = st.simulate(slider, 60.0, sample_rate=1e3, rtol=1e-10)
    starts, ends = run.sticks[1:-1].T  # whole ones, after a first cycle
    assert len(starts) == 4
    assert starts[1:] - ends[:-1] == pytest.approx(4.296000, abs=5e-7)
    assert ends - starts == pytest.approx(7.705032, abs=5e-7)
    assert np.diff(starts) == pytest.approx(12.001031, abs=5e-7)
    # half a digit, and (0.5 ms)^2/2 = 1e-7 for the distance of a sample from the extreme
    assert run.data["u_x"].max().item() == pytest.approx(1.133945, abs=6e-7)
    assert run.data["v_x"].min().item() == pytest.approx(-0.839902, abs=6e-7)
