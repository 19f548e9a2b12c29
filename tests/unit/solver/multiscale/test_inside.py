"""The motion inside cycles of a patch, interpolated in the angle and in the phase."""

from math import factorial

import numpy as np
import pytest
from numpy.polynomial import Chebyshev
from scipy.interpolate import barycentric_interpolate
from tests.entry import map_of, plain
from tests.unit.solver.exact.test_step import held_to
from tests.unit.solver.multiscale.test_construction import EXACT, problem_of, taking_off

from stiction.solver.multiscale import construction, inside, interpolant, replay
from stiction.solver.multiscale.interpolant import POINTS
from stiction.solver.multiscale.return_map import NEAR, PAST, PHASES, SLIP_COLUMNS, Stick

PROBLEM = problem_of("soft")


def motion(x, phase):
    """Return a made-up motion: smooth in the angle and in the phase, another in each column."""
    c = np.arange(1.0, SLIP_COLUMNS + 1)
    row = np.cos(c + 0.7 * x * phase) + 0.2 * np.exp(0.4 * x) * np.sin(2.0 * phase + c)
    return np.append(row, 0.0)  # no stick


def known_of(pieces):
    """Return a map with a patch of this motion, and the error at each node."""
    known, errors = map_of(1e-6, samples=True), []
    known.inside.bound[:] = 1e-9
    known.inside.shapes[0] = pieces, 0, 1, 0
    for n in range(24):
        for p in range(pieces):
            for m in range(PHASES):
                phase = plain(inside.phase_of)(p, pieces, inside.PHASE[m])
                known.inside.points[p * PHASES + m] = motion(POINTS[n], phase)
        errors.append(plain(inside.added_motion)(known.inside, n, pieces))
        if errors[-1] < 1.0:
            known.inside.shapes[0, 1] = n + 1
            break
    plain(inside.finish_motion)(known)
    return known, errors


@pytest.mark.parametrize(("pieces", "off"), [(1, 1e-5), (3, 2e-8)])
def test_a_motion_is_interpolated_in_angle_and_phase(pieces, off):
    known, errors = known_of(pieces)
    assert 5 < len(errors) < 16
    assert errors[0] > 1e6 * errors[-1]
    assert known.inside.spans[PAST, 1] == pieces  # where the next patch begins
    times = 4.0 + 2.0 * np.array([0.0, 0.1, 0.34, 0.5, 0.71, 1.0, 1.01])
    samples = np.full((7, 7), np.nan)
    assert plain(inside.write_cycle)(known, 0, 0.37, 4.0, 6.0, times, samples, 0) == 6
    assert np.isnan(samples[6]).all()
    wanted = np.array([motion(0.37, phase) for phase in (times[:6] - 4.0) / 2.0])
    assert samples[:6] == pytest.approx(wanted, abs=off)


def test_the_polynomials_of_a_piece_are_the_printed_ones():
    """(M59a): Lagrange's in the phase, through values interpolated in the angle."""
    known, errors = known_of(1)
    phases = np.array([plain(inside.phase_of)(0, 1, y) for y in inside.PHASE])
    values = np.array([[motion(x, phase) for phase in phases] for x in POINTS[: len(errors)]])
    samples, at = np.zeros((3, 7)), np.array([0.1, 0.5, 0.93])
    plain(inside.write_cycle)(known, 0, 0.37, 0.0, 1.0, at, samples, 0)
    wanted = barycentric_interpolate(
        phases, barycentric_interpolate(POINTS[: len(errors)], values, 0.37), at
    )
    assert samples == pytest.approx(wanted, rel=1e-9, abs=1e-9)  # of some roundings, eight terms


def test_the_points_of_a_piece_and_its_ends():
    """Polynomials of degree seven are exact, between the points and at both ends."""
    basis = Chebyshev.basis(PHASES - 1)
    values = basis(inside.PHASE)
    assert inside.ENDS @ values == pytest.approx([-1.0, 1.0], abs=1e-12)
    found = np.polyval((inside.MONOMIALS @ values)[::-1], 0.3)
    assert found == pytest.approx(basis(0.3), abs=1e-12)


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
def test_pieces_resolve_a_swing_to_the_tolerance(rtol):
    """2 (a/2)^n/n! is left of cos(a x), behind n polynomials of Chebyshev."""
    closing, s = map_of(rtol).closing, PROBLEM.system
    period = 2 * np.pi / np.sqrt(s.k_y / s.mass)
    pieces = plain(inside.resolution)(PROBLEM, period, closing)
    few = pieces, max(pieces - 1, 0.5)
    left = [2 * (0.5 * np.pi / n) ** PHASES / factorial(PHASES) for n in few]
    assert left[0] <= NEAR * closing < left[1]


