"""Arrays of numbers, as annotations name them, two constants, and xarray, imported when used."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["NORMAL_MEDIAN", "TINY", "Complex", "Floats", "Indices", "xr"]

TINY = 1e-300  # nothing beside any quantity in SI, and more than 0: of a divisor, or in a logarithm
NORMAL_MEDIAN = 0.6744897501960817  # of |x| of a standard normal x

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Indices = NDArray[np.intp]

if TYPE_CHECKING:
    import xarray as xr
else:

    class _LateModule:
        """A module that takes longer to import than a run: it waits until it is used."""

        def __getattr__(self, name: str) -> Any:
            return getattr(import_module("xarray"), name)

    xr = _LateModule()
