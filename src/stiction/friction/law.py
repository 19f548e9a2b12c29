"""What the solver asks of a friction law."""

from __future__ import annotations

from typing import Any, Protocol


class FrictionLaw(Protocol):
    """A set-valued friction law: at zero slip it holds up to ``coefficient(0)`` times the load.

    Both methods are compiled: they may use floats, `math` and the law's own fields.
    Their first argument is the law itself, named ``law``.
    """

    @property
    def _fields(self) -> tuple[str, ...]: ...

    def _asdict(self) -> dict[str, Any]: ...

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` >= 0 (m/s)."""

    def slope(law, v: float) -> float:
        """Return the derivative of the coefficient with respect to `v`, in s/m."""
