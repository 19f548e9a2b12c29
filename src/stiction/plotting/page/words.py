"""A run in words, for the margin of a figure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import degrees, isfinite, sin
from textwrap import wrap
from typing import Any

from stiction import theory
from stiction.analysis.motion.rest import stuck_share
from stiction.analysis.protocols.friction_test import without_harmonics
from stiction.analysis.slip import is_undersampled
from stiction.drive import ConstantVelocity, drive_stretches
from stiction.drive.pieces import DRIVE_PIECES, LOAD_PIECES, Modulation
from stiction.drive.recorded.piece import RECORDS, Recorded, RecordedLoad
from stiction.friction import Anisotropic, name_of, states
from stiction.system.slider import Slider
from stiction.text.quantity.prefix import DIGITS
from stiction.text.quantity.wording import in_words, percent
from stiction.text.units import hints_of, unit_of
from stiction.trajectory import Trajectory

LETTERS = {"mu": r"\mu", "sigma": r"\sigma", "omega": r"\omega", "theta": r"\theta"}
SUBSCRIPTS = {"inf": r"\infty", "star": "*", "static": r"\mathrm{static}"}
MOST_RECORDS = 2  # of a program, in words
WIDTH = 40  # characters of a line
NAMES = {kind: name for known in (DRIVE_PIECES, LOAD_PIECES) for name, kind in known.items()}


def symbol(name: str) -> str:
    """Return the printed name of a parameter: ``mu_0`` with its subscript."""
    letter, _, subscript = name.partition("_")
    if len(letter) > 1 and letter not in LETTERS:
        return name
    below = SUBSCRIPTS.get(subscript, subscript)
    return f"${LETTERS.get(letter, letter)}" + (f"_{{{below}}}$" if below else "$")


def system_in_words(slider: Slider) -> list[str]:
    """Return the mechanical parameters of a slider and its drive, in a few lines."""
    misalignment = f"{degrees(slider.misalignment):.4g}°".replace("-", "−")
    lines = [
        f"{_masses(slider)}, $W$ = {in_words(slider.normal_load, 'N')}",
        f"$k_x$ = {in_words(slider.k_x, 'N/m')}, $k_y$ = {in_words(slider.k_y, 'N/m')}",
        rf"$\varphi$ = {misalignment}{_base(slider)}",
    ]
    if slider.c_x > 0 or slider.c_y > 0:
        c_x, c_y = (in_words(c, "N s/m") for c in (slider.c_x, slider.c_y))
        lines.insert(2, f"$c_x$ = {c_x}, $c_y$ = {c_y}{_askew(slider.damping_angle - slider.turn)}")
    return lines + protocol_in_words(slider)


def _masses(slider: Slider) -> str:
    """Return the mass, or both where they differ."""
    along = in_words(slider.mass, "kg")
    if slider.mass_y is None:
        return f"$m$ = {along}"
    across = in_words(slider.mass_y, "kg")
    return f"$m_x$ = {along}, $m_y$ = {across}{_askew(slider.mass_angle - slider.turn)}"


def _askew(angle: float) -> str:
    """Return at which angle to x a tensor's first axis lies, if at one."""
    return f" at {degrees(angle):.4g}°".replace("-", "−") if angle else ""


def _base(slider: Slider) -> str:
    """Return the drive's velocity, or its range; nothing if it is recorded, or not known."""
    drive = slider.motion
    V = drive.velocity
    if (ends := velocity_range(slider)) is not None:
        low, high = (in_words(end, "m/s") for end in ends)
        return f", $V$ = {low} to {high}"
    if V == 0.0 and not isinstance(drive, ConstantVelocity) and drive.program:
        return ""
    return f", $V$ = {in_words(V, 'm/s')}"


def velocity_range(slider: Slider) -> tuple[float, float] | None:
    """Return the least and the largest velocity of the pieces of a program, m/s; None without one.

    Harmonics are beside it. A recorded piece says its own.
    """
    drive = slider.motion
    if isinstance(drive, ConstantVelocity):
        return None
    if any(isinstance(piece, RECORDS) for piece in drive.program):
        return None
    start, seen = 0.0, set()
    for end, course in drive_stretches(without_harmonics(drive)):
        seen |= {float(course.rate(at)[0]) for at in (start, end) if isfinite(at)}
        start = end
    return (min(seen), max(seen)) if len(seen) > 1 else None


def protocol_in_words(slider: Slider) -> list[str]:
    """Return the programs of drive and load in words, nothing if they are constant."""
    lines: list[str] = []
    drive, load = slider.motion, slider.load
    if not isinstance(drive, ConstantVelocity):
        moves = "spring driven" if slider.driven == "spring" else "plate driven (drawn at rest)"
        lines += program_in_words(moves, drive.program, drive.repeat)
        for way, harmonic in (("along", drive.along), ("across", drive.across)):
            if harmonic is not None:
                lines.append(f"{way}: ±{harmonic_in_words(harmonic, 'm/s')}")
    if load is not None:
        lines += program_in_words("load", load.program, load.repeat)
        if load.modulation is not None:
            lines.append(f"load: ±{harmonic_in_words(load.modulation, 'N')}")
    return lines


