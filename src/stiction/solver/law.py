"""A set-valued law behind pointers, for the compiled solver."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stiction.friction.law import static_coefficient
from stiction.solver.compilation.jit import entry_by_address
from stiction.solver.compilation.pointer import caller, code_and_fields, pointee, types
from stiction.solver.problem import coefficient, slope

call: Any = caller(types.UniTuple(types.float64, 2), types.float64)


class PointedLaw(NamedTuple):
    """A set-valued law: one compiled function, and its fields.

    Parameters
    ----------
    code : int
        Address of `coefficient_and_slope_at`, compiled for this law.
    fields : ndarray
        Memory with the law's fields.
    mu_static : float
        The law's largest coefficient at zero slip.
    """

    code: int
    fields: np.ndarray
    mu_static: float

    def coefficient_and_slope(self, v: float) -> tuple[float, float]:
        """Return the friction coefficient and its derivative (s/m) at slip speed `v` (m/s)."""
        found: tuple[float, float] = call(self.code, self.fields, (v,))
        return found

    def coefficient(self, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return float(call(self.code, self.fields, (v,))[0])


def point_to(law: Any) -> PointedLaw:
    """Return a set-valued law behind pointers."""
    code, fields = code_and_fields(law, coefficient_and_slope_at)
    return PointedLaw(code, fields, static_coefficient(law))


@entry_by_address(types.float64)
def coefficient_and_slope_at(law: Any, v: float) -> tuple[float, float]:
    """Return coefficient and slope (s/m), at slip speed `v` (m/s), of the law at a pointer."""
    found: Any = pointee(law)
    return coefficient(found, v), slope(found, v)
