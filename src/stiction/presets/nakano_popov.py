"""The paper: K. Nakano and V. L. Popov, Phys. Rev. E 102, 063001 (2020)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.drive import ConstantVelocity
from stiction.friction.laws import Coulomb, ExponentialWeakening
from stiction.presets.preset import Published, preset
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

REFERENCE = "Nakano & Popov, Phys. Rev. E 102, 063001 (2020); arXiv:2008.01854"
DOI = "10.1103/PhysRevE.102.063001"


def nakano_popov_2020() -> Slider:
    """Return the slider of Fig. 3 of Nakano & Popov, arXiv:2008.01854 (parameters: its caption).

    It is the slider alone, for `stiction.simulate` and calls that vary it; all other presets are
    descriptions. The description is `nakano_popov_weakening`.

    Examples
    --------
    >>> import stiction as st
    >>> st.presets.nakano_popov_2020() == st.presets.nakano_popov_weakening().slider
    True
    """
    return Slider(
        mass="0.25 kg",
        k_x="1 kN/m",
        k_y="10 MN/m",
        phi="1 deg",
        normal_load="10 N",
        friction=ExponentialWeakening(mu_0=0.20, mu_inf=0.15, v_f="10 mm/s"),
        drive=ConstantVelocity("1 mm/s"),
    )


def _weakening(run: Trajectory) -> list[float]:
    d = run.data
    time, force = d["time"].values, d["spring_x"].values
    peak = int(force[time < 2.5].argmax())
    trough = peak + int(force[peak:][time[peak:] < time[peak] + 0.3].argmin())
    next_peak = trough + int(force[trough:][time[trough:] < time[trough] + 1.2].argmax())
    return [
        1e3 * float(run.stick_intervals[0, 1]),
        float(force[peak]),
        float(time[peak]),
        float(force[trough]),
        float(time[trough]),
        float(time[next_peak] - time[peak]),
        1e3 * float(d["V_X"].max()),
        len(run.stick_intervals),
        run.statistics.time_stuck,
        1e3 * float(run.final["u_x"]),
        1e3 * float(run.final["u_y"]),
    ]


@preset(
    _weakening,
    shows="creep while the friction vector turns, then rapid slip (Fig. 3)",
    reference=REFERENCE,
    doi=DOI,
    grade="solid",
    published=(
        Published("end of the first stick", 11.4595, 5e-5, "ms", "reference"),
        Published("first peak of k_x u_x", 1.9926, 5e-5, "N", "reference"),
        Published("  at", 2.0321, 1e-4, "s", "reference"),
        Published("first trough of k_x u_x", 1.1686, 5e-5, "N", "reference"),
        Published("  at", 2.0905, 1e-4, "s", "reference"),
        Published("period", 0.9151, 2e-4, "s", "reference"),
        Published("largest X'", 26.284, 5e-4, "mm/s", "reference"),
        Published("stick intervals in 5 s", 2959, 0, "1", "reference"),
        Published("time stuck in 5 s", 0.323110, 5e-7, "s", "reference"),
        Published("u_x(5 s)", 1.3305693378, 1e-10, "mm", "reference"),
        Published("u_y(5 s)", 1.474023e-4, 5e-11, "mm", "reference"),
    ),
)
def nakano_popov_weakening() -> Description:
    """The paper's Fig. 3: a mass that seems to stick, creeps, and slips.

    Friction weakens from 0.20 to 0.15 over 10 mm/s; the spring is misaligned by one degree. The
    force that friction can hold is reached after 11 ms; until the rapid slip at 2 s the mass
    creeps, while the friction vector turns at nearly constant magnitude. `stiction paper`
    compares every number that the paper states. The reference values here are those of the
    set-valued solution, to the digits on which two independent methods agree.
    """
    return Description(
        nakano_popov_2020(), Initial(), Settings(duration=5.0, sample_rate=10e3, rtol=1e-10)
    )


def _constant(run: Trajectory) -> list[float]:
    tail = run.data["spring_x"].sel(time=slice(9.0, 10.0)).values
    return [float(tail[-1]), float(np.ptp(tail)), 1e3 * float(run.data["V_X"].max())]


@preset(
    _constant,
    shows="the apparatus of Fig. 3 with constant friction: no stick-slip",
    reference=REFERENCE,
    doi=DOI,
    grade="solid",
    published=(
        Published("constant friction: k_x u_x goes to", 1.9997, 5e-5, "N", "reference"),
        Published("  its swing in the last second", 0.0, 1e-5, "N", "reference"),
        Published("  largest X'", 1.6124, 2e-3, "mm/s", "reference"),
    ),
)
def nakano_popov_constant() -> Description:
    """The apparatus of Fig. 3 with a friction coefficient of 0.20 at any slip speed.

    The friction vector turns as before, but nothing accelerates the slip once it has begun: the
    mass passes into steady sliding.
    """
    slider = nakano_popov_2020().replace(friction=Coulomb(mu_0=0.20))
    return Description(slider, Initial(), Settings(duration=10.0, sample_rate=10e3, rtol=1e-8))
