"""The contract of friction laws, as a base class for tests and as one function.

The test of a user's law is two lines, which pytest collects::

    from stiction.testing import LawContract

    class TestMine(LawContract):
        law = MyLaw(mu=0.2)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, ClassVar

from stiction.errors import DescriptionError, Fault, echo
from stiction.friction import has_state
from stiction.friction.user.validation import ENDING, endless, fault, is_law, no_number
from stiction.testing.common import COMMON, SPEEDS
from stiction.testing.set_valued import SET_VALUED
from stiction.testing.with_state import WITH_STATE
from stiction.text.validation import in_si

Check = Callable[[Any, Sequence[float]], Iterator[str]]


def checks_of(law: Any) -> dict[str, Check]:
    """Return the checks of a law by name; each yields its faults in words.

    Examples
    --------
    >>> import stiction as st
    >>> sorted(st.testing.checks_of(st.Coulomb(mu_0=0.2)))[:3]
    ['comparable', 'compiled', 'continuous']
    """
    return {**(WITH_STATE if has_state(law) else SET_VALUED), **COMMON}


def check_law(law: Any, speeds: Sequence[float] | None = None) -> None:
    """Check that a friction law satisfies the solver's assumptions.

    Its methods must end, its values must be finite, its friction dissipative, its slope the
    derivative of its coefficient, and compiled results equal to Python's. It must survive pickling
    and a round trip through a description, and work in a short run of the paper's system.

    Parameters
    ----------
    law : FrictionLaw or StateLaw
        With its parameters, e.g. ``MyLaw(mu=0.2)``.
    speeds : sequence of float, optional
        Slip speeds at which it is checked, m/s; by default `SPEEDS`, 0 and 1 nm/s to 10 m/s.

    Raises
    ------
    DescriptionError
        With all faults.

    Examples
    --------
    >>> import stiction as st
    >>> st.testing.check_law(st.Coulomb(mu_0=0.2))
    """
    if isinstance(law, type):
        raise DescriptionError.of(law.__name__, f"is a class; write {law.__name__}(...)")
    is_law(type(law), type(law).__name__)
    law = in_si(law)
    kind = type(law).__name__
    if said := endless(law):
        raise DescriptionError.of(kind, f"{said}; {ENDING}")
    if wrong := no_number(law):
        method, rest = wrong
        raise fault(f"{method} of {echo(kind)} {rest}")
    found = [
        Fault(f"{kind}.{name}", message)
        for name, check in checks_of(law).items()
        for message in check(law, SPEEDS if speeds is None else speeds)
    ]
    if found:
        raise DescriptionError(found)


class LawContract:
    """Tests of one law: derive a class and set `law`; it gets a test for each check.

    Attributes
    ----------
    law : FrictionLaw or StateLaw
        With its parameters.
    speeds : sequence of float
        Slip speeds at which it is checked, m/s.

    Examples
    --------
    >>> import stiction as st
    >>> from stiction.testing import LawContract
    >>> class TestMine(LawContract):
    ...     law = st.Coulomb(mu_0=0.2)
    >>> TestMine().test_slope()
    """

    law: ClassVar[Any]
    speeds: ClassVar[Sequence[float]] = SPEEDS

    def __init_subclass__(cls, **kwargs: Any) -> None:
        """Add the tests to the class."""
        super().__init_subclass__(**kwargs)
        for name, check in checks_of(cls.law).items() if hasattr(cls, "law") else ():
            if f"test_{name}" not in vars(cls):
                setattr(cls, f"test_{name}", _test(name, check))


def _test(name: str, check: Check) -> Callable[[LawContract], None]:
    def test(self: LawContract) -> None:
        found = list(check(self.law, self.speeds))
        assert not found, "\n".join(found)

    test.__name__ = f"test_{name}"
    test.__doc__ = check.__doc__
    return test


__all__ = ["SPEEDS", "LawContract", "check_law", "checks_of"]


def __dir__() -> list[str]:
    return sorted(__all__)
