"""Rate-and-state friction: `common` has the shared part, the other modules one or two states.

Friction depends on the slip speed V and on states theta, contact times of the surfaces
(Dieterich 1979, doi:10.1029/JB084iB05p02161; Ruina 1983, doi:10.1029/JB088iB12p10359):

    mu = mu* + a ln(V/V*) + sum_i b_i ln(V* theta_i/D_i)

with a direct effect a, evolution effects b_i over the slip distances D_i, and mu* the steady
coefficient at V*. At rest the logarithm is undefined. The regularised form, from the rate of
thermally activated slip in both directions (Rice & Ben-Zion 1996; Lapusta et al. 2000,
doi:10.1029/2000JB900250), differs only at slip speeds below 2 V* exp(-psi/a):

    mu = a asinh[(V/2V*) exp(psi/a)],   psi = mu* + sum_i b_i ln(V* theta_i/D_i)

The internal states of the solver are log_theta_i = ln(V* theta_i/D_i). A change of the normal load
leaves them as they are: the coupling of Linker & Dieterich (1992, doi:10.1029/92JB00017) is not in.
"""
