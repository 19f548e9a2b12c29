"""A surface with more friction in one direction than in another."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple, cast

from pydantic import AfterValidator, Field

from stiction.errors import DescriptionError, echo
from stiction.friction.law import FrictionLaw, Law, has_state
from stiction.text.units import Angle, Radians, Read, reader
from stiction.text.validation import validate


def _is_set_valued(law: Any) -> Any:
    if has_state(law) or isinstance(law, Anisotropic) or not hasattr(law, "slope"):
        raise ValueError(f"{echo(law)} cannot be made anisotropic; only a set-valued law can")
    return law


Ratio = Annotated[Read[float], reader("a number", "", "1.5"), Field(gt=0)]


@validate
class Anisotropic(NamedTuple):
    """A set-valued law on a surface whose friction limit is an ellipse in the plane.

    The friction force satisfies (F_1/mu)^2 + (F_2/(ratio mu))^2 <= W^2, with 1 and 2 along and
    across the surface's own axis. Slip follows the outward normal of this ellipse (the associated
    flow rule). With s the slip velocity, M = diag(1, ratio), and mu the law's coefficient at the
    speed |s|,

        F = mu(|s|) W M^2 s/|M s|.

    The force is not opposite to the slip; it dissipates mu W |M s|.

    References: R. Michalowski & Z. Mroz, Arch. Mech. 30, 259 (1978); A. Zmitrowicz, Int. J.
    Solids Struct. 43, 4407 (2006), doi:10.1016/j.ijsolstr.2005.06.008.

    Parameters
    ----------
    law : FrictionLaw
        Friction along the surface's axis.
    ratio : float
        Coefficient across the axis over that along it; 0.7 to 1.5 for worn or ground metal.
    angle : str
        From the drive direction X to the surface's axis, towards Y, with its unit.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.Anisotropic(law=st.Coulomb(mu_0=0.2), ratio=2.0, angle="45 deg")
    >>> law.coefficient(0.0)
    0.2
    """

    law: Annotated[Any, AfterValidator(_is_set_valued), "set-valued friction law"]
    ratio: Ratio
    angle: Angle = Radians(0.0)

    @property
    def mu_static(law) -> float:
        """The law's separate static coefficient; zero if there is none."""
        return float(getattr(law.law, "mu_static", 0.0))

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient along the axis at slip speed `v` (m/s)."""
        inner: FrictionLaw = law.law
        return inner.coefficient(v)

    def slope(law, v: float) -> float:
        """Return the derivative of the coefficient with respect to `v`, in s/m."""
        inner: FrictionLaw = law.law
        return inner.slope(v)


def ellipse(law: Law) -> tuple[float, float]:
    """Return ratio and angle (rad, from X) of the friction limit; 1 and 0 for a circle."""
    return (law.ratio, law.angle) if isinstance(law, Anisotropic) else (1.0, 0.0)


def read_anisotropy(law: Law, table: Any) -> Law:
    """Read the table [friction.anisotropy]."""
    if not isinstance(table, dict) or "law" in table:
        message = f"must be a table with ratio and angle, is {echo(table)}"
        raise DescriptionError.of("friction.anisotropy", message)
    try:
        made: Any = Anisotropic(law, **table)
        return cast(Law, made)
    except DescriptionError as error:
        raise error.at("friction.anisotropy") from None


def anisotropy_table(law: Anisotropic) -> dict[str, Any]:
    """Return the table [friction.anisotropy] of a law."""
    return {"ratio": law.ratio, "angle": f"{law.angle!r} rad"}
