"""Analysis of runs and measured records: motion, cycles, creep, oscillation, energy.

`stiction.analyse` calls all of it; here each part stands by itself.

>>> import numpy as np
>>> import stiction as st
>>> time = np.arange(0, 30, 0.01)
>>> record = st.Record(time=time, force=1.0 + 0.2 * (time % 2.0))
>>> st.analysis.classify(record).kind
'stick-slip'
"""

from __future__ import annotations

from stiction.names import public

__getattr__, __dir__ = public(__name__, {"detrended": "stiction.analysis.detrend"})
