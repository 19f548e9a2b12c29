"""Springs in series between slider and drive, and the one spring that they make.

Their compliances add, each a tensor in its own axes: (M75), (M76). A mass of a part is left
out of the equations; the audit says whether that matters (M77).
"""

from __future__ import annotations

import re
from cmath import exp, phase
from collections.abc import Iterator, Sequence
from functools import lru_cache, partial
from itertools import combinations
from math import inf, isinf, pi, sin
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator, BeforeValidator, Field, PlainSerializer

from stiction.arrays import Floats
from stiction.errors import DescriptionError, Fault, echo
from stiction.system.tensors import ROUND, principal
from stiction.text.paths import slug
from stiction.text.quantity.exact import RIGID, angle_text
from stiction.text.units import Angle, Kind, Mass, Radians, Read, fault, reader, to_si
from stiction.text.validation import faulty, make, validate

LETTER = r"[^\W\d_]"
STIFFNESSES, COMPLIANCES = ("k_x", "k_y"), ("compliance_x", "compliance_y")
SINGULAR = 1e-15  # of the larger compliance: a smaller one is lost beside it


def _stiffness(value: object, kind: Kind, words: tuple[str, ...] = ()) -> float:
    return inf if value in (*words, inf) else to_si(value, kind)


def _has_a_letter(name: str) -> str:
    if not re.search(LETTER, name):
        raise ValueError(f"must have a letter, is {echo(name)}; write for example 'load cell'")
    return name


_KIND = Kind(f"a stiffness or '{RIGID}'", "N/m", "1 kN/m")
Stiffness = Annotated[
    Read[float],
    BeforeValidator(partial(_stiffness, kind=_KIND, words=(RIGID,))),
    Field(gt=0),
    "float (N/m) | str, or 'rigid'",
]
Compliance = Annotated[Read[float], reader("a compliance", "m/N", "2 um/N"), Field(ge=0)]
Name = Annotated[str, AfterValidator(_has_a_letter), Field(json_schema_extra={"pattern": LETTER})]


@validate
class Spring(NamedTuple):
    """One of several springs in series: a load cell, a drive, a pair of leaf springs.

    Parameters
    ----------
    name : str
        What it is; each has another one.
    k_x, k_y : float or str, optional
        Stiffnesses along its own axes, N/m, or ``"rigid"``.
    angle : str, optional
        From x, towards y, to the axis of its `k_x`.
    mass : float or str, optional
        Mass that moves with it, kg. The model leaves it out; the audit says whether that matters.
    compliance_x, compliance_y : float or str, optional
        Compliances along its own axes, m/N, each in place of a stiffness; 0 where it is rigid.

    Examples
    --------
    >>> import stiction as st
    >>> cell = st.Spring("load cell", compliance_x="50 um/N", k_y="rigid")
    >>> slider = st.presets.nakano_popov_2020()
    >>> round(slider.replace(springs=[cell, st.Spring("leaf", 1e3, 1e7)]).k_x, 3)
    952.381
    """

    name: Name
    k_x: Stiffness | None = None
    k_y: Stiffness | None = None
    angle: Angle = Radians(0.0)
    mass: Mass | None = None
    compliance_x: Compliance | None = None
    compliance_y: Compliance | None = None

    def faults(self) -> Iterator[tuple[str, str]]:
        """Yield each axis without a stiffness or a compliance, or with both."""
        for k, c in zip(STIFFNESSES, COMPLIANCES, strict=True):
            given = [name for name in (k, c) if getattr(self, name) is not None]
            if not given:
                yield k, f"missing; give {k}, or {c}"
            elif len(given) > 1:
                yield c, f"says the same as {k}; leave one of them out"

    @property
    def compliances(self) -> tuple[float, float]:
        """Compliances along its own axes, m/N; 0 where it is rigid."""
        c_x, c_y = (
            1.0 / (k or inf) if c is None else c
            for k, c in ((self.k_x, self.compliance_x), (self.k_y, self.compliance_y))
        )
        return c_x, c_y

    @property
    def slug(self) -> str:
        """The name as it stands in the path of a parameter, ``load-cell``."""
        return slug(self.name)


class Whole(NamedTuple):
    """The spring that several in series make: stiffnesses (N/m), and the angle (rad) to its x."""

    k_x: float
    k_y: float
    angle: float


