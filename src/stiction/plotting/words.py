"""A run in words, for the margin of a figure."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, pi, sin
from textwrap import wrap
from typing import Any

from stiction import theory
from stiction.friction import LAWS
from stiction.plotting.style import quantity
from stiction.slider import Slider
from stiction.trajectory import Trajectory

SYMBOLS = {
    "mu_0": r"$\mu_0$",
    "mu_inf": r"$\mu_\infty$",
    "mu_s": r"$\mu_s$",
    "mu_c": r"$\mu_c$",
    "mu_static": r"$\mu_\mathrm{static}$",
    "v_f": "$v_f$",
    "v_s": "$v_s$",
    "v_h": "$v_h$",
}
UNITS = {"v_f": "m/s", "v_s": "m/s", "v_h": "m/s", "c": "s/m"}


def system_in_words(slider: Slider) -> list[str]:
    """Return the mechanical parameters of a slider and its drive, in a few lines."""
    misalignment = f"{degrees(slider.phi):.4g}°".replace("-", "−")
    lines = [
        f"$m$ = {quantity(slider.mass, 'kg')}, $W$ = {quantity(slider.normal_load, 'N')}",
        f"$k_x$ = {quantity(slider.k_x, 'N/m')}, $k_y$ = {quantity(slider.k_y, 'N/m')}",
        rf"$\varphi$ = {misalignment}, $V$ = {quantity(slider.motion.rate(0.0)[0], 'm/s')}",
    ]
    if slider.c_x > 0 or slider.c_y > 0:
        c_x, c_y = (quantity(c, "N s/m") for c in (slider.c_x, slider.c_y))
        lines.insert(2, f"$c_x$ = {c_x}, $c_y$ = {c_y}")
    return lines


def law_in_words(slider: Slider) -> str:
    """Return the friction law: its name, and in a second line what it leaves not at a default."""
    law: Any = slider.law
    defaults = law._field_defaults
    known = (name for name, kind in LAWS.items() if isinstance(law, kind))
    numbers = (
        f"{SYMBOLS.get(name, name)} = {_value(value, UNITS.get(name, ''))}"
        for name, value in law._asdict().items()
        if value != defaults.get(name)
    )
    return f"{next(known, type(law).__name__)}:\n{', '.join(numbers)}"


def _value(value: float | Sequence[float], unit: str) -> str:
    """Return a number with its unit; of a list, how long it is."""
    return f"{len(value)} values" if isinstance(value, Sequence) else quantity(value, unit)


def scales_in_words(slider: Slider) -> list[str]:
    """Return what follows from the parameters: F_0, natural frequencies, damping number."""
    f_x, f_y = (
        float(theory.natural_frequency(k, slider.mass)) / (2 * pi) for k in (slider.k_x, slider.k_y)
    )
    lines = [
        rf"$F_0 = \mu_0 W$ = {quantity(slider.F_0, 'N')}",
        rf"$\omega_x/2\pi$ = {quantity(f_x, 'Hz')}, $\omega_y/2\pi$ = {quantity(f_y, 'Hz')}",
    ]
    V, phi = abs(slider.motion.rate(0.0)[0]), abs(slider.phi)
    if V > 0 and sin(phi) > 0:
        A = float(theory.damping_number(slider.F_0, V, phi, slider.mass, slider.k_x))
        lines.append(rf"$A$ = {A:.4g}, $\zeta(\theta=\varphi)$ = {A * sin(phi) ** 3:.2g}")
    return lines


def outcome_in_words(run: Trajectory, width: int = 38) -> list[str]:
    """Return how the run ended, in lines of at most `width` characters, and how it stuck."""
    times = run.data["time"].values
    lasted, stuck = float(times[-1] - times[0]), run.sticks
    share = 100 * float((stuck[:, 1] - stuck[:, 0]).sum()) / lasted if lasted > 0 else 0.0
    count = f"{len(stuck)} stick{'s' * (len(stuck) != 1)}, {share:.3g} % of the time"
    simulated = f"{quantity(lasted, 's')} simulated"
    return [*wrap(run.status.value, width), simulated, count if len(stuck) else "no stick"]
