"""Slide, hold, slide: does the force peak after a hold, if friction itself does not age?

With constant friction the spring continues to creep during the hold, and no peak follows.
"""

import stiction as st

test = st.protocols.DriveProgram(
    velocity="1 mm/s",
    program=[
        st.protocols.Constant(duration="4 s"),
        st.protocols.Hold("3 s"),
        st.protocols.Constant(duration="3 s"),
    ],
)
for law in (st.Coulomb(mu_0=0.2), st.Coulomb(mu_0=0.15, mu_static=0.2)):
    slider = st.presets.nakano_popov_2020().replace(friction=law, drive=test)
    run = st.simulate(slider, duration="10 s", sample_rate="1 kHz")
    force = run.data["spring_x"]
    before, after = force.sel(time=slice(3.5, 4.0)), force.sel(time=slice(7.0, 10.0))
    print(f"{law}: before {float(before.mean()):.4f} N, peak after {float(after.max()):.4f} N")
