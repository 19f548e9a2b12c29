"""The misalignment from a measured force alone, by the shape of its rises."""

from __future__ import annotations

from math import degrees, exp, log, pi
from typing import Any, NamedTuple

import numpy as np

from stiction.analysis.creep.conditions import CHANGED, load_change, refuse_change, typical_load
from stiction.analysis.creep.loading_curve import LEVELS, LoadingCurve, loading_curve
from stiction.analysis.creep.misalignment import Misalignment
from stiction.analysis.motion.cycles import find_cycles
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import error_of_few
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity.wording import percent, times
from stiction.text.units import Radians

GRID = 400  # angles at which the closed form is tabled
MODEL = 1e-4  # of the drop: least error of Eq. (7) with the terms below
SHARED = 4.0  # weight of a misfit that all cycles share: it is as smooth as the curve
WORST = 1e-3  # of the drop: with a larger misfit, the rises do not have the shape
# Unknowns of a record, assumed value and width of each: relative error of the stated stiffness,
# logarithms of k_x/k_y and of the weakening of friction at the drive velocity.
TAILS = (0.0, log(1e-3), log(1e-2))
WIDTHS = (0.02, 1.5, 1.3)
ACROSS = 0.1  # relative error of a k_x/k_y that is stated
# Relative accuracy of phi at the best: the transverse oscillation lowers friction, too. Of 600 rigs
# of `python -m benchmarks.explore.misalignment` the intervals hold 95 %, with 0.1 they held 94 %
AT_BEST = 0.15
# Accuracy of F_0 by this theory, of its excess over the peak and of the peak itself: where the fit
# has next to no excess, the peak is 1 % or 2 % off
EXCESS, PEAK = 0.5, 0.01
# Relative standard error above which an angle is not determined: more than that of one by creep
# itself (`findings`), whose theory is better
KNOWN = 2.0 * AT_BEST
EARLY = 0.5  # F_0 above the peak by this share
SOFTER = 9.0  # sum of squares, in standard errors, by which a softening spring must fit worse
SOFTENING = 1e-3, 0.99  # b of such a spring, times the largest force of a rise
SURELY = 20.0  # deg: a smaller upper limit is worth a word
LOWEST = (1e-5, log(1e-5), -0.1, log(1e-6), log(1e-5))
HIGHEST = (0.3, 0.0, 0.1, log(0.1), 0.0)
MOST_EVALUATIONS, FIXED = 50, 1e-3  # evaluations in a fit; the width that holds a parameter
SCALES = (0.01, 1.0, 0.01, 1.0, 1.0)
STARTS = ((0.03, log(0.02)), (0.08, log(0.1)))  # phi, and the logarithm of F_0/peak - 1


def misalignment_from_force(record: Record, cycles: xr.Dataset | None = None) -> Misalignment:
    """Fit the misalignment to the bend of a force's rises, which turning friction causes.

    By Eq. (7) the force rises at k_x V_x (1 - tan(phi) cot(theta)), F = F_0 cos(theta): more slowly
    as it approaches F_0. The duration of the rises (the mean over cycles at equal forces) is fitted
    with phi, F_0 and the stiffness, assumed to be stated within 2 %; also with k_x/k_y, which slows
    the turning, within 10 % where the record states both stiffnesses, and with the weakening of
    friction with creep speed; of what is not stated only the order of magnitude is assumed. The
    standard error includes the scatter of the cycles, these assumptions, the resolution of the
    force, and the misfit. F_0 is that at `normal_load`, where the record has a load that varies.

    Parameters
    ----------
    record : Record
        A record of stick-slip, with stiffness and drive velocity.
    cycles : Dataset, optional
        From `stiction.analysis.find_cycles`, which is called by default.

    Returns
    -------
    Misalignment
        Its magnitude: a force alone does not reveal the sign.

    Raises
    ------
    ResultError
        If the record does not determine it to about 30 % (one standard error), with the reason.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, Eqs. (6) and (7).

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> run = st.simulate(slider, "5 s", sample_rate="2 kHz")
    >>> time, force = (run.data[name].values for name in ("time", "spring_x"))
    >>> record = st.Record(time=time, force=force, stiffness="1 kN/m", drive_velocity="1 mm/s")
    >>> low, high = st.analysis.misalignment_from_force(record).interval
    >>> low < slider.phi < high
    True
    """
    table = find_cycles(record) if cycles is None else cycles
    if not table.sizes["cycle"]:
        raise ResultError("there is no stick-slip cycle in which friction could turn")
    change = load_change(record, table["start"].values, table["peak_time"].values)
    refuse_change(change, CHANGED, "and Eq. (7) supposes a constant one")
    curve = loading_curve(record, table)
    best, covariance, gain, misfit, apart = _fit(curve, _tails(record))
    phi, excess, off = float(best[0]), exp(best[1]), float(best[2])
    error = max(float(covariance[0, 0]) ** 0.5, apart, _over_cycles(curve, gain))
    error = float(np.hypot(error, AT_BEST * phi))
    _refuse(phi, error, excess, misfit, off)
    _refuse_softening(curve, misfit)
    peak = curve.peak / typical_load(record, table["peak_time"].values)
    F_0 = peak * (1.0 + excess)
    over = excess * float(np.hypot(covariance[1, 1] ** 0.5, EXCESS))
    F_0_error = peak * float(np.hypot(over, PEAK + 0.5 * change))
    stiffness = (record.stiffness or 0.0) / (1.0 + off)
    return Misalignment(Radians(phi), error, F_0, F_0_error, stiffness)