def test_a_motion_of_too_few_pieces_begins_again():
    """Where the first node was resolved and a later one was not."""
    known = map_of(1e-6, samples=True)
    begin, shape = plain(inside.begin_finer), known.inside.shapes[0]
    known.inside.missed[0] = 3.0
    for shape[:3], again in (
        ((3, 0, 0), True),
        ((3, 0, 1), False),
        ((3, 7, 0), False),
        ((0, 0, 0), False),
    ):
        assert begin(known) == again
        assert shape[2] == (1 if again else shape[2])
    assert np.isinf(known.inside.missed[0])


def test_a_node_whose_motion_is_not_resolved_asks_for_twice_the_pieces(monkeypatch):
    """Of the patches to come, up to four times those that a swing needs."""
    known, add = map_of(1e-4, samples=True), plain(inside.add_node)
    window = inside.Window(0.0, 2 * np.pi / np.sqrt(PROBLEM.system.k_y / PROBLEM.system.mass))
    few = plain(inside.resolution)(PROBLEM, window.duration, known.closing)
    for times in (2, 4, 4):
        known.inside.shapes[0] = few, 0, 1, 0
        monkeypatch.setitem(add.__globals__, "resolved_pieces", lambda *_: 0)
        add(PROBLEM, EXACT, known, 3, window)
        add(PROBLEM, EXACT, known, 4, window)  # which is left out
        assert known.inside.shapes[0].tolist() == [few, 0, 0, 0]
        assert known.inside.finer[0] == times
    monkeypatch.setitem(
        add.__globals__, "resolved_pieces", lambda *_: int(known.inside.shapes[0, 0])
    )
    monkeypatch.setitem(add.__globals__, "added_motion", lambda *_: 1e6)
    add(PROBLEM, EXACT, known, 0, window)
    assert known.inside.shapes[0].tolist() == [min(4 * few, 16), 0, 1, 0]


@pytest.mark.parametrize(
    ("misses", "nodes"), [([1e6, 9.9, 0.9], 3), ([1e6, 10.1, 0.9, 0.9], 4), ([1e6, 9.0, 1.1], 0)]
)
def test_when_the_motion_inside_a_patch_is_known(misses, nodes, monkeypatch):
    """Where a node is predicted, and the one before it was missed by less than ten times more."""
    known, add, left = map_of(1e-4, samples=True), plain(inside.add_node), iter(misses)
    known.inside.shapes[0], known.inside.missed[0] = (2, 0, 1, 0), np.inf
    monkeypatch.setitem(add.__globals__, "resolved_pieces", lambda *_: 2)
    monkeypatch.setitem(add.__globals__, "added_motion", lambda *_: next(left))
    for n in range(len(misses)):
        add(PROBLEM, EXACT, known, n, inside.Window(0.0, 1.0))
    assert known.inside.shapes[0, 1] == nodes


def test_pieces_are_doubled_for_the_first_node_alone(monkeypatch):
    """The others must be resolved by as many as the first."""
    resolved, tried = plain(inside.resolved_pieces), []
    monkeypatch.setitem(resolved.__globals__, "bounds", lambda *_: None)
    monkeypatch.setitem(resolved.__globals__, "evaluate_record", lambda *_: tried.append(_[-1]))
    monkeypatch.setitem(resolved.__globals__, "error_of_phases", lambda *_: 1.0)
    for n, wanted in ((0, [2, 4, 8, 16]), (1, [2]), (5, [2])):
        known = empty()
        known.record.used[0], known.sizes[0] = 9, 3
        known.inside.shapes[3] = 2, 0, 1, 0
        tried.clear()
        assert resolved(PROBLEM, EXACT, known, n, inside.Window(0.0, 1.0)) == 0
        assert tried == wanted


