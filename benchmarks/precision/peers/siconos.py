"""Moreau-Jean time stepping of Siconos, with set-valued friction and nothing regularised.

Siconos comes from Debian (``apt-get install python3-siconos``) and lives in Debian's own
interpreter; hence only NumPy beside it. Its friction coefficient is constant: the weakening is
updated before each step with the slip that the last one ended with.
"""

from __future__ import annotations

from math import exp, hypot

import numpy as np

from benchmarks.harness.contestant import Contestant, rows
from benchmarks.precision.case import (
    K_X,
    K_Y,
    MASS,
    MU_0,
    MU_INF,
    PHI,
    V_F,
    W,
    drive,
    initial_state,
)

STEPS = ({"h": 1e-3}, {"h": 1e-4}, {"h": 1e-5})  # s


def contestants() -> list[Contestant]:
    """Return the rows of Siconos."""
    import siconos.kernel as kernel
    import siconos.numerics as numerics

    def solve(times, *, h, phi=PHI):
        v = drive(phi)
        # (x, y, z) of the mass, z up; the springs' end is a body (x, y) that nothing slows down
        start = initial_state(phi)
        velocity = np.array([start[2], start[3], 0.0, *v])
        stiffness = np.zeros((5, 5))
        for i, k in enumerate((K_X, K_Y)):
            stiffness[i, i], stiffness[i, 3 + i] = k, -k
        mass = np.diag([MASS, MASS, MASS, 1.0, 1.0])
        undamped = np.zeros((5, 5))
        body = kernel.LagrangianLinearTIDS(np.zeros(5), velocity, mass, stiffness, undamped)
        weight = np.array([0.0, 0.0, -W, 0.0, 0.0])
        body.setFExtPtr(weight)  # shared, not copied: the array must live

        law = kernel.NewtonImpactFrictionNSL(0.0, 0.0, MU_0, 3)
        contact = np.zeros((3, 5))
        contact[0, 2] = contact[1, 0] = contact[2, 1] = 1.0  # normal, then the plane
        interaction = kernel.Interaction(law, kernel.LagrangianLinearTIR(contact))
        count = max(1, round((times[1] - times[0]) / h))
        model = kernel.NonSmoothDynamicalSystem(0.0, (count * len(times) + 1) * h)
        model.insertDynamicalSystem(body)
        model.link(interaction, body)
        instants, method = kernel.TimeDiscretisation(0.0, h), kernel.MoreauJeanOSI(0.5)
        cone = kernel.FrictionContact(3, numerics.SICONOS_FRICTION_3D_ONECONTACT_NSN)
        cone.numericsSolverOptions().dparam[0] = 1e-14  # impulses W h are small
        simulation = kernel.TimeStepping(model, instants, method, cone)
        found = np.zeros((len(times), 2))
        for i in range(1, len(times)):
            for _ in range(count):
                slip = body.velocity()
                law.setMu(MU_INF + (MU_0 - MU_INF) * exp(-hypot(slip[0], slip[1]) / V_F))
                simulation.computeOneStep()
                simulation.nextStep()
            position = body.q()
            found[i] = position[3:] - position[:2]
        return found

    return rows("Moreau-Jean (Siconos)", solve, STEPS)
