"""Figures: each is a function that draws on given axes, and returns them.

Without axes it makes a figure of its own, which a notebook or ``matplotlib.pyplot.show()`` shows.
Nothing is shown or saved here. A figure of several panels takes and returns several axes.

>>> import stiction as st
>>> from stiction.plotting import plot_law
>>> plot_law(st.presets.nakano_popov_2020()).get_ylabel()
'$\\\\mu$ (1)'
"""

from __future__ import annotations

from stiction.names import public

__getattr__, __dir__ = public(__name__)
