"""Steady sliding, its state and friction, and the growth of small disturbances of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import hypot, nan, pi
from pathlib import Path
from typing import Any

import numpy as np

from stiction.arguments import whole
from stiction.arrays import Complex, Floats
from stiction.drive import drive_stretches, load_stretches
from stiction.errors import DescriptionError, Fault, StictionError, echo
from stiction.friction import has_state, states
from stiction.linear_stability.derivatives import (
    Response,
    by_gradient,
    response_of,
    set_valued,
    with_state,
)
from stiction.linear_stability.eigenvalues import (
    Eigenvalues,
    eigenvalues,
    largest_growth,
    leading_eigenvalue,
)
from stiction.names import warn_renamed
from stiction.system.description import Description
from stiction.system.initial import Initial
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider, slider_of
from stiction.system.tensors import damping_tensor, mobility_tensor
from stiction.text.validation import equal

STABLE, UNSTABLE = "stable", "unstable"
BOUNDARY = "on the boundary of stability within its uncertainty"
SETTLED = 1e-9  # largest relative error of friction from unsteady internal states
NOT_SMOOTH = "friction: has no derivatives at {:g} m/s; see what check_law says of it"
STEADY = "this needs a steady drive and load; remove"


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Steady sliding at the drive's velocity, and the linear equations of a small disturbance.

    In steady sliding the slip velocity is that of the drive, s = v_d, the spring holds friction,
    K u = F(v_d), and internal states do not change. A disturbance obeys, to first order,

        M u'' + (C + dF/ds) u' + K u = (dF/dz) z,   z' = (dG/dz) z - (dG/ds) u',

    where z' = G(s, z) is the rate of the law's internal states, if it has any. The solutions are
    sums of exp(lambda t); each eigenvalue lambda belongs to a mode.

    Attributes
    ----------
    slider : Slider
        The system.
    names : tuple of str
        Names of the n unknowns: ``u_x, u_y`` (m), ``v_x, v_y`` (m/s), then internal states.
    state : ndarray
        (n,): their values in steady sliding.
    matrix : ndarray
        (n, n): the rate of change of a disturbance is `matrix` times it.
    error : ndarray
        (n, n): the estimated error of each entry of `matrix`: rounding, and for laws with
        internal state the error of numerical differentiation.

    Examples
    --------
    >>> import stiction as st
    >>> found = st.linear_stability.steady_sliding(st.presets.nakano_popov_2020())
    >>> found.verdict, found.stable
    ('unstable', False)
    """

    slider: Slider
    names: tuple[str, ...]
    state: Floats
    matrix: Floats
    error: Floats

    def __eq__(self, other: object) -> bool:
        """Compare slider and matrix."""
        return isinstance(other, Linearisation) and (
            self.slider == other.slider and equal(self.matrix, other.matrix)
        )

    def __hash__(self) -> int:
        """Agree with equality."""
        return hash(self.names)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        f, zeta = self.frequencies[0], self.damping_ratios[0]
        rate = f"{self.growth_rate:.4g} /s at {f:.4g} Hz"
        return f"<Steady sliding, {self.verdict}: fastest growth {rate}, damping ratio {zeta:.3g}>"

    @cached_property
    def _modes(self) -> Eigenvalues:
        return eigenvalues(self.matrix, self.error)

    @property
    def eigenvalues(self) -> Complex:
        """Eigenvalues lambda, 1/s, (n,), the fastest growing first."""
        return self._modes.values

    @property
    def uncertainty(self) -> Floats:
        """An error bound of each eigenvalue (1/s), from the error of the matrix, (n,)."""
        return self._modes.uncertainty

    @property
    def growth_uncertainty(self) -> float:
        """An error bound of `growth_rate`, 1/s."""
        return largest_growth(self.growth_rates, self._modes.growth_uncertainty)[1]

    @property
    def shapes(self) -> Complex:
        """Mode shapes, (n, n); column k belongs to eigenvalue k, rows as in `names`."""
        return self._modes.vectors

    @property
    def growth_rates(self) -> Floats:
        """Growth rates, 1/s, (n,); negative where a mode decays."""
        return self.eigenvalues.real

    @property
    def frequencies(self) -> Floats:
        """Frequencies, Hz, (n,); equal for a conjugate pair, zero without oscillation."""
        return np.abs(self.eigenvalues.imag) / (2.0 * pi)

    @property
    def damping_ratios(self) -> Floats:
        """Damping ratios -Re(lambda)/|lambda|, (n,); negative where a mode grows."""
        with np.errstate(invalid="ignore"):  # NaN for a state that never changes
            return -self.growth_rates / np.abs(self.eigenvalues)

    @property
    def growth_rate(self) -> float:
        """The largest growth rate, 1/s; negative if steady sliding is stable."""
        return float(self.growth_rates[0])

    @property
    def stable(self) -> bool:
        """Whether every small disturbance decays, by more than `growth_uncertainty`."""
        return self.verdict == STABLE

    @property
    def verdict(self) -> str:
        """The stability in words, "stable", "unstable" or "on the boundary ..."."""
        if abs(self.growth_rate) <= self.growth_uncertainty:
            return BOUNDARY
        return STABLE if self.growth_rate < 0.0 else UNSTABLE

    def disturbed_start(self, size: float = 1e-3, mode: int = 0) -> Initial:
        """Return steady sliding with a small disturbance, as the start of a run.

        Parameters
        ----------
        size : float, optional
            Amplitude of the elongation rate, relative to the drive's speed; or of a logarithm of
            internal state, if that is larger: ageing slowly, it hardly moves the mass.
        mode : int, optional
            The disturbed mode; by default the fastest growing, -1 for the fastest decaying.
        """
        try:
            shape = self.shapes[:, whole(mode)]
        except ValueError as error:
            raise DescriptionError.of("mode", str(error)) from None
        except IndexError:
            message = f"must be below {self.shapes.shape[1]}, the number of modes, is {echo(mode)}"
            raise DescriptionError.of("mode", message) from None
        speed = self.slider.drive_speed
        rates = np.abs(shape[2:4])
        shape = shape / np.exp(1j * np.angle(shape[2 + int(np.argmax(rates))]))
        aged = np.abs(shape[4:]) / np.maximum(np.abs(self.state[4:]), 1.0)
        largest = max([hypot(*rates) / speed, *aged.tolist()])
        at = self.state + size / largest * shape.real
        values: dict[str, Any] = dict(zip(self.names, map(float, at), strict=True))
        internal = {each.name: values.pop(each.name) for each in states(self.slider.law)}
        return Initial(**values, states=internal) if internal else Initial(**values)

    def disturbed(self, size: float = 1e-3, mode: int = 0) -> Initial:
        """Deprecated: `disturbed_start`."""
        warn_renamed("disturbed", "disturbed_start")
        return self.disturbed_start(size, mode)


