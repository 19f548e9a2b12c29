"""The six equations of a step and their Jacobian, for any surface, drive and load."""

import numpy as np
import pytest
from tests.drawn import inside
from tests.entry import plain
from tests.systems import MOTIONS, SLIDERS, Printed, motion_of, problem_of

from stiction.solver.exact import collocation, newton, oscillation, slip_frame
from stiction.solver.exact.collocation import SlipStep
from stiction.solver.stepping.radau import A, C, D

STAGES = [(np.array(x[:3]), np.array(x[3:])) for x in inside(2, *[(0.5, 2.0)] * 3, *[(-1, 1)] * 3)]
A, C, D = np.array(A), np.array(C), np.array(D)
ALL = pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in MOTIONS[:2]])
H = {"laid over the oscillation": 1.5, "not": 0.02}  # times the root of 1/k_11


def begin(name, drawn, part):
    """Return what a step starts from, and a step size."""
    problem, motion = problem_of(name), motion_of(*drawn)
    frame = plain(slip_frame.frame_of)(problem, motion)
    o = plain(oscillation.oscillator)(frame, plain(slip_frame.outset)(problem, frame))
    h = H[part] / np.sqrt(frame.k_11)
    assert plain(oscillation.swings)(o, h) == (part != "not")
    return problem, frame, o, Printed(problem, motion), h


def stages(problem, frame, o, h, p, w):
    """Return the three stages, and the step."""
    step = SlipStep(plain(oscillation.swing)(o, h, True), h, tuple(p), tuple(w))
    return [plain(collocation.stage)(problem, frame, step, i) for i in range(3)], step


def residuals(*arguments):
    """Return the six residuals."""
    found, _ = stages(*arguments)
    return np.array([*(s.residual_p for s in found), *(s.residual_w for s in found)])


@ALL
@pytest.mark.parametrize("part", H)
@pytest.mark.parametrize(("p", "w"), STAGES)
def test_the_residuals(name, drawn, part, p, w):
    """(M25) to (M29)."""
    problem, frame, o, printed, h = begin(name, drawn, part)
    p, w = p * frame.r, 0.3 * w
    over = np.array([plain(oscillation.after)(o, c * h) for c in C]).T
    R = h * over[1] - D @ (over[0] - frame.r)
    Z = over[2] / h - A @ over[0]
    if part == "not":
        R, Z = 0.0 * R, 0.0 * Z
    z = h * np.array([A @ p + Z, A @ (p * w)])
    b = np.array([printed.b(c * h) for c in C]).T
    a = b - printed.k @ z - printed.c @ [p, p * w]
    speeds = p * np.sqrt(1 + w * w)
    f = np.array([printed.friction(frame.t + c * h, v)[0] for c, v in zip(C, speeds, strict=True)])
    n_1, tau = np.array([printed.friction_direction(each) for each in w]).T
    along = D @ (p - frame.r) + R - h * (a[0] - f * n_1)
    across = p * (D @ w) - h * (a[1] - w * a[0] - f * tau)
    found = residuals(problem, frame, o, h, p, w)
    assert found[:3] == pytest.approx(along, abs=1e-11 * np.abs(along).max())
    assert found[3:] == pytest.approx(across, abs=1e-11 * np.abs(across).max())


@ALL
@pytest.mark.parametrize("part", H)
@pytest.mark.parametrize(("p", "w"), STAGES)
@pytest.mark.parametrize("landing", [False, True])
def test_the_jacobian_is_the_derivative_of_the_residuals(name, drawn, part, p, w, landing):
    """(M31), and (M44) to (M46) in the last column of a landing; by differences.

    The eliminated matrix solves for a vector that the matrix of differences is multiplied with.
    A load that changes is left out of (M44).
    """
    if landing and name in ("program", "spring"):
        problem, frame, o, _, h = begin(name, drawn, part)
        problem = problem._replace(load=problem_of("steady").load)
        o = plain(oscillation.oscillator)(frame, plain(slip_frame.outset)(problem, frame))
    else:
        problem, frame, o, _, h = begin(name, drawn, part)
    x = np.array([*(p * frame.r), *(0.3 * w), h])
    scale = np.array([frame.r] * 3 + [1.0] * 3 + [h])
    columns = []
    for each in 1e-5 * np.diag(scale):
        more, less = (
            residuals(problem, frame, o, y[6], y[:3], y[3:6]) for y in (x + each, x - each)
        )
        columns.append((more - less) / 2e-5)
    if landing:
        columns[2] = columns[6]
    matrix, size = np.transpose(columns[:6]), scale[:6].copy()
    size[2] = h if landing else size[2]
    found, step = stages(problem, frame, o, h, x[:3], x[3:6])
    factors = plain(collocation.factors)(frame, step, landing, *found)
    wanted = np.array([0.3, -0.5, 0.7, 0.2, 0.9, -0.4])
    right = matrix @ wanted
    dp, dw = plain(newton.solve_blocks)(factors, tuple(right[:3]), tuple(right[3:]))
    off = 1e-9 * np.linalg.cond(matrix / np.abs(matrix).max(axis=1, keepdims=True))
    assert np.array([*dp, *dw]) / size == pytest.approx(wanted, abs=off)
