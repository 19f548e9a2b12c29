"""Random apparatus whose drive or load changes in time, each by its number."""

from __future__ import annotations

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import System, system
from benchmarks.explore.systems.with_state import state_system

PIECES = 6  # of a program, at most
CYCLES = 300.0  # of a harmonic, at most
APART = 1_000_003  # between numbers of drawing an apparatus and its program


def unsteady_system(seed: int, number: int) -> System:
    """Return the system of a number: one of the other two kinds, with a program."""
    draw = Draw(seed, APART + number)
    drawn = (system if draw.chance(0.7) else state_system)(seed, number)
    slider, duration = drawn.slider, drawn.duration
    changed = draw.random()
    if changed < 0.7:
        slider = slider.replace(drive=drive(draw, slider, duration))
    if changed > 0.5:
        slider = slider.replace(load=load(draw, slider, duration))
    return System(slider, duration, drawn.rtol)


def drive(draw: Draw, slider: st.Slider, duration: float) -> st.protocols.DriveProgram:
    """Return velocity steps, ramps, holds, reversals and harmonics, some shaken."""
    V = abs(slider.motion.rate(0.0)[0])
    pieces = [piece(draw, V, part) for part in parts(draw, duration)]
    along = shaking(draw, slider, duration, V * draw.decades(0.01, 3.0))
    across = shaking(draw, slider, duration, V * draw.decades(1e-3, 0.3))
    program = pieces if draw.chance(0.8) else []
    return st.protocols.DriveProgram(velocity=V, program=program, along=along, across=across)


def load(draw: Draw, slider: st.Slider, duration: float) -> st.protocols.LoadProgram:
    """Return steps, ramps and harmonics that leave at least a tenth of the load."""
    W = slider.normal_load
    pieces = []
    for part in parts(draw, duration):
        other = W * draw.between(0.4, 1.6)
        kind = draw.among((st.protocols.Constant, st.protocols.Ramp))
        pieces.append(kind(other, part))
    shaken = shaking(draw, slider, duration, W * draw.between(0.01, 0.3))
    return st.protocols.LoadProgram(program=pieces if draw.chance(0.7) else [], modulation=shaken)


def parts(draw: Draw, duration: float) -> list[float]:
    """Return durations that add up to a whole one."""
    shares = [draw.decades(0.1, 1.0) for _ in range(1 + int(draw.random() * PIECES))]
    return [duration * share / sum(shares) for share in shares]


def piece(draw: Draw, V: float, duration: float):
    """Return a piece of a drive's program."""
    kind, other = draw.random(), V * draw.decades(0.1, 3.0)
    if kind < 0.3:
        return st.protocols.Constant(other, duration)
    if kind < 0.5:
        return st.protocols.Ramp(other if draw.chance(0.8) else -other, duration)
    if kind < 0.65:
        return st.protocols.Hold(duration)
    if kind < 0.8:
        return st.protocols.Reversal(duration)
    return st.protocols.Harmonic(other, draw.decades(1.0, 30.0) / duration, "0 deg", duration)


def shaking(
    draw: Draw, slider: st.Slider, duration: float, amplitude: float
) -> st.protocols.Modulation | None:
    """Return a harmonic from slow to faster than either oscillation, or none."""
    if draw.chance(0.65):
        return None
    fast = 2.0 * max(slider.natural_frequencies)
    frequency = draw.decades(1.0 / duration, max(2.0 / duration, min(fast, CYCLES / duration)))
    return st.protocols.Modulation(amplitude, frequency, f"{draw.between(0.0, 360.0)!r} deg")