@lru_cache(maxsize=1024)
def whole(springs: tuple[Spring, ...]) -> Whole:
    """Return the one spring that springs in series make (M76).

    A stiffness is infinite where all are rigid. Each part yields along its two axes, by c_p at the
    angle a_p. The softer axis of the whole is at half the argument of z = sum c_p exp(2 i a_p), its
    compliance half of sum c_p + |z|; that of the stiffer axis follows from the determinant, the sum
    of c_p c_q sin(a_p - a_q)^2, without a difference. The axis x is the principal one that is
    nearer to the line x of the description.
    """
    own = [each.compliances for each in springs]
    z = sum((x - y) * exp(2j * each.angle) for each, (x, y) in zip(springs, own, strict=True))
    along = [(x, each.angle) for each, (x, _) in zip(springs, own, strict=True)]
    across = [(y, each.angle + 0.5 * pi) for each, (_, y) in zip(springs, own, strict=True)]
    yields = [*along, *across]
    total = sum(c for c, _ in yields)
    soft = 0.5 * (total + abs(z))
    determinant = sum(c * d * sin(a - b) ** 2 for (c, a), (d, b) in combinations(yields, 2))
    stiff = determinant / soft if soft > 0.0 else 0.0
    k_soft, k_stiff = (1.0 / c if c > SINGULAR * soft else inf for c in (soft, stiff))
    if abs(z) <= ROUND * total:  # equally stiff in all directions
        return Whole(k_soft, k_stiff, 0.0)
    angle = 0.5 * phase(z)  # of the softer axis
    if -0.25 * pi < angle <= 0.25 * pi:
        return Whole(k_soft, k_stiff, angle)
    angle += -0.5 * pi if angle > 0.0 else 0.5 * pi
    return Whole(k_stiff, k_soft, angle if abs(angle) > ROUND else 0.0)


def read_springs(value: Any) -> tuple[Spring, ...]:
    """Return springs from a list of tables, or of springs.

    Raises
    ------
    PydanticCustomError
        With every fault.
    """
    if not isinstance(value, Sequence) or isinstance(value, str | Spring):
        raise fault(f"{echo(value)} is not a list of springs; write tables [[slider.springs]]")
    made: list[Spring] = []
    found: list[Fault] = []
    for number, each in enumerate(value, 1):
        try:
            made.append(_spring(each))
        except DescriptionError as error:
            found += error.at(str(number)).faults
    names = [each.slug for each in made]
    twice = sorted({each.name for each in made if names.count(each.slug) > 1})
    found += [
        Fault("name", f"{echo(name)} stands twice; name each spring otherwise") for name in twice
    ]
    if found:
        raise faulty(found)
    springs = tuple(made)
    if springs and isinf(max(whole(springs)[:2])):
        raise fault("are rigid together along some axis; let one of them yield there: give it k_y")
    return springs


def _spring(value: Any) -> Spring:
    if isinstance(value, Spring):
        return value
    if isinstance(value, dict):
        return make(Spring, value)
    remedy = "write st.Spring('load cell', k_x='20 kN/m', k_y='rigid')"
    raise DescriptionError.of("spring", f"{echo(value)} is not a spring; {remedy}")


def compliance(spring: Spring) -> Floats:
    """Return the compliance tensor of a spring in the axes of the description, (2, 2), m/N."""
    return principal(*spring.compliances, spring.angle)


def scale_stiffness(spring: Spring, factor: float) -> Spring:
    """Return a spring that is `factor` times as stiff along both axes; rigid for infinity."""
    stiffer = {name: (getattr(spring, name), factor) for name in STIFFNESSES}
    stiffer |= {name: (getattr(spring, name), 1.0 / factor) for name in COMPLIANCES}
    return spring._replace(
        **{name: its * by for name, (its, by) in stiffer.items() if its is not None}
    )


def spring_table(spring: Spring) -> dict[str, Any]:
    """Return a spring as a table of a description, with SI numbers."""
    table = {name: its for name, its in spring._asdict().items() if its is not None}
    table |= {name: RIGID for name in STIFFNESSES if table.get(name) == inf}
    if spring.angle:
        return table | {"angle": angle_text(spring.angle)}
    del table["angle"]
    return table


Springs = Annotated[
    Read[tuple[Any, ...]],
    BeforeValidator(read_springs),
    PlainSerializer(lambda springs: [spring_table(each) for each in springs]),
    "sequence of Spring",
]
