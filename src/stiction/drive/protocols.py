"""Friction tests by name, programs of the drive and of the normal load, and their pieces.

>>> import stiction as st
>>> st.protocols.Hold("3 s")
st.protocols.Hold(duration=3.0)
"""

from __future__ import annotations

from stiction.names import public

__getattr__, __dir__ = public(__name__)