def steady_sliding(slider: Slider | Description | str | Path) -> Linearisation:
    """Linearise a slider about steady sliding, s = v_d.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description: with a moving, steady drive,
        a constant load, and any friction law.

    Returns
    -------
    Linearisation
        Steady state, matrix, eigenvalues and modes.

    Raises
    ------
    DescriptionError
        If drive or load is not steady.
    StictionError
        If the law reaches no steady sliding, or is not smooth there.

    References
    ----------
    Rice & Ruina, J. Appl. Mech. 50 (1983), 343, for laws with internal state in one dimension.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> st.linear_stability.steady_sliding(slider.replace(phi="10 deg"))
    <Steady sliding, stable: fastest growth -31.46 /s at 9.015 Hz, damping ratio 0.485>
    """
    slider = slider_of(slider)
    slip = drive_velocity(slider)
    state, response = steady_friction(slider, slip)
    if not np.isfinite(response.error).all():
        raise StictionError(NOT_SMOOTH.format(hypot(*slip)))
    K = np.array([slider.k_x, slider.k_y])
    names = ("u_x", "u_y", "v_x", "v_y", *(each.name for each in states(slider.law)))
    at = np.concatenate([response.value[:2] / K, [0.0, 0.0], state])
    error = errors_of(slider, response.error)
    return Linearisation(slider, names, at, system(slider, response.slopes), error)


def growth_rate(slider: Slider | Description | str | Path) -> float:
    """Return the largest growth rate (1/s) of a small disturbance of steady sliding.

    Negative where steady sliding is stable; see `steady_sliding`.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> turned = slider.replace(phi="10 deg")
    >>> [st.linear_stability.growth_rate(each) > 0 for each in (slider, turned)]
    [True, False]
    """
    return leading_mode(slider_of(slider)).real


def growth_at(slider: Slider, path: str, value: float) -> float:
    """Return the growth rate (1/s) with a parameter at a value (SI), for maps of many values.

    NaN where there is no steady sliding. For the rest see `change_unchecked`.
    """
    try:
        return growth_rate(change_unchecked(slider, path, value))
    except (StictionError, ArithmeticError, ValueError):
        return nan


def leading_mode(slider: Slider) -> complex:
    """Return the eigenvalue (1/s) of the fastest-growing mode."""
    return leading_eigenvalue(quick_matrix(slider)[0])


def disturbance(slider: Slider) -> tuple[Floats, Floats]:
    """Return matrix and errors as `Linearisation` has them, at less cost; costly errors are NaN."""
    matrix, response = quick_matrix(slider)
    return matrix, errors_of(slider, response.error)


