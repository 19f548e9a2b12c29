"""Linearised steady sliding, for any friction law: modes, critical values, boundaries.

>>> import stiction as st
>>> slider = st.presets.nakano_popov_2020()
>>> round(st.linear_stability.growth_rate(slider), 2)  # at 1 degree of misalignment, 1/s
152.35
"""

from stiction.linear_stability.curve import boundary
from stiction.linear_stability.examination import Stability, stability
from stiction.linear_stability.linear import Linearisation, growth_rate, steady_sliding
from stiction.linear_stability.roots import Critical, critical
from stiction.linear_stability.spectrum import modes_over

__all__ = [
    "Critical",
    "Linearisation",
    "Stability",
    "boundary",
    "critical",
    "growth_rate",
    "modes_over",
    "stability",
    "steady_sliding",
]