def crept_force(
    force: Floats, phi: float, F_0: float, ratio: float = 0.0, weakening: float = 0.0
) -> Floats:
    """Return k_x times the distance crept (N) up to each force, up to a constant, by Eq. (7).

    Forces (n,), N, increase and are below `F_0`, the friction at zero slip. By `ratio`, k_x/k_y,
    u_y = F sin(theta)/k_y turns the slip back; by `weakening`, -V F'(0)/F_0, friction is F_0/(1 +
    weakening |s|/V) with |s| = V sin(phi)/sin(theta).
    """
    nearest, farthest = (float(np.arccos(min(each / F_0, 1.0))) for each in (force[-1], force[0]))
    theta = np.linspace(max(0.6 * nearest, 1.0001 * phi), min(1.05 * farthest, 0.999 * pi), GRID)
    cotangent = 1.0 / np.tan(theta)
    rate = (1.0 - np.tan(phi) * cotangent) / (1.0 + ratio * cotangent**2)
    lag = 1.0 / np.maximum(rate, 1e-3) - 1.0
    fall = -np.cos(theta) / (1.0 + weakening * np.sin(phi) / np.sin(theta))
    done = np.concatenate([[0.0], np.cumsum(-0.5 * np.diff(fall) * (lag[1:] + lag[:-1]))])
    found: Floats = F_0 * np.interp(-force / F_0, np.maximum.accumulate(fall), done)
    return found


class _Fit(NamedTuple):
    """Parameters, covariance, sensitivity of phi to each level (rad/N), misfit over the drop.

    `apart` is the change of phi (rad) if k_x/k_y is off by a standard deviation.
    """

    best: Floats
    covariance: Floats
    gain: Floats
    misfit: float
    apart: float


def _tails(record: Record) -> Floats:
    """Return assumed values and widths (2, 3) of the unknowns of a record."""
    tails = np.array([TAILS, WIDTHS])
    if record.stiffness and record.stiffness_across:
        tails[:, 1] = log(record.stiffness / record.stiffness_across), ACROSS
    return tails