def test_a_patch_that_begins_again_keeps_its_first_node():
    """Where that was resolved."""
    known = map_of(1e-6, samples=True)
    for pieces in (3, 0):
        known.inside.shapes[0], known.inside.missed[0] = (pieces, 0, 0, 0), 3.0
        plain(inside.begin_again)(known)
        assert known.inside.shapes[0].tolist() == [pieces, 0, int(pieces > 0), 0]
        assert np.isinf(known.inside.missed[0])


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_root_of_the_distance_to_an_edge(side):
    """(M59b): from -1 to 1 over the patch; the root of the distance is linear in it."""
    known = map_of(1e-6, samples=True)
    known.inside.ends[0] = side * 1.1, side
    there, back = plain(inside.root_of_place), plain(inside.place_of_root)
    x = np.linspace(-1.0, 1.0, 21)
    z = np.array([there(known, 0, each) for each in x])
    assert z[[0, -1]] == pytest.approx([-1.0, 1.0])
    assert [back(known, 0, each) for each in z] == pytest.approx(x)
    roots = np.sqrt(side * (side * 1.1 - x))
    assert np.polyval(np.polyfit(z, roots, 1), z) == pytest.approx(roots)


def test_where_the_edge_is():
    """Where the square of the time held would vanish, of the patch or of a line through it."""
    known = map_of(1e-6, samples=True)
    known.coefficients[0] = 0.0
    known.patches[0, 2] = 2
    known.coefficients[0, 0, 2], known.coefficients[0, 1, 2] = 2.1e-8, -1e-8  # over 1 + x
    known.inside.ends[0] = np.sqrt(2.1e-8), np.sqrt(0.1e-8)
    plain(inside.begin_at_edge)(known)
    assert known.inside.ends[0] == pytest.approx([1.1, 1.0])
    assert known.inside.shapes[0, 1:3].tolist() == [0, 1]
    known.coefficients[0, 1, 2] = -0.5e-8  # far away
    known.inside.ends[0] = np.sqrt(2.1e-8), np.sqrt(0.5e-8)
    known.inside.shapes[0, 1] = 5  # nodes in the angle, not in the root
    plain(inside.begin_at_edge)(known)
    assert known.inside.ends[0] == pytest.approx([1.625, 1.0])
    assert known.inside.shapes[0, 1:3].tolist() == [0, 1]
    known.inside.ends[0] = np.sqrt(0.5e-8), np.sqrt(2.1e-8)  # at the other end
    plain(inside.begin_at_edge)(known)
    assert known.inside.ends[0] == pytest.approx([-1.625, -1.0])


def test_the_edge_is_where_the_polynomial_vanishes_not_the_line_through_its_ends():
    """Of (1.1 - x)(3 - x), in Newton's form."""
    known, x = map_of(1e-6, samples=True), POINTS[:3]
    squares = (1.1 - x) * (3.0 - x) * 1e-8
    known.coefficients[0] = 0.0
    known.patches[0, 2] = 3
    slopes = np.diff(squares) / np.diff(x)
    known.coefficients[0, :3, 2] = squares[0], slopes[0], (slopes[1] - slopes[0]) / (x[2] - x[0])
    known.inside.ends[0] = np.sqrt([2.1 * 4.0 * 1e-8, 0.1 * 2.0 * 1e-8])
    plain(inside.begin_at_edge)(known)
    # in each iteration what is off falls by NUDGE over the distance of both zeros
    assert known.inside.ends[0] == pytest.approx([1.1, 1.0], abs=1e-9)


@pytest.mark.parametrize("p", range(3))
@pytest.mark.parametrize("c", [0, SLIP_COLUMNS - 1])
def test_the_error_of_pieces_at_their_ends(p, c):
    """What a piece's polynomial misses there, over the bound of its column."""
    known, pieces = empty(), 2
    known.inside.points[: pieces * PHASES + pieces + 1] = 1.0  # constant polynomials
    known.inside.bound[:] = 2.0
    error = plain(inside.error_of_phases)
    assert error(known.inside, pieces) == pytest.approx(0.0, abs=1e-14)
    known.inside.points[pieces * PHASES + p, c] = 0.5
    assert error(known.inside, pieces) == pytest.approx(0.25, rel=1e-13)


def test_bounds_of_errors():
    """Of the springs' forces a share of what friction can hold, of velocities one of the slip."""
    known = map_of(1e-6, samples=True)
    known.inside.points[:9] = 0.0
    known.inside.points[3, 2:4] = 3e-3, -4e-3
    fine = EXACT._replace(tolerance=1e-9)
    plain(inside.bounds)(PROBLEM, fine, known.inside, 9, known.closing)
    share, force, s = max(NEAR * known.closing, 4e-9), 0.2 * 10.0, PROBLEM.system
    found = known.inside.bound
    assert found[:2] == pytest.approx(0.3 * share * force / np.array([s.k_x, s.k_y]))
    assert found[2:4] == pytest.approx([share * (5e-3 + fine.speed)] * 2)
    assert found[4:] == pytest.approx([share * force] * 2)
    plain(inside.bounds)(PROBLEM, fine._replace(tolerance=1e-3), known.inside, 9, known.closing)
    assert known.inside.bound[4] == pytest.approx(inside.ROUGH * 1e-3 * force)


