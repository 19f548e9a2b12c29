"""Rigs beside that of the paper, for tests of what is said of them."""

import stiction as st

# one side of the spring is only three times as stiff as the other
NEARLY_ISOTROPIC = st.Slider(
    mass="0.5 kg",
    k_x="5 kN/m",
    k_y="15 kN/m",
    phi="12 deg",
    normal_load="15 N",
    friction=st.ExponentialWeakening(mu_0=0.3, mu_inf=0.2, v_f="20 mm/s"),
    drive=st.ConstantVelocity("5 mm/s"),
)
