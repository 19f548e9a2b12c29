"""A user's friction law (see mylaw.py): checked, then simulated at full speed."""

from mylaw import Logarithmic

import stiction as st

law = Logarithmic(mu_0=0.2, b=0.01, v_c=1e-4)
st.testing.check_law(law)  # names each fault: slope, sign, code that cannot be compiled
slider = st.presets.nakano_popov_2020().replace(friction=law)
run = st.simulate(slider, duration="5 s", sample_rate="1 kHz")
force = run.data["spring_x"].sel(time=slice(2, None))
print(f"{run.status.value}; {run.statistics.stick_count} sticks")
print(f"the force swings between {float(force.min()):.3f} N and {float(force.max()):.3f} N")
