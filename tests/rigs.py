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

# a soft tensile tester with a sled: stable in a window of misalignments far from its own
SOFT_TESTER = st.Slider(
    mass="200 g",
    k_x="150 N/m",
    k_y="60 kN/m",
    phi="0.5 deg",
    normal_load="2 N",
    friction=st.ExponentialWeakening(mu_0=0.35, mu_inf=0.22, v_f="5 mm/s"),
    drive=st.ConstantVelocity("2 mm/s"),
)

# the soft spring hardly points along the drive: the misalignment lies in such a window
TURNED_A_LOT = st.Slider(
    mass="0.1 kg",
    k_x="2 kN/m",
    k_y="4 MN/m",
    phi="40 deg",
    normal_load="6 N",
    friction=st.ExponentialWeakening(mu_0=0.25, mu_inf=0.15, v_f="10 mm/s"),
    drive=st.ConstantVelocity("1 mm/s"),
)

# a stiff press, heavy, damped across: unstable in a window of drive velocities
STIFF_PRESS = st.Slider(
    mass="12 kg",
    k_x="400 kN/m",
    k_y="80 MN/m",
    phi="1.5 deg",
    normal_load="800 N",
    c_x="40 N s/m",
    c_y="800 N s/m",
    friction=st.laws.Stribeck(mu_s=0.18, mu_c=0.11, v_s="20 mm/s"),
    drive=st.ConstantVelocity("1 mm/s"),
)

# a friction force microscope: the mass rests between slips, under a force far off the drive
MICROSCOPE = st.Slider(
    mass="1e-11 kg",
    k_x="0.5 N/m",
    k_y="40 N/m",
    phi="5 deg",
    normal_load="20 nN",
    friction=st.ExponentialWeakening(mu_0=0.5, mu_inf=0.3, v_f="10 um/s"),
    drive=st.ConstantVelocity("1 um/s"),
)

# driven slowly, with friction that weakens steeply: creep ends before theory has it
VERY_SLOW = st.Slider(
    mass="0.25 kg",
    k_x="1 kN/m",
    k_y="10 MN/m",
    phi="1 deg",
    normal_load="10 N",
    friction=st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f="1 mm/s"),
    drive=st.ConstantVelocity("20 um/s"),
)

# a brake caliper in creep groan: a large and a small slip in each period
CALIPER = st.Slider(
    mass="12 kg",
    k_x="4 kN/mm",
    k_y="90 kN/mm",
    phi="6 deg",
    normal_load="5 kN",
    friction=st.ExponentialWeakening(mu_0=0.45, mu_inf=0.36, v_f="20 mm/s"),
    drive=st.ConstantVelocity("4 mm/s"),
)

# a pin on a plate: unstable at every misalignment, at the speed that it has
PIN_ON_PLATE = st.Slider(
    mass="80 g",
    k_x="2.3 kN/m",
    k_y="900 kN/m",
    phi="2 deg",
    normal_load="4 N",
    friction=st.ExponentialWeakening(mu_0=0.6, mu_inf=0.45, v_f="10 mm/s"),
    drive=st.ConstantVelocity("0.5 mm/s"),
)
