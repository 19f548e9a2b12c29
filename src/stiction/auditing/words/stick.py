"""The share of creep in the apparent stick."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.motion.regime.kinds import HARMONIC, IRREGULAR, STICK_SLIP, TRANSVERSE
from stiction.analysis.motion.rest import HELD, share_held
from stiction.arrays import Floats, Indices
from stiction.auditing.simulated_test import (
    CALM,
    LOADS,
    SLIDES,
    SimulatedTest,
    end_of_loading,
    relative_speed,
)
from stiction.friction import has_state
from stiction.text.quantity.wording import in_words, percent

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

VIBRATES = (HARMONIC, TRANSVERSE, IRREGULAR)  # about steady sliding: nothing creeps
NEVER = 1e-3  # of the time: a smaller share is a matter of samples
FEW_RESTS = 3  # rests in a loading: fewer are not those of a transverse oscillation
ROUGHLY = 2  # digits of a travel, and of a time that it takes
HARDLY = 0.05  # of the time: a smaller share of creep or rest is negligible


def answer(found: Audit) -> str:
    """Return the first sentence of the verdict: static friction, or the apparatus."""
    seen = found.observation
    if seen.blind:
        return "The load cell shows nothing that could be taken for stick."
    if seen.comes_to == LOADS:
        return f"Whether the mass sticks or slips is {no_decision(seen)}."
    if not len(seen.table) and (share := _following(seen)) > 0.5:
        return (
            f"For {percent(share)} of the loading the mass is as fast as the drive to within "
            f"{percent(CALM)}: nothing sticks."
        )
    what, _ = _why(found, _share_of_inertia(found))
    if what:
        return what
    rest, slow = seen.shares.rest, seen.shares.rest + seen.shares.creep
    return (
        f"The mass hardly sticks: it rests for {percent(rest)} {_whole(seen)}, and is slower than "
        f"the drive for {percent(slow)}."
    )


def no_decision(seen: SimulatedTest) -> str:
    """Return that a test ended too early, to end a clause."""
    return f"not determined within {in_words(seen.duration, 's', ROUGHLY)}"


def stick(found: Audit) -> list[str]:
    """Return the share of creep in the apparent stick, in numbers."""
    seen, s = found.observation, found.slider
    if seen.comes_to == LOADS and not seen.blind:
        return [answer(found), _loading(seen)]
    if seen.blind or (not len(seen.table) and _following(seen) > 0.5):
        rises = "The load cell shows a rising force while friction turns."
        turns = s.misalignment and not seen.blind
        return [f"{answer(found)} {rises}" if turns else answer(found)]
    whole = _whole(seen)
    vibrates, inertia = seen.motion in VIBRATES, _share_of_inertia(found)
    slowly = "creeps" if s.misalignment or has_state(s.law) else "slides slowly"
    slowly = "gains or loses speed" if _hastens(seen, inertia) else slowly
    slow = ("rests", seen.shares.rest), (slowly, seen.shares.creep)
    how = " and ".join(f"{verb} for {percent(share)}" for verb, share in slow if share > NEVER)
    lines = [
        f"For {percent(seen.shares.rest + seen.shares.creep)} {whole} the mass is slower than the "
        f"drive, and the load cell shows a rising force{'' if vibrates else f': the mass {how}'}. "
        + _faster(seen)
    ]
    if s.misalignment == 0.0:
        lines.append("There is no misalignment, so friction does not turn.")
    _, details = _why(found, inertia)
    if details:
        lines.append(details)
    if seen.motion == STICK_SLIP:
        lines.append(
            "The apparent kinetic coefficient is the mean of peak and trough. The mass overshoots "
            "in each slip, so the trough alone is not a property of the interface."
        )
    return lines


def _loading(seen: SimulatedTest) -> str:
    """Return the shares of a loading that outlasts the test."""
    its = ("rests", seen.shares.rest), ("moves more slowly than the drive", seen.shares.creep)
    how = " and ".join(f"{verb} for {percent(share)}" for verb, share in its if share > NEVER)
    return f"Until then the springs are loaded, and the mass {how} of the time."


def _hastens(seen: SimulatedTest, inertia: float) -> bool:
    """Return whether the mass is slow for long while it accelerates or decelerates."""
    return inertia > 0.5 * seen.shares.creep


def _whole(seen: SimulatedTest) -> str:
    """Return the reference time of the shares, in words."""
    return "of each cycle" if len(seen.table) else "of the loading"


def _why(found: Audit, inertia: float) -> tuple[str, str]:
    """Return why the mass is slower than the drive for a while, with details.

    Reason and details are empty if that time is too short.
    """
    seen, misaligned = found.observation, found.slider.misalignment != 0.0
    if seen.motion in VIBRATES:
        rests = "it rests for a moment in each swing" if seen.shares.rest else "it never rests"
        return f"The mass vibrates about steady sliding; {rests}.", ""
    if has_state(found.slider.law) and seen.shares.creep > 0.0:
        if not misaligned:
            return "The creep is due to the law of friction.", ""
        return "Friction with internal state creeps by itself.", ""
    moments = _rests_for_moments(seen) if misaligned else ""
    if moments or (misaligned and seen.shares.creep - inertia > seen.shares.rest):
        distance = seen.mean("creep_distance")
        far = (
            f"{in_words(distance, 'm')} before each slip"
            if isfinite(distance)
            else f"{in_words(_moved_while_loaded(seen), 'm')} while the force rises"
        )
        creep = "creep with short rests"
        if seen.shares.creep > seen.shares.rest:
            creep = "mostly creep"
        elif _long_rest(seen):
            creep = "rest, then creep with short rests,"
        before = " before steady sliding" if seen.comes_to == SLIDES else ""
        return (
            f"The apparent stick{before} is {creep} under a turning friction force: an artefact of "
            "the misalignment. The largest force shows how far friction has turned; it is not "
            "evidence of static friction.",
            f"{moments}The mass covers {far}.",
        )
    if _hastens(seen, inertia) and seen.shares.creep > seen.shares.rest:
        return (
            "The drive is too fast for creep: the mass takes as long to gain its speed, and to "
            "lose it, as to swing on its spring.",
            "",
        )
    if seen.shares.rest > HARDLY:
        share = f"it truly sticks for {percent(seen.shares.rest)} {_whole(seen)}"
        return f"The apparent stick is mostly true rest: {share}.", ""
    return "", ""


def _rests_for_moments(seen: SimulatedTest) -> str:
    """Return the sentence that rests are moments between small slips; '' if they last.

    The mass follows the drive across by such slips, and friction turns as in creep without rest.
    """
    loadings = seen.table
    if seen.shares.rest <= HARDLY or not len(loadings):
        return ""
    begin, end = loadings["start"], loadings["peak_time"]
    way = float((end - begin).sum()) * seen.run.slider.motion.rate(0.0)[0]
    way *= seen.run.slider.direction[1]
    of, lengths = _rests_while_loaded(seen)
    if len(of) <= FEW_RESTS * len(loadings):
        return ""
    time, u_y = (seen.run.samples[name] for name in ("time", "u_y"))
    stretched = float((np.interp(end, time, u_y) - np.interp(begin, time, u_y)).sum())
    if share_held(stretched, way) >= HELD:
        return ""
    lasts, long = float(np.median(lengths)), _long_rest(seen)
    each = float(f"{len(of) / len(loadings) - (long > 0.0):.2g}")
    once = f"once for {in_words(long, 's')}, and then " if long else ""
    return (
        f"The mass rests {once}{each:g} times while the spring is loaded, typically for "
        f"{in_words(lasts, 's')}, and follows the drive across by small slips in between. "
    )


def _rests_while_loaded(seen: SimulatedTest) -> tuple[Indices, Floats]:
    """Return the number of the loading in which each rest ends, and its duration, s."""
    begin, end, rests = seen.table["start"], seen.table["peak_time"], seen.run.stick_intervals
    of = np.searchsorted(begin, rests[:, 1], side="right") - 1
    inside = (of >= 0) & (rests[:, 1] <= end[of])
    return of[inside], np.diff(rests[inside], axis=1)[:, 0]


def _long_rest(seen: SimulatedTest) -> float:
    """Return the mean of the longest rests of the loadings, s; zero if it is negligible."""
    loadings = seen.table
    if not len(loadings):
        return 0.0
    longest = np.zeros(len(loadings))
    np.maximum.at(longest, *_rests_while_loaded(seen))
    least = HARDLY * (loadings["peak_time"] - loadings["start"]).mean()
    return float(longest.mean()) if longest.mean() > least else 0.0


def _following(seen: SimulatedTest) -> float:
    """Return the share of the loading in which the mass moves at the drive's speed."""
    speed = relative_speed(seen.run)[: end_of_loading(seen.record.force) + 1]
    return float((np.abs(speed - 1.0) < CALM).mean())


def _moved_while_loaded(seen: SimulatedTest) -> float:
    """Return the mass's displacement until the force is close to its largest value, m."""
    X = seen.run.samples["X"]
    return abs(float(X[end_of_loading(seen.record.force)] - X[0]))


def _faster(seen: SimulatedTest) -> str:
    """Return the duration or the excess of speeds above the drive's."""
    if seen.shares.slip:
        return f"For {percent(seen.shares.slip)} it is faster than the drive."
    fastest = float(np.nanmax(relative_speed(seen.run)))
    if fastest <= 1.0 + HARDLY:
        return "It is never faster than the drive."
    times = float(f"{fastest:.3g}")
    return f"Then it breaks away, and is up to {times:g} times as fast as the drive for a while."


def _share_of_inertia(found: Audit) -> float:
    """Return the share of a cycle in which the mass accelerates or decelerates.

    By (E7) of docs/explanation/estimates.md.
    """
    period = found.observation.mean("period")
    return min(0.5 / (found.prediction.f_x * period), 1.0) if isfinite(period) else 0.0
