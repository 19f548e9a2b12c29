"""A session as a user types it: `uv run mypy` reads this file strictly, and pytest runs it.

A quantity is text with its unit, a number in SI, or one of pint. What is read from an object is a
float.
"""

from typing import Any, assert_type

import numpy as np
import pytest
from matplotlib.axes import Axes
from numpy.typing import NDArray
from pint import UnitRegistry

import stiction as st
from stiction import laws, linear_stability, protocols
from stiction.study.plan.coordinates import number

unit: UnitRegistry[Any] = UnitRegistry()
SLIDER = st.Slider(
    mass=250 * unit.gram,
    k_x="1 kN/m",
    k_y=1e7,
    phi="1 deg",
    normal_load="10 N",
    friction=st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f="10 mm/s"),
    drive=st.ConstantVelocity("1 mm/s"),
)


def test_a_slider_takes_quantities_and_has_floats() -> None:
    mass: float = SLIDER.mass
    velocity: float = st.ConstantVelocity(1.0 * unit.mm / unit.second).velocity
    springs = (
        st.Spring("cell", k_x="1 kN/m", k_y="rigid"),
        st.Spring("arm", "2 kN/m", 3e3, angle=3.0 * unit.degree),
    )
    slider = st.Slider(
        mass="0.25 kg", phi=1.0 * unit.degree, normal_load=10, springs=springs, friction=SLIDER.law
    )
    assert (mass, velocity, slider.normal_load) == (0.25, 1e-3, 10.0)


def test_laws_take_quantities() -> None:
    law = laws.Stribeck(mu_s=0.3, mu_c=0.2, v_s="10 mm/s", c="0.5 s/m")
    speed: float = laws.ExponentialWeakening(0.3, 0.2, 10.0 * unit.mm / unit.second).v_f
    table = laws.Table(v=["0 m/s", 0.1, "1 m/s"], mu=[0.3, 0.2, 0.2])
    assert (law.v_s, speed, table.v) == (0.01, 0.01, (0.0, 0.1, 1.0))


def test_programs_take_quantities() -> None:
    program = protocols.DriveProgram(
        velocity="1 mm/s",
        program=[
            protocols.Ramp("2 mm/s", "1 s"),
            protocols.Ramp(2e-3, 1.0),
            protocols.Step(by="1 mm/s", duration=1.0 * unit.second),
            protocols.Hold("3 s"),
            protocols.Harmonic("0.1 mm/s", "3 Hz", "90 deg", duration="1 s"),
            protocols.Constant(1.0 * unit.mm / unit.second),
        ],
    )
    steps = protocols.velocity_steps(["1 mm/s", 2e-3, 3.0 * unit.mm / unit.second], distance="1 mm")
    load = protocols.LoadProgram(program=[protocols.Ramp(20.0 * unit.N, "1 s")])
    slider = SLIDER.replace(drive=program, load=load)
    assert slider.motion.rate(100.0)[0] == pytest.approx(1e-3)
    assert slider.weight(2.0) == pytest.approx(20.0)
    assert steps.rate(0.0)[0] == pytest.approx(1e-3)


def test_runs_and_records_take_quantities() -> None:
    run = st.simulate(SLIDER, "20 ms", sample_rate=1.0 * unit.kHz, initial=st.Initial(u_x="1 um"))
    start: st.Initial = run.state(10.0 * unit.ms)
    record = st.Record(time=[0.0, 1.0], force=[1.0, 2.0], normal_load=1.0 * unit.N, mass="1 kg")
    sensor = st.Sensor(noise="1 mN", bandwidth="100 Hz")
    assert start.time == pytest.approx(0.01)
    assert (record.normal_load, sensor.noise) == (1.0, 1e-3)


def test_studies_take_quantities() -> None:
    base = st.Description(SLIDER, st.Initial(), st.Settings(duration="20 ms"))
    axes = {
        "phi": st.Grid(1.0 * unit.degree, "3 deg", 3),
        "mass": st.Values(["0.1 kg", 0.2, 300.0 * unit.gram]),
    }
    study = st.Study(base=base, axes=axes)
    assert study.coordinates["phi"].values == pytest.approx([1.0, 2.0, 3.0])
    assert study.coordinates["mass"].values == pytest.approx([0.1, 0.2, 0.3])
    assert number(30.0 * unit.degree, "deg") == pytest.approx(number("30 deg", "deg")) == 30.0
    found = linear_stability.critical(SLIDER, "phi", (1.0 * unit.degree, "60 deg"))
    assert found == linear_stability.critical(SLIDER, "phi", ("1 deg", "60 deg"))


def test_a_misspelt_argument_is_marked_before_it_runs() -> None:
    """Mypy marks each of these lines, or refuses the comment by which it is told to let it pass."""
    with pytest.raises(st.DescriptionError, match="stifness"):
        st.Spring("cell", stifness="1 kN/m")  # type: ignore[call-arg]
    with pytest.raises(st.DescriptionError, match="normal_laod"):
        st.Slider(mass=1, phi="1 deg", normal_laod=1, friction=SLIDER.law)  # type: ignore[call-arg]
    with pytest.raises(st.DescriptionError, match="rtoll"):
        st.Settings(duration="1 s", rtoll=1e-6)  # type: ignore[call-arg]
    with pytest.raises(st.DescriptionError, match="gian"):
        st.Sensor(noise="1 mN", gian=1.02)  # type: ignore[call-arg]
    with pytest.raises(st.DescriptionError, match="nubmer"):
        st.Grid("1 deg", "3 deg", nubmer=3)  # type: ignore[call-arg]
    with pytest.raises(st.DescriptionError, match="v_g"):
        laws.ExponentialWeakening(0.3, 0.2, v_g="1 mm/s")  # type: ignore[call-arg]


def test_a_checker_knows_what_a_drawing_returns() -> None:
    """It was Any: an editor completed nothing, and found no misspelt panel."""
    run = st.simulate(SLIDER, "20 ms")
    assert_type(run.plot(), dict[str, Axes])
    assert_type(SLIDER.plot(), Axes)
    assert_type(st.compare(run.description, "coulomb").plot(), dict[str, Axes])
    assert_type(st.analysis.record_of(run).plot(), NDArray[np.object_])


def test_engines_have_types() -> None:
    assert_type(st.Threads(4).workers, int)
    assert_type(st.Scheduler("tcp://node-1:8786").address, str)
