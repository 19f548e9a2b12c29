"""A friction law of one's own: hyperbolic weakening, in ten lines, compiled at full speed."""

from typing import NamedTuple

import stiction as st


class Hyperbolic(NamedTuple):
    """mu = mu_0/(1 + v/v_h)."""

    mu_0: float
    v_h: float

    def coefficient(law, v):
        """Friction coefficient at slip speed v (m/s)."""
        return law.mu_0 / (1 + v / law.v_h)

    def slope(law, v):
        """Its derivative (s/m)."""
        return -law.mu_0 / law.v_h / (1 + v / law.v_h) ** 2


slider = st.presets.nakano_popov_2020().replace(friction=Hyperbolic(mu_0=0.2, v_h=0.05))
run = st.simulate(slider, duration="5 s", sample_rate="1 kHz")
force = run.data["spring_x"].sel(time=slice(2, None))
print(f"{run.status.value}; {run.statistics.stick_count} sticks")
print(f"the force swings between {float(force.min()):.3f} N and {float(force.max()):.3f} N")
