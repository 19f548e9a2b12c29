"""Creep without any misalignment: of a contact that gives way before it slips."""

from __future__ import annotations

from math import exp

import numpy as np

from stiction.analysis.creep.curve import Bins
from stiction.analysis.creep.least_squares import THEORY, CreepFit, best_fit
from stiction.arrays import Floats

STARTS = ((3.0, 0.005), (3.0, 0.05), (6.0, 0.005), (6.0, 0.05))  # ln stiffness, excess of F_0
LOW, HIGH = (-3.0, 1e-6, -0.1), (14.0, 10.0, 0.1)
SIZES = 1.0, 0.01, 1e-4


def fit_presliding(used: Bins) -> CreepFit:
    """Return the best fit of presliding alone to creep, in which no friction turns.

    A contact of stiffness R k_x yields as in the bristle models (Dahl, LuGre): its force F grows by
    R k_x (1 - F/F_0) for each unit of slip, so that a mass that is pulled at V by a spring k_x
    creeps at V/(1 + R (1 - F/F_0)). The force of `used` is that over the peak, the velocity that
    over V. Fitted are ln R, the excess of F_0 over the largest force, and a common error.
    """
    largest = float(used.force.max())

    def model(log_ratio: float, excess: float, off: float) -> Floats:
        left = 1.0 - used.force / (largest + excess)
        return np.append((1.0 + off) / (1.0 + exp(log_ratio) * left), off)

    values, errors = np.append(used.velocity, 0.0), np.append(used.error, THEORY)
    return best_fit(model, values, errors, [(*start, 0.0) for start in STARTS], (LOW, HIGH), SIZES)
