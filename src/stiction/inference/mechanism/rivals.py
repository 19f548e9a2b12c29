"""Mechanisms that make a record of stick and slip on the same apparatus.

- rotation of the friction vector: the rig as it is described, misaligned;
- static friction in one dimension: the same apparatus, exactly aligned, with the law of the
  description, or with constant friction and a separate static coefficient;
- rate and state: friction that depends on the age of contacts, by the ageing law or the slip law,
  aligned or not;
- LuGre: bristles that bend and slip, aligned.

And one beside which a claim of rate and state or of LuGre has to hold: static friction on the rig
as it is misaligned, above constant friction or above the law of the description. Where it does not
show, it passes for rotation; it is claimed in place of that where the mass is held between slips by
both (`rest`).

Every mechanism has the apparatus of the description and its priors. Coefficients of another law
have the range of those that the description's law has at rest and in rapid slip; its other
parameters follow from the scales of the rig, over one or two decades (docs/how-to/mechanism.md).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import BOUNDS_95
from stiction.friction.laws import Anisotropic, Coulomb, LuGre, RateStateAgeing, RateStateSlip
from stiction.friction.laws.rate_and_state.common import least_direct_effect
from stiction.inference.fit import plan_for
from stiction.inference.observation import Conditions
from stiction.inference.priors import Prior, Uniform, middle
from stiction.inference.rig import Rig
from stiction.inference.simulated.plan import Plan, plan
from stiction.inference.simulated.restriction import is_allowed, is_restricted
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider

ROTATION = "rotation of the friction vector"
STATIC = "static friction in one dimension"
RATE_AND_STATE = "rate and state"
LUGRE = "LuGre"
MISALIGNED_STATIC = "static friction on the misaligned rig"
CLAIMED = ROTATION, STATIC, RATE_AND_STATE, LUGRE

DRAWN = 400  # of the description's law, for the range of its coefficients
WIDER = 0.1  # by which the range is widened on either side: another law, other coefficients
PEAK = 1.5  # largest static coefficient over the largest of the description's law at rest
DIRECT = 0.01, 0.15  # direct effect a over the fall of the coefficient
EVOLVING = 0.05, 0.5  # evolution effect b over it
DISTANCE = 1e-3, 0.1  # D_c over the distance that the spring is let go by this fall
STRIBECK = 0.3  # largest Stribeck speed over the rig's largest slip speed
BRISTLES = 20.0, 500.0  # stiffness of the bristles over that of the spring
DAMPING = 1.0, 20.0  # their damping constant over the root of the spring's stiffness times mass


class Mechanism(NamedTuple):
    """A mechanism by name, and the plans of its simulations."""

    name: str
    plans: tuple[Plan, ...]


class Levels(NamedTuple):
    """Ranges (low, high) of the friction coefficient at rest and in rapid slip."""

    static: tuple[float, float]
    kinetic: tuple[float, float]

    @property
    def fall(self) -> float:
        """The difference of their middles."""
        return 0.5 * (sum(self.static) - sum(self.kinetic))


def mechanisms(rig: Rig, conditions: Sequence[Conditions]) -> tuple[Mechanism, ...]:
    """Return the mechanisms that are compared for records under these conditions.

    The last one, `MISALIGNED_STATIC`, is what claims are checked against.
    """
    slider, level = rig.slider, levels(rig)
    rotation = plan_for(rig, conditions)  # that of a fit, whose simulations are shared
    own, turned = split(rotation.priors)
    aligned = {path: prior for path, prior in turned.items() if path != "phi"}
    straight = change_unchecked(slider, "phi", 0.0)
    unturned = [each._replace(yaw=0.0) for each in conditions]

    def with_law(base: Slider, law: Any, priors: dict[str, Prior]) -> Plan:
        friction = dict(priors_of(law, slider, level))
        rival = base.model_copy(update={"friction": middle_of(law, slider, friction)})
        places = unturned if base is straight else conditions
        return plan(rival, {**priors, **friction}, places)._replace(basis=slider)

    return (
        Mechanism(ROTATION, (rotation,)),
        Mechanism(
            STATIC,
            (
                plan(straight, {**aligned, **own}, unturned)._replace(basis=slider),
                with_law(straight, Coulomb, aligned),
            ),
        ),
        Mechanism(
            RATE_AND_STATE,
            tuple(
                with_law(base, law, priors)
                for law in (RateStateAgeing, RateStateSlip)
                for base, priors in ((straight, aligned), (slider, turned))
            ),
        ),
        Mechanism(LUGRE, (with_law(straight, LuGre, aligned),)),
        Mechanism(
            MISALIGNED_STATIC,
            (with_law(slider, Coulomb, turned), *with_peak(rig, level, conditions)),
        ),
    )


def with_peak(rig: Rig, level: Levels, conditions: Sequence[Conditions]) -> Iterator[Plan]:
    """Yield the plan of the rig's own law below a static coefficient.

    None if that law has such a coefficient already or cannot have one, or is constant without it.
    """
    slider, path = rig.slider, "friction.mu_static"  # of the law within an anisotropic one, too
    law: Any = slider.friction
    inner = law.law if isinstance(law, Anisotropic) else law
    has_none = "mu_static" in getattr(inner, "_fields", ()) and inner.mu_static == 0.0
    if isinstance(inner, Coulomb) or path in rig.priors or not has_none:
        return
    peak = Uniform(level.static[0], PEAK * level.static[1])
    held = change_unchecked(slider, path, peak.high)
    yield plan(held, {**rig.priors, path: peak}, conditions)._replace(basis=slider)


def split(priors: Mapping[str, Prior]) -> tuple[dict[str, Prior], dict[str, Prior]]:
    """Return the priors of the friction law, and the priors of all other parameters."""
    own = {path: prior for path, prior in priors.items() if path.startswith("friction.")}
    return own, {path: prior for path, prior in priors.items() if path not in own}


def levels(rig: Rig) -> Levels:
    """Return the ranges of the description's friction coefficients, over its priors."""
    random = np.random.default_rng(0)
    own, _ = split(rig.priors)
    restricted = is_restricted(rig.slider, own)
    found = []
    for shares in random.uniform(size=(DRAWN, len(own))):
        pairs = zip(own.items(), shares, strict=True)
        values = {path: float(prior.quantile(share)) for (path, prior), share in pairs}
        if restricted and not is_allowed(rig.slider, values):
            continue
        found.append(coefficients_of(rig.slider, values))
    found = found or [coefficients_of(rig.slider, {})]  # hardly any is allowed
    (s_low, k_low), (s_high, k_high) = np.quantile(found, BOUNDS_95, axis=0)
    s_low, k_low, s_high, k_high = (
        s_low * (1.0 - WIDER), k_low * (1.0 - WIDER), s_high * (1.0 + WIDER), k_high * (1.0 + WIDER)
    )  # fmt: skip
    if k_high > s_low:  # neither beyond the middle
        between = 0.5 * (k_high + s_low)
        s_low, k_high = max(s_low, between), min(k_high, between)
    return Levels((float(s_low), float(s_high)), (float(k_low), float(k_high)))


