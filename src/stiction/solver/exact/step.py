"""One accepted step of slip: prediction, collocation, error control."""

from __future__ import annotations

from math import inf

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import SlipStep
from stiction.solver.exact.error_estimate import dips, local_error, moving
from stiction.solver.exact.newton import solve
from stiction.solver.exact.oscillation import Oscillator, oscillator, still, swing, within_reach
from stiction.solver.exact.predictor import passes, predict, swung_to_rest, time_to_landing
from stiction.solver.exact.slip_frame import Frame, Outset
from stiction.solver.problem import Problem, varies
from stiction.solver.state import Memory, size_to_try
from stiction.solver.stepping.control import ATTEMPTS, FAILED, RESOLUTION, step_factor
from stiction.solver.stepping.limit import Limit, Time, limit_there, within_limit

ROUNDING_OF_TIME = 1e-15  # of the time: a landing so close to the end of the segment is at its end
DIRECT, EVEN_STEPS = 1.1, 0.55  # of the time to landing: land at once, or in two even steps
# of the slip, at the first two stages: a first guess where a step turns out to land
LANDING_FIRST, LANDING_SECOND = 0.5, 0.2


@inlined
def step(
    problem: Problem,
    frame: Frame,
    start: Outset,
    t_stop: float,
    memory: Memory,
    accuracy: Accuracy,
) -> tuple[bool, bool, SlipStep, float, Limit, int, int]:
    """Take one step of slip, as long as the tolerance and `t_stop` allow.

    Returns
    -------
    done : bool
        False if even the shortest step fails.
    landing : bool
        Whether the step ends at zero slip.
    taken : SlipStep
    error : float
        Over tolerance.
    limit
        Of steps about steady sliding.
    rejected, iterations : int
    """
    o, (motion, apart) = oscillator(frame, start), moving(problem, frame, start, accuracy)
    t, size = frame.t, min(size_to_try(memory), accuracy.longest)
    at = Time(t, t_stop - t, varies(problem))
    limit = limit_there(memory.limit, size, at, apart, motion, frame.r, accuracy)
    h = within_reach(o, within_limit(size, limit), accuracy, motion)
    h, landing = size_before_landing(problem, frame, start, o, h)
    may_land = frame.r > 0.0
    rejected = iterations = 0
    warm = False
    p = w = (0.0, 0.0, 0.0)
    taken = SlipStep(still(), h, p, w)
    for _ in range(ATTEMPTS):
        if h >= t_stop - t and not warm:
            h, landing = t_stop - t, False
        elif not h > RESOLUTION * abs(t):
            break
        s = swing(o, h, landing)
        if not warm:
            p, w = predict(frame, start, o, s, h, memory)
        if landing:
            p = (p[0], p[1], 0.0)
        tried, warm = h, False
        taken = SlipStep(s, h, p, w)
        converged, taken, count = solve(problem, frame, o, taken, landing, accuracy, motion)
        _, h, p, w = taken
        iterations += count
        if converged and landing and t + h > t_stop + ROUNDING_OF_TIME * abs(t_stop):
            h, landing, may_land = t_stop - t, False, False
            continue
        if converged and not landing and p[2] < 0.0 and may_land:
            h *= frame.r / (frame.r - p[2])
            p = LANDING_FIRST * frame.r, LANDING_SECOND * frame.r, 0.0
            landing, warm = True, True
            continue
        factor = FAILED
        if converged and min(p) >= 0.0:
            relative = local_error(problem, frame, o, taken, accuracy, motion)
            error = relative / accuracy.tolerance
            # a slip as small as its error may have been zero
            least = 0.0 if landing else relative * min(accuracy.speed + frame.r, motion)
            if error > 1.0:
                factor = step_factor(error, 1.0)
            elif not dips(o, taken, frame.r, least):
                return True, landing, taken, error, limit, rejected, iterations
        rejected += 1
        if landing:  # try once: shorter steps approach a landing that is too far away
            may_land = False
        h, landing = min(h, tried) * factor if h > 0.0 else tried * factor, False
    return False, False, taken, inf, limit, rejected, iterations


@inlined
def size_before_landing(
    problem: Problem, frame: Frame, start: Outset, o: Oscillator, h: float
) -> tuple[float, bool]:
    """Return the size of a step, `h` or up to where the slip may land, and whether it is to land.

    It lands unless two even steps are better than a long and a short one, or slip passes by zero.
    """
    until = inf if frame.r == 0.0 else time_to_landing(frame, start, o, h)
    if not EVEN_STEPS * until < h:
        return h, False
    rest = swung_to_rest(o, until)
    if h < DIRECT * until or passes(problem, frame, o, rest):
        return EVEN_STEPS * until, False
    return rest, True
