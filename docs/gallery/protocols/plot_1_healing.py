"""
Slide, hold, slide: healing per decade
======================================

Friction with a state of its own grows with the logarithm of the hold. The line is the fit, with
its standard error. The peaks of a run are exact; those of a record have errors by its sampling.
`stiction presets slide-hold-slide` is a published test of this kind.
"""

import stiction as st

rock = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
test = st.protocols.slide_hold_slide(
    "10 um/s", ["3 s", "10 s", "30 s", "100 s", "300 s", "1000 s"], slide="20 s"
)
slider = st.Slider(
    mass="1 g",
    k_x="1 MN/m",
    k_y="100 MN/m",
    phi="0 deg",
    normal_load="10 N",
    friction=rock,
    drive=test,
)
run = st.simulate(slider, sample_rate="20 Hz")
st.plotting.plot_healing(st.analysis.healing(run))
