"""A rig whose description states what is uncertain, for fits of its records."""

TEXT = """
[slider]
mass = "80 g"
k_x = "2.3 +- 0.1 kN/m"
k_y = "0.9 MN/m"
phi = {low = "0.5 deg", high = "5 deg", scale = "log"}
normal_load = "4 N"

[friction]
law = "exponential-weakening"
mu_0 = {low = 0.5, high = 0.75}
mu_inf = {low = 0.25, high = 0.5}
v_f = "10 mm/s"

[drive]
velocity = "0.5 mm/s"
"""