def program_in_words(what: str, program: Sequence[Any], repeat: int) -> list[str]:
    """Return the pieces of a program by name."""
    if not program:
        return []
    names = ", ".join(NAMES[type(piece)] for piece in program)
    times = f" ({repeat} times)" if repeat > 1 else ""
    recorded = [recorded_in_words(piece) for piece in program if isinstance(piece, RECORDS)]
    lines = wrap(f"{what}: {names}{times}", WIDTH, max_lines=3, placeholder=" …")
    return lines + [line for lines in recorded[:MOST_RECORDS] for line in lines]


def recorded_in_words(piece: Recorded | RecordedLoad) -> list[str]:
    """Return the file of a recorded piece, its mean, and its largest deviation from that."""
    unit, made = ("N" if isinstance(piece, RecordedLoad) else "m/s"), piece.recording(0.0)
    mean = float(made.sums[-1]) / piece.duration
    off = max(float(made.bounds[:, 1].max()) - mean, mean - float(made.bounds[:, 0].min()))
    return [
        f"{piece.file or 'recorded'}: {in_words(mean, unit)} on average,",
        f"off by up to {in_words(off, unit)}",
    ]


def harmonic_in_words(harmonic: Modulation, unit: str) -> str:
    """Return amplitude and frequency of a modulation."""
    return f"{in_words(abs(harmonic.amplitude), unit)} at {in_words(harmonic.frequency, 'Hz')}"


def law_in_words(slider: Slider) -> list[str]:
    """Return the friction law: its name, and its parameters in the lines that follow."""
    return [f"{name_of(slider.law)}:", *wrap_words(parameters_in_words(slider.law), WIDTH)]


def parameters_in_words(law: Any) -> list[str]:
    """Return a law's parameters with their units, except those that are zero by default."""
    if isinstance(law, Anisotropic):
        grain = f"across/along {law.ratio:.4g}", f"axis at {degrees(law.angle):.4g}°"
        return [*parameters_in_words(law.law), *grain]
    hints = hints_of(type(law))
    left_out = {name for name, value in law._field_defaults.items() if value == 0}
    words = []
    for name, value in law._asdict().items():
        if isinstance(value, tuple):
            words.append(f"{len(value)} values of {symbol(name)}")
        elif value != 0 or name not in left_out:
            unit = unit_of(hints[name])
            words.append(f"{symbol(name)} = {in_words(value, unit)}")
    return words


def wrap_words(words: Sequence[str], width: int) -> list[str]:
    """Return words, separated by commas, in lines of about `width` characters."""
    lines = [""]
    for word in words:
        longer = f"{lines[-1]}, {word}" if lines[-1] else word
        if len(printed_text(longer)) > width and lines[-1]:
            lines[-1] += ","
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def printed_text(text: str) -> str:
    r"""Return the approximate printed characters of a text with symbols such as $\mu_0$."""
    text = re.sub(r"\\(infty|mu|sigma|omega|theta)", "o", text)
    return re.sub(r"\\mathrm|[${}_\\]", "", text)


def scales_in_words(slider: Slider) -> list[str]:
    """Return derived parameters: F_0, natural frequencies, damping number."""
    f_x, f_y = slider.natural_frequency_x, slider.natural_frequency_y
    lines = [
        rf"$F_0 = \mu_0 W$ = {in_words(slider.F_0, 'N')}",
        rf"$\omega_x/2\pi$ = {in_words(f_x, 'Hz')}, $\omega_y/2\pi$ = {in_words(f_y, 'Hz')}",
    ]
    V, phi = slider.drive_speed, abs(slider.misalignment)
    if V > 0 and sin(phi) > 0 and velocity_range(slider) is None:
        A = theory.damping_number_of(slider, V)
        zeta = plain(A * sin(phi) ** 3)
        lines.append(rf"$A$ = {plain(A)}, $\zeta(\theta=\varphi)$ = {zeta}")
    return lines


def plain(value: float, digits: int = DIGITS) -> str:
    """Return a number in digits up to a million, beyond with a power of ten."""
    if value < 1e6:
        return f"{float(f'{value:.{digits}g}'):.10g}"
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    return rf"${mantissa}\times 10^{{{int(power)}}}$"


OUTCOME_WIDTH = 38  # characters of a line
MEAN_MOTION = "too few samples for such short slips: the line of the slip speed is the mean motion"


def outcome_in_words(run: Trajectory, part: Trajectory) -> list[str]:
    """Return how the run ended, in lines that fit a panel, and how its visible part stuck."""
    times, stuck = part.samples["time"], part.stick_intervals
    first, last = float(times[0]), float(times[-1])
    share = stuck_share(first, last, stuck) if last > first else 0.0
    count = f"{len(stuck)} stick{'s' * (len(stuck) != 1)}, {percent(share, 3)} of the time"
    lasted = float(run.samples["time"][-1] - run.samples["time"][0])
    shown = [] if part is run else [f"{in_words(first, 's')} to {in_words(last, 's')} shown"]
    none = "no true rest: the law has a state" if states(run.slider.law) else "no stick"
    beats = wrap(MEAN_MOTION, OUTCOME_WIDTH) if is_undersampled(part) else []
    return [
        *wrap(run.status.value, OUTCOME_WIDTH),
        f"{in_words(lasted, 's')} simulated",
        *shown,
        count if len(stuck) else none,
        *beats,
    ]
