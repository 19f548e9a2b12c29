"""The divergence of a creep curve towards slip, by least squares."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.creep.least_squares import UNLIKE, best_fit, used_bins
from stiction.arrays import TINY, Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity.wording import with_error

EDGE = 0.01  # an exponent so near to the end of its range is none
LAG = 1e-3  # of the loading time: a typical delay of the divergence after the slip
# Accuracy of the exponent: a mass slips because friction weakens, and that begins while it creeps;
# Eq. (8) has constant friction. In noise-free runs of random rigs n scatters by 0.06 to 0.2
WEAKENED = 0.1


class Divergence(NamedTuple):
    """Exponent n of the creep's divergence, and its standard error.

    Parameters
    ----------
    exponent, exponent_error : float
        n; 1/2 by Eq. (8).
    amplitude, amplitude_error : float
        a, m/s; V phi by Eq. (8).
    lag, lag_error : float
        Delay of the divergence after the slip, s.
    loading_time : float
        l_x/V, s, as given.
    """

    exponent: float
    exponent_error: float
    amplitude: float
    amplitude_error: float
    lag: float
    lag_error: float
    loading_time: float

    def __repr__(self) -> str:
        """Return the exponent with its error."""
        return f"<Divergence: exponent {with_error(self.exponent, self.exponent_error, '1')}>"

    def velocity(self, to_slip: Floats) -> Floats:
        """Return the fitted velocity (m/s) at times before slip (s); NaN after the divergence."""
        tau = 1.0 - (np.asarray(to_slip) + self.lag) / self.loading_time
        tau = np.where(np.abs(tau) < 1.0, tau, np.nan)
        found: Floats = self.amplitude * tau * ((1.0 - tau) * (1.0 + tau)) ** -self.exponent
        return found


def fit_divergence(
    curve: xr.Dataset,
    loading_time: float,
    stretch: tuple[float, float] = (0.05, 0.3),
    lag: float | None = None,
) -> Divergence:
    """Fit the divergence of the creep velocity towards slip.

    The model is the singular term of Eq. (8), corrected, with the exponent left free,

        X' = a tau (1 - tau^2)^(-n),   tau = 1 - (t_s - t)/(l_x/V),

    averaged analytically over each bin. Least squares yield a, n and the time t_s of the
    divergence, which comes a little after the slip. Its limit, a bare power of t_s - t, lacks the
    factors tau and 1 + tau; over a stretch wide enough for a fit it would give 0.56 instead of 1/2.

    At a finite misalignment Eq. (7) has no divergence: its velocity grows to V, and the friction
    force turns no further than phi. Because theta^2 is about 2 (1 - tau), the stretch should stay
    above phi^2, in rad.

    Parameters
    ----------
    curve : Dataset
        Over ``bin``, from `mean_creep`, or one phase of `creep_curves`.
    loading_time : float
        l_x/V, s: the spring's elongation that carries the whole friction over the drive velocity.
    stretch : tuple of float
        Range of the time to slip of the bins used, as shares of `loading_time`.
    lag : float, optional
        Delay of the divergence after the slip, s; fitted by default.

    Returns
    -------
    Divergence
        Its standard errors combine the curve's with a hundredth of the velocity for the theory, and
        that of n with 0.1 for friction that weakens, as it does where a mass slips.

    Raises
    ------
    ResultError
        If fewer than five bins lie in the stretch.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, Eq. (8); see `stiction.theory`.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 s", sample_rate="2 kHz")
    >>> mean = st.analysis.mean_creep(st.analysis.creep_curves(run, st.analysis.find_cycles(run)))
    >>> found = st.analysis.fit_divergence(mean, loading_time=2.0)
    >>> round(found.exponent, 2)
    0.5
    """
    low, high = stretch[0] * loading_time, stretch[1] * loading_time
    velocity, error, _, begin, end = used_bins(curve, low, high)

    def mean(amplitude: float, exponent: float, lag: float) -> Floats:
        early, late = (1.0 - (T + lag) / loading_time for T in (begin, end))
        rest = 1.0 - exponent or 1e-12  # at n = 1 the integral is a logarithm, its limit
        powers = [np.maximum((1.0 - tau) * (1.0 + tau), 1e-12) ** rest for tau in (early, late)]
        area = 0.5 * (powers[0] - powers[1]) / rest
        return np.asarray(amplitude * area * loading_time / (begin - end))

    tau = 1.0 - 0.5 * (begin + end) / loading_time
    scale = float(np.median(velocity * np.sqrt((1.0 - tau) * (1.0 + tau)) / tau))
    start, low_n, high_n = (scale, 0.49), (-np.inf, -3.0), (np.inf, 5.0)
    sizes = max(float(np.abs(velocity).max()), TINY), 0.5
    if lag is None:
        bounds = ((*low_n, -0.9 * float(end.min())), (*high_n, loading_time))
        more = *sizes, LAG * loading_time
        fit = best_fit(mean, velocity, error, [(*start, 0.0)], bounds, more)
        found, errors = fit.values, fit.errors
    else:

        def with_lag(amplitude: float, exponent: float) -> Floats:
            return mean(amplitude, exponent, lag)

        fit = best_fit(with_lag, velocity, error, [start], (low_n, high_n), sizes)
        found, errors = (*fit.values, lag), (*fit.errors, 0.0)
    (a, n, late), (a_error, n_error, late_error) = found, errors
    if not low_n[1] + EDGE < n < high_n[1] - EDGE:
        raise ResultError(UNLIKE)
    n_error = float(np.hypot(n_error, WEAKENED))
    return Divergence(n, n_error, a, a_error, late, late_error, loading_time)
