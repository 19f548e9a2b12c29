"""Audit of an apparatus: does it measure friction, or itself?

>>> import stiction as st
>>> found = st.audit(st.presets.nakano_popov_2020().replace(phi="9.5 deg"))
>>> found.observation.regime.kind, found.sliding.stable
('settling', True)
"""

from stiction.auditing.report import Audit, audit

__all__ = ["Audit", "audit"]