def quick_matrix(slider: Slider) -> tuple[Floats, Response]:
    """Return the matrix of `disturbance`, and the response of friction that it is built from."""
    slip = drive_velocity(slider)
    response = quick_response(slider, slip)
    matrix = system(slider, response.slopes)
    if not np.isfinite(matrix).all() or np.isinf(response.error).any():
        raise StictionError(NOT_SMOOTH.format(hypot(*slip)))
    return matrix, response


def system(slider: Slider, slopes: Floats) -> Floats:
    """Return the system matrix of a disturbance u, u', z, given the slopes of friction."""
    n = len(slopes) - 2
    (p, r), (_, q) = mobility_tensor(slider).tolist()
    matrix = np.zeros((4 + n, 4 + n))
    matrix[0, 2] = matrix[1, 3] = 1.0
    matrix[2:, 2:] = slopes
    matrix[2:, 2:4] *= -1.0  # s = v_d - u'
    matrix[2:4, 2:4] -= damping_tensor(slider)
    matrix[2:4, 2:] = [[p, r], [r, q]] @ matrix[2:4, 2:]
    matrix[2:4, 0] = -p * slider.k_x, -r * slider.k_x
    matrix[2:4, 1] = -r * slider.k_y, -q * slider.k_y
    return matrix


def errors_of(slider: Slider, error: Floats) -> Floats:
    """Return the error of each entry of the system matrix, given the errors of the slopes."""
    found = np.zeros((2 + len(error), 2 + len(error)))
    found[2:, 2:] = error
    found[2:4] = np.abs(mobility_tensor(slider)) @ found[2:4]
    return found


def drive_velocity(slider: Slider) -> Floats:
    """Return the slip velocity of steady sliding (x, y; m/s)."""
    found = []
    drives, loads = drive_stretches(slider.motion), load_stretches(slider.normal_load, slider.load)
    X, Y = slider.motion.rate(0.0)
    if len(drives) > 1 or not drives[0][1].steady():
        found.append(Fault("drive", f"is not steady; {STEADY} {_varying(slider.drive)}"))
    elif X == Y == 0.0:
        found.append(Fault("drive.velocity", "is zero: nothing slides; give it a velocity"))
    if len(loads) > 1 or not loads[0][1].constant():
        found.append(Fault("load", f"is not constant; {STEADY} {_varying(slider.load)}"))
    if found:
        raise DescriptionError(found)
    return np.array(slider.along_axes(X, Y))


def _varying(part: object) -> str:
    """Return the keys that make a drive or load vary."""
    names = ("program", "along", "across", "modulation")
    return " and ".join(name for name in names if getattr(part, name, None))


def steady_friction(slider: Slider, slip: Floats) -> tuple[Floats, Response]:
    """Return the steady internal states, none for a set-valued law, and the response."""
    if not has_state(slider.law):
        return np.zeros(0), response_of(slider, slip)
    state = settled_state(slider, slip)
    response = with_state(slider, slip, state)
    refuse_unsettled(response.value, response.slopes, slip)
    return state, response


def quick_response(slider: Slider, slip: Floats) -> Response:
    """Return the response as `steady_friction` does, at less cost; costly errors are NaN."""
    if not has_state(slider.law):
        value, slopes = set_valued(slider, slip)
        return Response(value, slopes, np.full((2, 2), np.nan))
    respond = by_gradient if hasattr(slider.law, "gradient") else with_state
    response = respond(slider, slip, settled_state(slider, slip))
    if np.isfinite(response.error).all():
        refuse_unsettled(response.value, response.slopes, slip)
    return response


def settled_state(slider: Slider, slip: Floats) -> Floats:
    """Return the internal states in equilibrium at a slip velocity."""
    from scipy.optimize import root

    law: Any = slider.law

    def change(state: Floats) -> Floats:
        where = (float(slip[0]), float(slip[1])), slider.normal_load, tuple(map(float, state))
        return np.array(law.change(*where), dtype=np.float64)

    start = law.settled(hypot(*slip))
    found: Floats = root(change, start, tol=1e-13).x  # type: ignore[no-untyped-call]
    return found


def refuse_unsettled(value: Floats, slopes: Floats, slip: Floats) -> None:
    """Refuse internal states if a further Newton step would change friction.

    The root finder's own verdict is not trusted.
    """
    try:
        left = slopes[:2, 2:] @ np.linalg.solve(slopes[2:, 2:], value[2:])
    except np.linalg.LinAlgError:
        left = np.full(2, np.inf)
    if not hypot(*left) <= SETTLED * hypot(*value[:2]):
        message = f"its states come to no steady sliding at {hypot(*slip):g} m/s"
        raise StictionError(f"friction: {message}; see what check_law says of it")
