"""Linearised steady sliding, for any friction law: modes, critical values, boundaries.

>>> import stiction as st
>>> slider = st.presets.nakano_popov_2020()
>>> round(st.linear_stability.growth_rate(slider), 2)  # at 1 degree of misalignment, 1/s
152.35
"""

from __future__ import annotations

from stiction.names import public

__getattr__, __dir__ = public(__name__)