def coefficients_of(slider: Slider, values: Mapping[str, float]) -> tuple[float, float]:
    """Return the coefficients at rest and in rapid slip for other parameters of the law."""
    changed = slider
    for path, value in values.items():
        changed = change_unchecked(changed, path, value)
    law: Any = changed.law
    at_rest = max(law.coefficient(0.0), getattr(law, "mu_static", 0.0))
    return at_rest, law.coefficient(fastest(slider))


def fastest(slider: Slider) -> float:
    """Return the largest speed of the mass after the spring releases the friction force F_0."""
    return slider.F_0 / sqrt(slider.k_x * slider.mass)


def priors_of(law: Any, slider: Slider, level: Levels) -> Iterator[tuple[str, Prior]]:
    """Yield the priors of a law's parameters, by their path."""
    static, kinetic = level
    fall, speed = level.fall, slider.drive_speed
    if law is Coulomb:
        yield "friction.mu_0", Uniform(*kinetic)
        yield "friction.mu_static", Uniform(*static)
    elif law is LuGre:
        k_x, mass = slider.k_x, slider.mass
        yield "friction.mu_c", Uniform(*kinetic)
        yield "friction.mu_s", Uniform(*static)
        low, high = sorted((speed, STRIBECK * fastest(slider)))
        yield "friction.v_s", Uniform(low, high, "log")
        yield "friction.sigma_0", logarithmic(BRISTLES, k_x)
        yield "friction.sigma_1", logarithmic(DAMPING, sqrt(k_x * mass))
    else:
        least = least_direct_effect(EVOLVING[1] * fall, static[1])
        direct = logarithmic(DIRECT, fall)
        yield "friction.a", Uniform(max(direct.low, least), max(direct.high, 10.0 * least), "log")
        yield "friction.b", logarithmic(EVOLVING, fall)
        yield "friction.D_c", logarithmic(DISTANCE, fall * slider.normal_load / slider.k_x)
        yield "friction.mu_star", Uniform(kinetic[0], static[1])


def logarithmic(shares: tuple[float, float], scale: float) -> Uniform:
    """Return a log-uniform prior between two multiples of a scale."""
    return Uniform(shares[0] * scale, shares[1] * scale, "log")


def middle_of(law: Any, slider: Slider, priors: dict[str, Prior]) -> Any:
    """Return a law at the medians of its priors; its reference speed is the drive's."""
    middles = {path.removeprefix("friction."): middle(prior) for path, prior in priors.items()}
    if "V_star" in law._fields:
        middles["V_star"] = slider.drive_speed
    return law(**middles)
