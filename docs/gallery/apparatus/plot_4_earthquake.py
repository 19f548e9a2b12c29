"""
An earthquake cycle over six decades of slip speed
==================================================

A spring-slider with rate and state and with inertia: an hour of creep, for ten minutes of it at
less than a tenth of a micrometre a second, then a slip at decimetres a second. One run, one solver,
no switch between a quasi-static and a dynamic code.
"""

import matplotlib.pyplot as plt

import stiction as st

run = st.run(st.presets.earthquake_cycle())
figure, ax = plt.subplots(figsize=(6, 3), layout="constrained")
ax.semilogy(run.samples["time"], run.samples["slip_speed"], linewidth=0.8)
ax.set(xlabel="time (s)", ylabel="slip speed (m/s)")
