"""The paper's closed forms, as plain functions of floats or arrays.

K. Nakano and V. L. Popov, "Dynamic stiction without static friction: The role of friction vector
rotation", Phys. Rev. E 102, 063001 (2020), cited below as the paper; equation numbers are those of
its preprint, arXiv:2008.01854. Arguments broadcast against each other; numbers are in SI units
and angles in radians, while text has its unit, as in ``"1 mm/s"`` and ``"1 deg"``. A value
that the theory does not give is NaN.

The creep before slip (Eq. 7) is quasistatic: friction keeps its magnitude F_0 = mu_0 W and turns,
the spring follows with k_x u_x = F_0 cos(theta), u_y is constant. With s = V t/l_x the angle obeys

    d theta/ds = -sin(theta - phi)/sin^2(theta),    theta(0) = pi/2,

whose solution is s = G(pi/2) - G(theta), with

    G(theta) = -cos(theta + phi) + sin^2(phi) ln tan((theta - phi)/2).

At early times that is a difference of nearly equal numbers, and at late ones theta - phi falls
below the spacing of floats. So the functions here use the turn delta = pi/2 - theta and

    w = ln[tan(pi/4 - phi/2) / tan((theta - phi)/2)],    0 <= w < infinity,

which give the same closed form without a cancellation at either end:

    s = 2 sin(delta/2) cos(phi - delta/2) + sin^2(phi) w.

Since ds/dw = sin^2(theta) falls as w grows, s(w) is concave, and Newton's method started at a lower
bound of w climbs to the root and never passes it: no bracket, no failure.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiction.arguments import is_numeric, name_arguments
from stiction.arrays import Floats
from stiction.errors import DescriptionError, echo
from stiction.names import old_keywords
from stiction.system.description import Description
from stiction.system.slider import Slider, slider_of
from stiction.text.units import FORCE, LENGTH, TIME, VELOCITY, Kind, Quantity, unit_on
from stiction.text.validation import read_number

SI = {None, "1", "kg", "m", "s", "m/s", "s/m", "N", "N/m", "N*s/m", "rad"}
REMEDY = ".to_base_units().magnitude of a quantity, or the values of an array, in SI"

KINDS = {  # of arguments that may be given as text with a unit, by their names
    **dict.fromkeys(("V",), VELOCITY),
    **dict.fromkeys(("F_0", "W"), FORCE),
    **dict.fromkeys(("l_x", "u_x", "D_c"), LENGTH),
    **dict.fromkeys(("phi", "theta"), Kind("an angle", "rad", "1 deg")),
    **dict.fromkeys(("k", "k_x", "k_y"), Kind("a stiffness", "N/m", "1 kN/m")),
    "m": Kind("a mass", "kg", "250 g"),
    "t": TIME,
    "c_x": Kind("a damping coefficient", "N*s/m", "1 N s/m"),
    "slope": Kind("a slope of friction over speed", "s/m", "1 s/m"),
}
_F = TypeVar("_F", bound=Callable[..., Any])


def _formula(function: _F) -> _F:
    """Decorate a formula: it takes text with a unit as a number in SI, and has limits.

    Numbers are taken as they are: a bare angle is in radians, as in the equations; among texts it
    is refused. Zeros and infinities are limits (no misalignment, no end of creep), not accidents.
    """
    names = tuple(signature(function).parameters)

    @wraps(function)
    @np.errstate(divide="ignore", invalid="ignore", over="ignore")
    def read(*args: Any, **values: Any) -> Any:
        if any(map(_is_text, args)) or any(map(_is_text, values.values())):
            args = tuple(map(_in_si, names, args)) + args[len(names) :]
            values = {name: _in_si(name, value) for name, value in values.items()}
        return function(*args, **values)

    return cast(_F, read)


def _is_text(value: Any) -> bool:
    """Return whether a value is text, or has text among its elements."""
    return isinstance(value, str) or (isinstance(value, list | tuple) and any(map(_is_text, value)))


def _in_si(name: str, value: Any) -> Any:
    """Return text, or a list with text, as numbers in SI where it is a quantity."""
    if name not in KINDS or not _is_text(value):
        return value
    if isinstance(value, str):
        return read_number(name, value, KINDS[name])
    angle = KINDS[name].unit == "rad"
    for at, each in enumerate(value, 1):
        if angle and not _is_text(each):
            told = f"degree or radian? write '{echo(each)} deg' or '{echo(each)} rad'"
            raise DescriptionError.of(f"{name}.{at}", told)
    return np.array([_in_si(name, each) for each in value])


@old_keywords(stiffness="k", mass="m")
@_formula
def natural_frequency(k: ArrayLike, m: ArrayLike) -> Floats:
    """Angular natural frequency sqrt(k/m), rad/s (omega_x, omega_y of the paper).

    Parameters
    ----------
    k : array_like
        Principal stiffness, k_x or k_y (N/m).
    m : array_like
        Mass (kg).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(st.theory.natural_frequency(10e6, 0.25) / (2 * np.pi)), 1)
    1006.6
    """
    k, m = _floats(k, m)
    return np.sqrt(k / m)


@old_keywords(normal_load="W")
@_formula
def friction_force(mu_0: ArrayLike, W: ArrayLike) -> Floats:
    """Friction at vanishing slip speed, F_0 = mu_0 W (N); mu_0 (-), normal load W (N).

    Examples
    --------
    >>> import stiction as st
    >>> float(st.theory.friction_force(0.2, 10.0))
    2.0
    """
    mu_0, W = _floats(mu_0, W)
    return mu_0 * W


@_formula
def slip_length(F_0: ArrayLike, k_x: ArrayLike) -> Floats:
    """Elongation that carries the whole friction, F_0/k_x (m), of Eq. (8); F_0 (N), k_x (N/m).

    Examples
    --------
    >>> import stiction as st
    >>> float(st.theory.slip_length(2.0, 1e3))
    0.002
    """
    F_0, k_x = _floats(F_0, k_x)
    return F_0 / k_x


@_formula
def elongation_rate(u_x: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike) -> Floats:
    """Right-hand side of Eq. (7): du_x/dt of the quasistatic creep (m/s).

    Parameters
    ----------
    u_x : array_like
        Elongation along x (m); NaN beyond `l_x`.
    V : array_like
        Drive velocity (m/s), V >= 0, else NaN.
    phi : array_like
        Misalignment (rad), 0 <= phi <= pi/2, else NaN.
    l_x : array_like
        Slip length (m), see `slip_length`.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(st.theory.elongation_rate(0.0, 1e-3, np.radians(1.0), 2e-3)), 6)
    0.001
    """
    u_x, V, phi, l_x = _floats(u_x, V, phi, l_x)
    x = np.where(_applies(V, phi), u_x / l_x, np.nan)
    return V * (np.cos(phi) - np.sin(phi) * x / np.sqrt((1.0 - x) * (1.0 + x)))


@_formula
def creep_time(theta: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike) -> Floats:
    """Time at which the friction force has turned to `theta` (s): closed form of Eq. (7).

    The paper leaves Eq. (7) as a differential equation; this is its solution from u_x(0) = 0.

    Parameters
    ----------
    theta : array_like
        Angle of the friction force to the x axis (rad), phi <= theta <= pi/2, else NaN;
        infinite at theta = phi > 0.
    V, phi, l_x : array_like
        Drive velocity (m/s), misalignment (rad), slip length (m), as of `creep_force_angle`.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(st.theory.creep_time(np.radians(45.0), 1e-3, np.radians(1.0), 2e-3)), 3)
    1.425
    """
    theta, V, phi, l_x = _floats(theta, V, phi, l_x)
    delta, half = np.pi / 2 - theta, (theta - phi) / 2
    w = np.log1p(np.sin(delta / 2) / (np.cos(np.pi / 4 - phi / 2) * np.sin(half)))
    turned = (delta >= 0) & (half >= 0) & _applies(V, phi)
    s = np.where(turned, np.where(delta == 0, 0.0, _scaled_time(delta, w, phi)), np.nan)
    return s * l_x / V


@_formula
def creep_force_angle(t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike) -> Floats:
    """Angle theta of the friction force to the x axis during creep (rad): Eq. (7), solved.

    The inverse of `creep_time`: falls from pi/2 at t = 0 towards phi, which it reaches only
    exponentially. At phi = 0 it is arccos(V t/l_x) until V t = l_x, and 0 from then on.

    Parameters
    ----------
    t : array_like
        Time since the drive started with u_x = 0 (s), t >= 0, else NaN.
    V : array_like
        Drive velocity (m/s), V >= 0, else NaN.
    phi : array_like
        Misalignment (rad), 0 <= phi <= pi/2, else NaN.
    l_x : array_like
        Slip length (m), see `slip_length`.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(np.degrees(st.theory.creep_force_angle(1.0, 1e-3, np.radians(1.0), 2e-3))), 1)
    60.2
    """
    delta, rest, phi = _creep(t, V, phi, l_x)
    return np.where(delta < rest, np.pi / 2 - delta, phi + rest)[()]  # the less rounded of the two


@_formula
def creep_elongation(t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike) -> Floats:
    """Elongation during creep, u_x(t) = l_x cos(theta) (m): the solution of Eq. (7).

    Parameters are those of `creep_force_angle`.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(st.theory.creep_elongation(1.0, 1e-3, np.radians(1.0), 2e-3)), 6)
    0.000995
    """
    delta, _, _ = _creep(t, V, phi, l_x)
    return np.asarray(l_x, dtype=np.float64) * np.sin(delta)


@_formula
def creep_velocity(t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike) -> Floats:
    """Laboratory velocity during creep, X'(t) = V sin(phi) cos(theta - phi)/sin(theta) (m/s).

    Eq. (7) in Eq. (6) with constant u_y. Grows from V sin^2(phi) to V. At phi = 0 it is 0 until
    V t = l_x and V from then on, the limit of small misalignment.

    Parameters are those of `creep_force_angle`.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(1e6 * st.theory.creep_velocity(1.0, 1e-3, np.radians(1.0), 2e-3)), 2)
    10.31
    """
    delta, rest, phi = _creep(t, V, phi, l_x)
    t, V, l_x = _floats(t, V, l_x)
    ratio = np.sin(phi) * np.sin(phi + delta) / np.sin(phi + rest)  # cos(rest), well rounded
    return V * np.where((phi == 0) & (rest == 0), V * t > l_x, ratio)


@_formula
def creep_velocity_approximation(
    t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike
) -> Floats:
    """Creep velocity at small misalignment, V phi (phi + s/sqrt(1 - s^2)), s = V t/l_x (m/s).

    Eq. (8), corrected. The paper prints s^2 in the numerator; expanding Eq. (7) gives s, which is
    also what the paper's text says ("linear in phi and of second order in V": V s). The relative
    error against `creep_velocity` is of first order in phi, because Eq. (8) keeps only one of the
    two terms in phi^2; the other is -V phi^2 (1 - c)/c^3, c = sqrt(1 - s^2).

    Parameters are those of `creep_force_angle`; NaN unless 0 <= s < 1.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> speed = st.theory.creep_velocity_approximation(1.0, 1e-3, np.radians(1.0), 2e-3)
    >>> round(float(1e6 * speed), 2)
    10.38
    """
    return _creep_expansion(t, V, phi, l_x, power=1)


@_formula
def creep_velocity_as_printed(t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike) -> Floats:
    """Eq. (8) as printed, V phi (phi + s^2/sqrt(1 - s^2)), s = V t/l_x (m/s), for comparison only.

    It is not the limit of Eq. (7): see `creep_velocity_approximation`, which takes the same
    parameters.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(1e6 * st.theory.creep_velocity_as_printed(1.0, 1e-3, np.radians(1.0), 2e-3)), 2)
    5.34
    """
    return _creep_expansion(t, V, phi, l_x, power=2)


@_formula
def transverse_deflection(F_0: ArrayLike, k_y: ArrayLike) -> Floats:
    """Mean transverse elongation during creep, F_0/k_y (m); F_0 (N), k_y (N/m). From Eq. (9).

    Examples
    --------
    >>> import stiction as st
    >>> float(st.theory.transverse_deflection(2.0, 10e6))
    2e-07
    """
    F_0, k_y = _floats(F_0, k_y)
    return F_0 / k_y


@_formula
def transverse_amplitude_bound(V: ArrayLike, phi: ArrayLike, omega_y: ArrayLike) -> Floats:
    """Largest amplitude of the transverse oscillation without reversal of slip (m). From Eq. (9).

    The oscillation about `transverse_deflection` is free while u_y' < V sin(phi), which bounds
    its amplitude by V sin(phi)/omega_y.

    Parameters
    ----------
    V, phi : array_like
        Drive velocity (m/s), misalignment (rad).
    omega_y : array_like
        Transverse natural frequency (rad/s), see `natural_frequency`.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(1e9 * st.theory.transverse_amplitude_bound(1e-3, np.radians(1.0), 6324.6)), 2)
    2.76
    """
    V, phi, omega_y = _floats(V, phi, omega_y)
    return np.asarray(np.abs(V * np.sin(phi)) / omega_y)[()]


@_formula
def oscillation_frequency(theta: ArrayLike, k_x: ArrayLike, k_y: ArrayLike, m: ArrayLike) -> Floats:
    """Angular frequency at which the mass swings along the friction force during creep (rad/s).

    sqrt((k_x cos^2(theta) + k_y sin^2(theta))/m), nearly omega_y sin(theta). Not in the paper,
    which finds omega_y at first and that it falls towards slip (Fig. 4). Slip has the direction of
    the friction; across it the mass is held as by a damper of F_0/(m |s|) per second, which is far
    above omega_y where |s| is about V sin(phi). So it swings along the force alone, against the
    stiffness in that direction. The short sticks of each swing, which make its period about 0.5 %
    longer at the paper's parameters, are left out.

    Parameters
    ----------
    theta : array_like
        Angle of the friction force to the x axis (rad), see `creep_force_angle`.
    k_x, k_y, m : array_like
        Stiffnesses (N/m), mass (kg).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(st.theory.oscillation_frequency(np.pi / 2, 1e3, 10e6, 0.25)), 1)
    6324.6
    """
    theta, k_x, k_y, m = _floats(theta, k_x, k_y, m)
    omega: Floats = np.sqrt((k_x * np.cos(theta) ** 2 + k_y * np.sin(theta) ** 2) / m)
    return omega


@_formula
def damping_number(
    F_0: ArrayLike, V: ArrayLike, phi: ArrayLike, m: ArrayLike, k_x: ArrayLike
) -> Floats:
    """Damping number A = F_0/(2 V sin(phi) sqrt(m k_x)) of Eq. (10), dimensionless.

    Parameters
    ----------
    F_0 : array_like
        Friction force mu_0 W (N).
    V, phi : array_like
        Drive velocity (m/s), misalignment (rad).
    m, k_x : array_like
        Mass (kg), stiffness along x (N/m).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(st.theory.damping_number(2.0, 1e-3, np.radians(1.0), 0.25, 1e3)), 1)
    3623.9
    """
    F_0, V, phi, m, k_x = _floats(F_0, V, phi, m, k_x)
    return F_0 / (2.0 * V * np.sin(phi) * np.sqrt(m * k_x))


@name_arguments
def damping_number_of(
    slider: Slider | Description | str | Path, V: Quantity, phi: Quantity | None = None
) -> float:
    """Damping number A of Eq. (10) of a slider that is driven at `V` (m/s), dimensionless.

    `phi` (rad) is by default the slider's misalignment. The signs of both do not matter. The
    slider may be that of a description, or of its file.

    Examples
    --------
    >>> import stiction as st
    >>> round(st.theory.damping_number_of(st.presets.nakano_popov_2020(), 1e-3), 1)
    3623.9
    >>> round(st.theory.damping_number_of(st.presets.nakano_popov_2020(), "1 mm/s", "1 deg"), 1)
    3623.9
    """
    slider, speed = slider_of(slider), _one_number("V", V)
    angle = abs(slider.misalignment if phi is None else _one_number("phi", phi))
    return float(damping_number(slider.F_0, abs(speed), angle, slider.masses[0], slider.k_x))


def _one_number(name: str, value: Any) -> float:
    """Return a single finite quantity in SI."""
    value = _in_si(name, value) if isinstance(value, str) else value
    if not isinstance(value, bool | np.bool_) and is_numeric(value) and np.ndim(value) == 0:
        if np.isfinite(value):
            return float(value)
        raise DescriptionError.of(name, f"must be finite, is {echo(value)}")
    raise DescriptionError.of(name, f"must be one number, or one with its unit, is {echo(value)}")


@_formula
def damping_ratio(A: ArrayLike, theta: ArrayLike) -> Floats:
    """Damping ratio zeta = A sin^3(theta) of Eq. (10); A = `damping_number`, theta in rad.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> float(st.theory.damping_ratio(8.0, np.radians(30.0)).round(3))
    1.0
    """
    A, theta = _floats(A, theta)
    zeta: Floats = A * np.sin(theta) ** 3
    return zeta


@_formula
def critical_angle(A: ArrayLike) -> Floats:
    """Force angle at which zeta = 1 in Eq. (10), arcsin(A^(-1/3)) (rad): slow slip turns fast.

    NaN where the `damping_number` A < 1: such a system is underdamped from the start.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(np.degrees(st.theory.critical_angle(8.0))), 1)
    30.0
    """
    (A,) = _floats(A)
    return np.arcsin(np.where(A >= 1.0, 1.0 / np.cbrt(A), np.nan))


@_formula
def first_stick_duration(
    F_0: ArrayLike, V: ArrayLike, phi: ArrayLike, k_x: ArrayLike, k_y: ArrayLike
) -> Floats:
    """Duration of the first stick of the undamped system, from rest at u = 0 (s).

    Not in the paper, which has no stick: with set-valued friction at zero slip the object rests
    until the spring force |K u| = V t sqrt((k_x cos phi)^2 + (k_y sin phi)^2) reaches F_0.

    Parameters
    ----------
    F_0 : array_like
        Friction force mu_0 W (N).
    V, phi : array_like
        Drive velocity (m/s), misalignment (rad).
    k_x, k_y : array_like
        Principal stiffnesses (N/m).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(1e3 * st.theory.first_stick_duration(2.0, 1e-3, np.radians(1.0), 1e3, 10e6)), 2)
    11.46
    """
    F_0, V, phi, k_x, k_y = _floats(F_0, V, phi, k_x, k_y)
    return np.asarray(F_0 / (np.abs(V) * np.hypot(k_x * np.cos(phi), k_y * np.sin(phi))))[()]


@_formula
def first_force_angle(phi: ArrayLike, k_x: ArrayLike, k_y: ArrayLike) -> Floats:
    """Angle of the spring force to the x axis while the object rests, from u = 0 (rad).

    Not in the paper, where a stiff transverse spring makes it a right angle: the force of both
    springs, (k_x cos phi, k_y sin phi) V t, points along the drive if k_x = k_y.

    Parameters
    ----------
    phi : array_like
        Misalignment (rad).
    k_x, k_y : array_like
        Principal stiffnesses (N/m).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> round(float(np.degrees(st.theory.first_force_angle(np.radians(1.0), 1e3, 10e6))), 2)
    89.67
    """
    phi, k_x, k_y = _floats(phi, k_x, k_y)
    angle: Floats = np.arctan2(k_y * np.sin(phi), k_x * np.cos(phi))
    return angle


@_formula
def critical_misalignment(
    V: ArrayLike, mu: ArrayLike, slope: ArrayLike, *, c_x: ArrayLike = 0.0, W: ArrayLike = 1.0
) -> Floats:
    """Misalignment beyond which steady sliding is stable, for k_y -> infinity (rad).

    Not in the paper. Linearised at s = v_d, friction F(v) = mu(v) W damps the motion along x with
    c_x + F'(V) cos^2(phi) + F(V)/V sin^2(phi), which is zero at

        tan^2(phi_c) = -(c_x + F'(V))/(c_x + F(V)/V).

    Zero where steady sliding is stable at any misalignment. The finite k_y of Fig. 3 shifts it by
    0.0007 deg, see `stiction.linear_stability`.

    Parameters
    ----------
    V : array_like
        Drive velocity (m/s).
    mu, slope : array_like
        Friction coefficient and its derivative (s/m) at the slip speed V.
    c_x : array_like
        Damping constant of the spring along x (N s/m).
    W : array_like
        Normal load (N); it matters only beside c_x.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> law = st.presets.nakano_popov_2020().law
    >>> found = st.theory.critical_misalignment(1e-3, law.coefficient(1e-3), law.slope(1e-3))
    >>> round(float(np.degrees(found)), 2)
    8.66
    """
    V, mu, slope, c_x, W = _floats(V, mu, slope, c_x, W)
    weakening = np.maximum(-(c_x + W * slope), 0.0)
    return np.arctan(np.sqrt(weakening / (c_x + W * mu / V)))


@_formula
def critical_stiffness(
    a: ArrayLike, b: ArrayLike, D_c: ArrayLike, W: ArrayLike, V: ArrayLike, m: ArrayLike
) -> Floats:
    """Stiffness below which steady sliding with rate-and-state friction is unstable (N/m).

        k_c = (b - a) W/D_c [1 + m V^2/(a W D_c)]

    for motion along the spring: Rice & Ruina, J. Appl. Mech. 50 (1983), 343. It holds for ageing
    and slip law; per unit area W is the normal stress, m the mass per area, and k_c in Pa/m. It is
    negative where friction strengthens, a > b: then steady sliding is stable on any spring. With a
    misalignment, or a spring across, see ``st.stability(slider, over="k_x")``.

    Parameters
    ----------
    a, b, D_c : array_like
        Direct effect, evolution effect, slip distance (m).
    W, V, m : array_like
        Normal load (N), drive velocity (m/s), mass (kg).

    Examples
    --------
    >>> import stiction as st
    >>> round(float(st.theory.critical_stiffness(0.010, 0.015, 10e-6, 10.0, 1e-6, 1e-3)))
    5000
    """
    a, b, D_c, W, V, m = _floats(a, b, D_c, W, V, m)
    return (b - a) * W / D_c * (1.0 + m * V**2 / (a * W * D_c))


def __dir__() -> list[str]:
    """List the closed forms, without their helpers."""
    own = (getattr(each, "__module__", "") == __name__ for each in globals().values())
    listed = (name for name, is_own in zip(globals(), own, strict=True) if is_own)
    return sorted(name for name in listed if not name.startswith("_"))


def _floats(*values: ArrayLike) -> tuple[Floats, ...]:
    for value in values:
        if (unit := unit_on(value)) not in SI:
            told = f"the theory takes numbers in SI, not in {unit}; write {REMEDY}"
            raise DescriptionError.of("", told)
        if not is_numeric(value):
            told = f"the theory takes numbers in SI, or arrays of them, not {echo(value)}"
            raise DescriptionError.of("", told)
    return tuple(np.asarray(value, dtype=np.float64) for value in values)


def _applies(V: Floats, phi: Floats) -> NDArray[np.bool_]:
    """Whether creep by Eq. (7) has this drive velocity and misalignment: both turn one way."""
    return np.asarray((V >= 0) & (phi >= 0) & (phi <= np.pi / 2))


def _scaled_time(delta: Floats, w: Floats, phi: Floats) -> Floats:
    """V t/l_x of the creep, see the module's docstring; the term in w vanishes with phi."""
    sin2 = np.sin(phi) ** 2
    return 2.0 * np.sin(delta / 2) * np.cos(phi - delta / 2) + np.where(sin2 > 0, sin2 * w, 0.0)


def _creep(
    t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Turn made, delta = pi/2 - theta, turn to come, theta - phi, and phi itself (rad)."""
    t, V, phi, l_x = _floats(t, V, phi, l_x)
    s = V * t / l_x
    s = np.where((s >= 0) & _applies(V, phi), s, np.nan)
    sin2, start = np.sin(phi) ** 2, np.cos(phi) / (1.0 + np.sin(phi))  # start = tan(pi/4 - phi/2)

    def turns(w: Floats) -> tuple[Floats, Floats]:
        decay = np.exp(-w)
        made = np.arctan(-start * np.expm1(-w) / (1.0 + start**2 * decay))
        return 2.0 * made, 2.0 * np.arctan(start * decay)

    # Lower bounds: ds/dw <= 1, and delta <= pi/2 - phi. Without misalignment s = tanh(w).
    w = np.fmax(s, (s - np.cos(2.0 * phi) - np.sin(phi)) / sin2)
    w = np.where(sin2 > 0, w, np.arctanh(np.minimum(s, 1.0)))
    for _ in range(100):  # 37 are the most it takes, for phi -> 0 at s = 1
        delta, rest = turns(w)
        step = (s - _scaled_time(delta, w, phi)) / np.sin(phi + rest) ** 2
        climbed = w + np.where((step > 0) & (sin2 > 0), step, 0.0)
        if np.array_equal(climbed, w, equal_nan=True):
            break
        w = climbed
    return *turns(w), phi


def _creep_expansion(
    t: ArrayLike, V: ArrayLike, phi: ArrayLike, l_x: ArrayLike, power: int
) -> Floats:
    t, V, phi, l_x = _floats(t, V, phi, l_x)
    s = V * t / l_x
    s = np.where((s >= 0) & (s < 1) & _applies(V, phi), s, np.nan)
    return V * phi * (phi + s**power / np.sqrt((1.0 - s) * (1.0 + s)))
