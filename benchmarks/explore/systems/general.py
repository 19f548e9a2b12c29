"""Random apparatus with all that a description can hold, each by its number.

To one of the other kinds come masses and dampers with axes of their own, springs in series, a
driven spring end, measured drives and loads, elliptic surfaces, laws of which the others draw
none, regularised friction, and a start in motion.
"""

from __future__ import annotations

from math import exp

import numpy as np

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import System, system
from benchmarks.explore.systems.unsteady import unsteady_system
from benchmarks.explore.systems.with_state import state_system
from stiction.friction import has_state

KINDS = (system, unsteady_system, state_system)
APART = 3_000_017  # between numbers of drawing an apparatus and what comes to it
ROWS = 400  # more than the fewest, of a recorded drive or load
WAVES = 4  # in it, at most
POINTS = 12  # of a measured law
SMALLEST = 1e-11  # m/s: a regularisation is refused below


def general_system(seed: int, number: int) -> System:
    """Return the system of a number: one of another kind, and what comes to it."""
    draw = Draw(seed, APART + number)
    drawn = draw.among(KINDS)(seed, number)
    slider, duration = drawn.slider, drawn.duration
    stateless = not has_state(slider.law)
    if stateless and draw.chance(0.3):
        slider = slider.replace(friction=other_law(draw, slider))
    if draw.chance(0.25):
        slider = with_record(draw, slider, duration)
    slider = with_axes(draw, slider)
    if draw.chance(0.2) and slider.phi != 0.0:
        slider = with_springs(draw, slider)
    start = in_motion(draw, slider) if draw.chance(0.3) else None
    delta = max(speed(slider) * draw.decades(1e-5, 1e-1), SMALLEST) if draw.chance(0.2) else None
    return System(slider, duration, drawn.rtol, start, delta if stateless else None)


def speed(slider: st.Slider) -> float:
    """Return the drive's speed at the start, or one by which it is as far in a fast period."""
    return abs(slider.motion.rate(0.0)[0]) or slider.F_0 / (slider.k_y * 0.1)


def other_law(draw: Draw, slider: st.Slider):
    """Return a law that the other kinds do not draw, some on an elliptic surface."""
    mu, falls = slider.F_0 / slider.normal_load, draw.between(0.5, 1.0)
    fast = speed(slider) * draw.decades(0.2, 60.0)
    law = draw.among((two_exponentials, power_law, table))(draw, mu, falls, fast)
    if draw.chance(0.3):
        return st.laws.Anisotropic(
            law, draw.decades(0.5, 2.0), f"{draw.between(-90.0, 90.0)!r} deg"
        )
    return law


def two_exponentials(draw: Draw, mu: float, falls: float, fast: float):
    """Return friction that falls about two speeds."""
    first, second = mu * (1.0 - falls), mu * draw.between(0.0, 0.2)
    return st.laws.TwoExponentials(
        mu - first - second, first, fast, second, fast * draw.decades(0.03, 30.0)
    )


def power_law(draw: Draw, mu: float, falls: float, fast: float):
    """Return friction that falls as a power of the speed."""
    return st.laws.PowerLawWeakening(mu, fast, draw.between(0.05, 1.5))


def table(draw: Draw, mu: float, falls: float, fast: float):
    """Return measured friction: a fall with bumps."""
    v = [0.0, *np.cumsum([fast * draw.decades(0.05, 1.0) for _ in range(POINTS - 1)]).tolist()]
    kept = [mu * (falls + (1.0 - falls) * exp(-each / fast)) for each in v]
    return st.laws.Table(v=v, mu=[each * draw.between(0.97, 1.03) for each in kept])


def with_record(draw: Draw, slider: st.Slider, duration: float) -> st.Slider:
    """Return a slider with a recorded drive or load."""
    time, shape = rows_of_a_record(draw, duration)
    if draw.chance(0.4):
        rows = slider.normal_load * (1.0 + 0.15 * (shape - shape[0]))
        piece = st.protocols.RecordedLoad(time=time.tolist(), load=rows.tolist())
        return slider.replace(load=st.protocols.LoadProgram(program=[piece]))
    V, depth = speed(slider), 0.3 if draw.chance(0.8) else 1.0  # some turn back
    if draw.chance(0.7):
        rows = {"velocity": (V * (1.0 + depth * shape)).tolist()}
    else:
        rows = {"position": (V * (time + depth * duration / 30.0 * shape)).tolist()}
    piece = st.protocols.Recorded(time=time.tolist(), **rows)
    return slider.replace(drive=st.protocols.DriveProgram(velocity=V, program=[piece]))


def rows_of_a_record(draw: Draw, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times at uneven intervals, and a few harmonics of all sizes below 2 in sum."""
    count = 24 + int(draw.random() * ROWS)
    gaps = np.array([draw.between(0.8, 1.2) for _ in range(count - 1)])
    time = np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum() * duration])
    shape = np.zeros(count)
    for number in range(1, 1 + int(draw.random() * WAVES)):
        turns = draw.between(0.2, count / 12.0)
        angle = 2.0 * np.pi * (turns * time / duration + draw.random())
        shape += draw.between(0.2, 1.0) / number * np.sin(angle)
    return time, shape


def with_axes(draw: Draw, slider: st.Slider) -> st.Slider:
    """Return a slider whose masses and dampers may have axes of their own."""
    changed = {}
    if draw.chance(0.4):
        changed["mass_y"] = slider.mass * draw.decades(0.2, 2.0)
        if draw.chance(0.5):
            changed["mass_angle"] = f"{draw.between(-45.0, 45.0)!r} deg"
    if draw.chance(0.4):
        changed["damping_angle"] = f"{draw.between(-90.0, 90.0)!r} deg"
    if draw.chance(0.4):
        changed["driven"] = draw.among(("plate", "spring"))
    return slider.replace(**changed) if changed else slider


def with_springs(draw: Draw, slider: st.Slider) -> st.Slider:
    """Return a slider with two springs in series, the softer one nearly as soft as before."""
    angle = f"{draw.between(-10.0, 10.0)!r} deg"
    stiff = draw.decades(2.0, 300.0)
    springs = [
        st.Spring("leaf", slider.k_x, slider.k_y),
        st.Spring("cell", slider.k_x * stiff, slider.k_y * draw.decades(0.3, 30.0), angle=angle),
    ]
    return slider.replace(springs=springs)


def in_motion(draw: Draw, slider: st.Slider) -> st.Initial:
    """Return a start with loaded springs, some of it in motion."""
    c, s = slider.direction
    pull = slider.F_0 * draw.between(-0.3, 0.9)
    u_x, u_y = pull * c / slider.k_x, pull * s / slider.k_y
    if draw.chance(0.5):
        return st.Initial(u_x=u_x, u_y=u_y)
    V = speed(slider) * draw.decades(0.01, 3.0)
    way = draw.between(0.0, 2.0 * np.pi)
    return st.Initial(u_x=u_x, u_y=u_y, v_x=V * np.cos(way), v_y=V * np.sin(way))