@pytest.mark.parametrize(
    ("name", "theta", "reach", "at_edge"),
    [
        ("soft", 1.2, -0.1, 0),
        ("damped", 1.2, 0.1, 0),
        ("soft", 1.0, 0.5, 0),
        ("soft", 1.3, -0.6, 1),  # in the root of the distance to an edge, by nodes of its own
    ],
)
def test_a_patch_knows_the_motion_inside_its_cycles(name, theta, reach, at_edge):
    """As steps from the same angle find it, within the error to which its nodes agree."""
    problem, known, rtol = problem_of(name), empty(), 1e-4
    held = held_to(1e-3 * rtol)
    begun = taking_off(problem, theta)
    plain(construction.chart)(problem, held, begun, known, theta, reach, 1.0)
    pieces, nodes, first, edge = known.inside.shapes[0]
    assert (known.sizes[0], first, edge) == (1, 0, at_edge)
    assert 3 < nodes < 16
    assert known.inside.spans[PAST, 1] == pieces
    assert np.isfinite(known.inside.points[: pieces * PHASES + pieces + 1, :7]).all()
    for part in (0.0, 0.13, 0.5, 0.87):
        off = miss_inside(problem, held, known, theta + part * reach)
        assert off.max() < 1.0


def test_the_first_node_s_motion_serves_the_next_attempt():
    """At a narrower patch from the same angle, after one that has met an edge."""
    problem, known, held = problem_of("soft"), empty(), held_to(1e-7)
    begun, chart = taking_off(problem, 1.3), plain(construction.chart)
    solve = plain(construction.solve_cycle)
    near, far = (
        solve(problem, held, begun.memory, known, theta, 1.0, 10_000)[1] for theta in (1.3, 0.9)
    )
    longest = 0.5 * (near.time - near.held + far.time - far.held)
    chart(problem, held, begun, known, 1.3, -0.4, longest)
    assert known.sizes.tolist() == [0, 1, 0, 2, 0]
    # as if the motion were known, or nearly: of a narrower patch it is not
    known.inside.missed[0], known.inside.shapes[0, 1] = 0.0, 2
    chart(problem, held, begun, known, 1.3, -0.1, longest)
    assert known.sizes[:2].tolist() == [1, 1]
    assert known.inside.shapes[0, 1] > 3
    assert miss_inside(problem, held, known, 1.26).max() < 1.0


def empty():
    """Return a map with room for samples, where nothing can be read that was not written."""
    known = map_of(1e-4, samples=True)
    for each in known.inside:
        if each.dtype.kind == "f":
            each[:] = np.nan
    return known


def miss_inside(problem, held, known, theta):
    """Return the samples of a slip by a patch less those by steps, over what they may miss."""
    row, x = plain(interpolant.locate)(known, theta)
    cycle = plain(interpolant.cycle_from)(known, row, x)
    landing = 4.0 + cycle.time - cycle.held
    times = np.linspace(4.0, landing, 9)[1:-1]
    found, wanted = np.full((2, 7, 7), np.nan)
    assert plain(inside.write_cycle)(known, row, x, 4.0, landing, times, found, 0) == 7
    stick, state = Stick(3.9, 4.0, theta), taking_off(problem, 0.3, 1.0)
    *_, k = plain(replay.sample_cycle)(
        problem, state, stick, landing, held, times, wanted, 0, map_of(1e-4)
    )
    assert k == 7
    assert not found[:, 6].any()
    return np.abs(found - wanted)[:, :6] / known.inside.bound[:6]


@pytest.mark.parametrize(
    ("used", "duration", "pieces"), [(0, 1.0, 4), (4097, 1.0, 4), (9, 0.0, 4), (9, 1.0, 17)]
)
def test_no_motion_is_told_from_steps_that_were_not_kept(used, duration, pieces):
    """Nor in more pieces than there is room for."""
    known = empty()
    known.record.used[0] = used
    known.inside.shapes[0] = pieces, 0, 1, 0
    window = inside.Window(0.0, duration)
    assert plain(inside.resolved_pieces)(PROBLEM, EXACT, known, 0, window) == 0
