"""The classes that the verbs return, beside `stiction.Trajectory`: for annotations and help.

>>> import stiction as st
>>> found = st.stability(st.presets.nakano_popov_2020())
>>> isinstance(found, st.results.Stability)
True
"""

from __future__ import annotations

from stiction.names import public

__getattr__, __dir__ = public(__name__)
