"""A bowed string as one mass on a spring: friction curves of rosin."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stiction.drive import ConstantVelocity
from stiction.friction.laws import HyperbolicWeakening, PowerLawWeakening, TwoExponentials
from stiction.presets.preset import Published, on_a_line, preset
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

SMITH = "Smith & Woodhouse, J. Mech. Phys. Solids 48, 1633 (2000)"
MATUSIAK = "Matusiak et al., Front. Signal Process. (2025)"
STRING = (
    "one mode: 2.784 g on 2954 N/m, a cello's G string under the bow; without travelling waves "
    "there is no Helmholtz motion",
    "friction is steady: measured loops lie off the curve, as rosin warms up",
)


def cello_string(law: Any) -> Description:
    """Return the point of a cello's G string under the bow: one mode, 0.3439 m/s, 2.3433 N."""
    slider = on_a_line(
        mass=2.784e-3, k_x=2954.0, normal_load=2.3433, friction=law, drive=ConstantVelocity(0.3439)
    )
    return Description(slider, Initial(), Settings(duration=0.1, sample_rate=50e3, rtol=1e-8))


def _coefficients(run: Trajectory) -> list[float]:
    return [float(run.slider.law.coefficient(v)) for v in (0.0, 0.01, 0.1)]


def _curve(*mu: float) -> tuple[Published, ...]:
    at = ("at rest", "at 10 mm/s", "at 100 mm/s")
    return tuple(
        Published(f"mu {where}", value, 5e-5, "1", "published formula")
        for where, value in zip(at, mu, strict=True)
    )


@preset(
    _coefficients,
    shows="rosin in steady sliding: weakening over two speeds",
    reference=SMITH,
    doi="",
    grade="half",
    published=_curve(1.2, 0.90433, 0.51556),
    assumed=STRING,
)
def rosin_two_exponentials() -> Description:
    """mu = 0.4 exp(-v/10 mm/s) + 0.45 exp(-v/100 mm/s) + 0.35, as measured in steady sliding."""
    return cello_string(TwoExponentials(0.35, 0.4, 0.01, 0.45, 0.1))


@preset(
    _coefficients,
    shows="rosin: the revised power law",
    reference="Woodhouse & Galluzzo, Tribology Letters 73, 128 (2025)",
    doi="10.1007/s11249-025-02062-4",
    grade="half",
    published=_curve(1.2147, 0.9379, 0.4818),
    assumed=STRING,
)
def rosin_power_law() -> Description:
    """mu = 0.2 (v + 0.011)^(-0.4), v in m/s: a fit that goes on falling."""
    return cello_string(PowerLawWeakening(0.2 * 0.011**-0.4, 0.011, 0.4))


@preset(
    _coefficients,
    shows="rosin: the hyperbola of models of bowed strings",
    reference=MATUSIAK,
    doi="10.3389/frsip.2025.1525044",
    grade="half",
    published=_curve(0.8, 0.78095, 0.66667),
    assumed=STRING,
)
def rosin_hyperbolic() -> Description:
    """mu = 0.4 + 0.08/(v + 0.2), v in m/s: less weakening, over a higher speed."""
    return cello_string(HyperbolicWeakening(0.8, 0.2, mu_inf=0.4))