def _fit(curve: LoadingCurve, tails: Floats) -> _Fit:
    """Fit phi, ln(F_0/peak - 1), the stiffness' error, ln(k_x/k_y) and ln(weakening)."""
    from scipy.optimize import least_squares

    seen = curve.crept - curve.crept.mean()
    error = np.hypot(curve.error, MODEL * curve.drop)
    middle, width = tails

    def deviation(p: Floats) -> Floats:
        x = crept_force(curve.force, p[0], curve.peak * (1.0 + exp(p[1])), exp(p[3]), exp(p[4]))
        modelled = (x + curve.force) * (1.0 + p[2]) - curve.force  # by a stiffness off by so much
        return np.asarray(seen - (modelled - modelled.mean()))

    def weighted_misfit(p: Floats) -> Floats:
        assumed = (p[2:] - middle) / width
        return np.concatenate([deviation(p) / error, assumed])

    minimised: Any = least_squares

    def best_from(start: Floats) -> Any:
        inside = np.clip(start, np.add(LOWEST, 1e-9), np.subtract(HIGHEST, 1e-9))
        return minimised(
            weighted_misfit,
            inside,
            bounds=(LOWEST, HIGHEST),
            x_scale=SCALES,
            max_nfev=MOST_EVALUATIONS,
            xtol=1e-6,
        )

    best = min(
        (best_from(np.array([*at, *tails[0]])) for at in STARTS), key=lambda found: found.cost
    )
    excess = float(np.mean(deviation(best.x) ** 2) - np.mean(curve.error**2))
    misfit = max(excess, 0.0) ** 0.5 / curve.drop
    error = np.hypot(curve.error, max(MODEL, SHARED * misfit) * curve.drop)
    best = best_from(best.x)
    covariance = np.linalg.pinv(best.jac.T @ best.jac)
    gain = (covariance[0] @ best.jac.T)[: len(error)] / error
    other = []
    width[1] = FIXED
    for side in (-1.0, 1.0):  # it is not linear in the logarithm of k_x/k_y
        middle[1] = best.x[3] + side * float(covariance[3, 3]) ** 0.5
        other.append(float(best_from(np.array([*best.x[:3], middle[1], best.x[4]])).x[0]))
    return _Fit(
        best.x, covariance, gain, misfit, float(np.mean(np.subtract(other, best.x[0]) ** 2) ** 0.5)
    )


def _refuse_softening(curve: LoadingCurve, misfit: float) -> None:
    """Refuse an angle if a spring that softens bends the rises as well as friction that turns.

    Such a spring carries F = k u (1 - u/u_1), whose stiffness is k (1 - b F)^1/2, b = 4/(k u_1). A
    drive of constant velocity loads it in a time that is linear in that root, over all of its rise.
    Friction that turns bends the rise late.
    """
    from scipy.optimize import minimize_scalar

    time = curve.crept + curve.force  # times the rate of loading
    share = curve.force / curve.force[-1]

    def misses(softening: float) -> float:
        stiffness = np.sqrt(1.0 - softening * share)
        line = np.polyfit(stiffness, time, 1)
        return float(np.mean((time - np.polyval(line, stiffness)) ** 2))

    minimised: Any = minimize_scalar
    best = minimised(misses, bounds=SOFTENING, method="bounded")
    left, stiffness = float(best.fun), np.sqrt(1.0 - best.x * share)
    excess = left - float(np.mean(curve.error**2)) - (misfit * curve.drop) ** 2
    if LEVELS * excess > SOFTER * np.hypot(float(curve.error.mean()), MODEL * curve.drop) ** 2:
        return
    raise ResultError(
        "not determined: a spring whose stiffness falls by "
        f"{percent(1.0 - float(stiffness[-1] / stiffness[0]))} in the rise of the force would bend "
        "that so without any misalignment"
    )


def _over_cycles(curve: LoadingCurve, gain: Floats) -> float:
    """Return the standard error of phi from the shift that each cycle causes."""
    count = len(curve.apart)
    if count < 2:
        return 0.0
    return error_of_few(float((curve.apart @ gain).std(ddof=1)) / count**0.5, count - 1)


def _refuse(phi: float, error: float, excess: float, misfit: float, off: float) -> None:
    """Raise an error with the reason, if the record does not determine the angle."""
    if abs(off) > 2.0 * WIDTHS[0]:
        raise ResultError(
            "not determined: Eq. (7) fits the rises only with "
            f"{times(1.0 / (1.0 + off), 3)} stiffness times drive velocity as stated, and an angle "
            f"needs that to within {percent(2.0 * WIDTHS[0])}: measure both more exactly"
        )
    if misfit > WORST:
        raise ResultError(
            "not determined: the rises do not have the shape that friction gives as it turns "
            f"(they miss it by {f'{percent(misfit)} of' if misfit < 1.0 else 'more than'} the drop)"
        )
    if excess > EARLY:
        raise ResultError(
            "not determined: the force falls so early in its rise that the friction, towards "
            "which it would bend, is not seen"
        )
    if not error < KNOWN * phi:
        most = degrees(phi + 2.0 * error)
        known = f"; it is below {most:.2g} deg" if most < SURELY else ""
        raise ResultError(
            "not determined: the bend of the rises does not stand out of noise and the "
            f"uncertainty of stiffness and friction{known}"
        )
