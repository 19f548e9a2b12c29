"""What creep tells does not depend on the size of the apparatus: fits have no unit."""

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from tests.parts import creep_of

import stiction as st

SEED, NUMBER = 20261127, 12
# length and time; powers of two, so that runs are the same to the last bit
SIZES = {"micrometres": (2.0**-20, 2.0**-12), "kilometres": (2.0**10, 2.0**18)}


def rig(number, length=1.0, time=1.0):
    """A rig that creeps before it slips, its lengths and times scaled."""
    draw = Draw(SEED, number)
    mu, load, k_x = draw.between(0.1, 0.8), draw.decades(1.0, 100.0), draw.decades(1e3, 1e5)
    mass = k_x / (2.0 * np.pi * draw.decades(3.0, 30.0)) ** 2
    V = mu * load / k_x / draw.between(1.0, 4.0)
    return st.Slider(
        mass=mass,
        k_x=k_x / time**2,
        k_y=k_x * draw.decades(300.0, 1e4) / time**2,
        phi=f"{draw.between(0.5, 4.0)!r} deg",
        normal_load=load * length / time**2,
        friction=st.ExponentialWeakening(mu, 0.5 * mu, 20.0 * V * length / time),
        drive=st.ConstantVelocity(V * length / time),
    ), 12.0 * time  # fmt: skip


def found_in(number, length=1.0, time=1.0):
    """Exponent, lag, angle and its error, without units; None where not determined."""
    slider, duration = rig(number, length, time)
    seen = creep_of(st.simulate(slider, duration, sample_rate=4096.0 * 6.0 / duration))
    n, angle = seen.divergence, seen.misalignment
    return (
        n and (n.exponent, n.exponent_error, n.lag / time),
        angle and (angle.phi, angle.phi_error, angle.F_0 / length * time**2),
    )


@pytest.fixture(scope="module")
def expected():
    return [found_in(number) for number in range(NUMBER)]


@pytest.mark.parametrize("size", SIZES)
def test_a_rig_of_another_size_creeps_with_the_same_exponent_and_angle(size, expected):
    """Steps of the fits were 1e-8 m/s and s at least: 18 of 300 rigs told other things."""
    told = 0
    for number in range(NUMBER):
        found = found_in(number, *SIZES[size])
        for its, same in zip(found, expected[number], strict=True):
            assert (its is None) == (same is None), number
            if its is not None:
                told += 1
                assert its == pytest.approx(same, rel=1e-6, abs=1e-9), number
    assert told > NUMBER
