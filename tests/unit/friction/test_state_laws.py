"""Laws with internal state: against SciPy, and themselves.

SciPy integrates equations written down here once more, in the logarithms of slip speed and state
where the motion is in one dimension. Its tolerance is a hundred times tighter than what is asked.
"""

from math import asinh, exp, hypot, log, sqrt
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stiction as st
from stiction.friction import LAWS, has_state, states

PAPER = st.presets.nakano_popov_2020()
KINDS = [kind for kind in LAWS.values() if states(kind)]
AGEING = st.laws.RateStateAgeing(a=0.01, b=0.015, D_c=1e-5, mu_star=0.6, V_star=1e-6)
SLIP = st.laws.RateStateSlip(*AGEING)


def largest(values):
    return np.max(np.abs(values), initial=0.0)


def columns(run, *names):
    return np.array([run.data[name].values for name in names])


# --- slide, hold, slide -------------------------------------------------------------------------

HOLD = st.protocols.DriveProgram(
    velocity=1e-4,
    program=[
        st.protocols.Constant(duration=0.5),
        st.protocols.Hold(duration=20.0),
        st.protocols.Constant(),
    ],
)
TESTED = st.Slider(
    mass=1.0,
    k_x=1e4,
    k_y=1e4,
    phi="0 deg",
    normal_load=10.0,
    friction=AGEING,
    drive=HOLD,
    driven="spring",
)


def slide_hold_slide(law, times):
    """Friction coefficient at `times` by SciPy, in u, ln V and ln(V* theta/D_c)."""
    k, m, W = TESTED.k_x, TESTED.mass, TESTED.normal_load
    ageing = isinstance(law, st.laws.RateStateAgeing)

    def friction(w, z):  # asinh(x) for x far above one
        x = w - log(2 * law.V_star) + (law.mu_star + law.b * z) / law.a
        return law.a * np.where(x > 20, x + log(2), np.arcsinh(np.exp(np.minimum(x, 20))))

    def change(t, y, drive):
        u, w, z = y
        V = exp(w)
        if ageing:
            aged = law.V_star / law.D_c * exp(-z) - V / law.D_c
        else:
            aged = -V / law.D_c * (w - log(law.V_star) + z)
        return [drive - V, (k * u - W * float(friction(w, z))) / (m * V), aged]

    V = HOLD.velocity
    y = [law.coefficient(V) * W / k, log(V), log(law.V_star / V)]
    found = []
    for start, end, drive in ((0.0, 0.5, V), (0.5, 20.5, 0.0), (20.5, times[-1], V)):
        inside = times[(times > start) & (times <= end)]
        grid = np.unique([*inside, end])
        solution = solve_ivp(
            change, (start, end), y, "LSODA", grid, args=(drive,), rtol=1e-12, atol=1e-14
        )
        assert solution.success
        y = solution.y[:, -1]
        found.append(friction(*solution.y[1:, : len(inside)]))
    return np.concatenate(found)


@pytest.mark.parametrize("law", [AGEING, SLIP], ids=["ageing", "slip"])
def test_healing_in_slide_hold_slide(law):
    V = HOLD.velocity
    start = st.Initial(u_x=law.coefficient(V) * 10.0 / 1e4, v_x=0.0, v_y=0.0)
    run = st.simulate(TESTED.replace(friction=law), 21.0, initial=start, sample_rate=1e3, rtol=1e-8)
    assert run.status.ok
    ours = run.data["friction"].values[1:] / 10.0
    theirs = slide_hold_slide(law, run.data["time"].values[1:])
    again = run.data["time"].values[1:] > 20.5
    assert theirs[again].max() > law.coefficient(V) + 0.01  # it has healed
    assert ours[again].max() == pytest.approx(theirs[again].max(), rel=1e-6)
    assert ours == pytest.approx(theirs, rel=1e-6)


# --- two dimensions -----------------------------------------------------------------------------


def lugre(law, s, load, z):
    """Canudas de Wit et al. 1995, with vectors."""
    r = hypot(*s)
    g = load * (law.mu_c + (law.mu_s - law.mu_c) * exp(-((r / law.v_s) ** 2)))
    dz = s - law.sigma_0 * r / g * z
    return law.sigma_0 * z + law.sigma_1 * dz + law.sigma_2 * s, dz


def rate_and_state(law, s, load, z):
    """The regularised coefficient along the slip, with the ageing or the slip law."""
    r = hypot(*s)
    mu = law.a * asinh(r / (2 * law.V_star) * exp((law.mu_star + law.b * z[0]) / law.a))
    x = r / law.V_star * exp(z[0])  # V theta/D_c
    dz = (1 - x) / x if isinstance(law, st.laws.RateStateAgeing) else -log(x)
    return mu * load * s / r, np.array([r / law.D_c * dz])


def integrate_by_scipy(slider, law, times, equations, y0, rtol):
    """u, slip and internal states at `times`, by SciPy."""
    drive = slider.drive.velocity * np.array(slider.direction)
    stiffness = np.array([slider.k_x, slider.k_y])

    def change(t, y):
        u, s, z = y[:2], y[2:4], y[4:]
        f, dz = equations(law, s, slider.normal_load, z)
        return [*(drive - s), *((stiffness * u - f) / slider.mass), *dz]

    solution = solve_ivp(
        change, (0.0, times[-1]), y0, "LSODA", times, rtol=rtol, atol=1e-3 * rtol * np.abs(y0)
    )
    assert solution.success
    return solution.y


CASES = {
    "lugre": (st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 300.0, 0.4), lugre),
    "ageing": (st.laws.RateStateAgeing(0.01, 0.012, 1e-5, 0.2, 1e-3), rate_and_state),
    "slip": (st.laws.RateStateSlip(0.01, 0.012, 1e-5, 0.2, 1e-3), rate_and_state),
}


@pytest.mark.parametrize("name", CASES)
def test_the_papers_apparatus_agrees_with_scipy(name):
    """From sliding aslant at V with a spring half drawn: it slows down, turns, and swings."""
    law, equations = CASES[name]
    slider = PAPER.replace(friction=law, phi="5 deg")
    z = [1e-5, 2e-6] if name == "lugre" else [0.3]
    start = st.Initial(
        u_x=1e-3,
        u_y=1e-8,
        v_x=2e-4,
        v_y=-3e-4,
        states=dict(zip((s.name for s in states(law)), z, strict=True)),
    )
    runs = [
        st.simulate(slider, 0.01, initial=start, sample_rate=5e3, rtol=rtol)
        for rtol in (1e-9, 1e-8)
    ]
    names = ("u_x", "u_y", "slip_x", "slip_y", *(s.name for s in states(law)))
    ours, loose = (columns(run, *names) for run in runs)
    y0 = np.array([1e-3, 1e-8, *start.slip(slider), *z])
    times = runs[0].data["time"].values
    theirs, rough = (
        integrate_by_scipy(slider, law, times, equations, y0, r) for r in (1e-10, 1e-8)
    )
    for k in range(len(names)):
        changes = largest(ours[k] - loose[k]) + largest(theirs[k] - rough[k])
        assert changes <= 1e-5 * largest(ours[k]), "neither has converged"
        assert largest(ours[k] - theirs[k]) <= changes + 1e-12 * largest(ours[k])


# --- every law ----------------------------------------------------------------------------------

FAST = PAPER.replace(drive=st.ConstantVelocity("5 mm/s"), phi="3 deg")


def alike(kind):
    """The system above with a comparable law of this kind."""
    return FAST.replace(friction=kind.like(0.2, 0.15, 0.01))


def internal(run):
    return [s.name for s in states(run.slider.law)]


@pytest.mark.parametrize("kind", KINDS)
def test_error_falls_with_the_tolerance(kind):
    """In proportion to rtol: u_x below it, see `simulate`; states in rapid slip follow later."""
    rtols = tuple(10.0**-p for p in range(5, 11))
    best, *runs = (
        st.simulate(alike(kind), 0.5, sample_rate=1e3, rtol=rtol) for rtol in (1e-13, *rtols)
    )
    assert all(run.status.ok for run in runs)
    for name in ("u_x", *internal(best)):
        scale = largest(best.data[name].values)
        errors = [largest((run.data[name] - best.data[name]).values) / scale for run in runs]
        # by six a decade on average, once the fast oscillation has died out; steps lie elsewhere
        # at each tolerance, by which alone errors differ twofold
        order, _ = np.polyfit(np.log10(rtols), np.log10(errors), 1)
        by_chance = np.log10(2.0) / np.sqrt(len(rtols)) / np.std(np.log10(rtols))
        assert order >= np.log10(6.0) - by_chance, name
        for rtol, error in zip(rtols[1:], errors[1:], strict=True):
            assert error <= (1 if name == "u_x" else 200) * rtol, name


@pytest.mark.parametrize("kind", KINDS)
def test_sampling_does_not_influence(kind):
    coarse = st.simulate(alike(kind), 0.5, sample_rate=100)
    fine = st.simulate(alike(kind), 0.5, sample_rate=10e3)
    names = ("u_x", "u_y", "slip_x", "slip_y", *internal(fine))
    assert np.array_equal(columns(coarse, *names), columns(fine, *names)[:, ::100])
    assert coarse.statistics == fine.statistics


@pytest.mark.parametrize("kind", [st.laws.LuGre, st.laws.RateStateAgeing])
def test_a_restart_goes_on(kind, tmp_path):
    """From a saved and loaded sample: as exact as any run, within the tolerance."""
    slider = alike(kind)
    whole = st.simulate(slider, 0.5, sample_rate=1e3, rtol=1e-9)
    first = st.simulate(slider, 0.3, sample_rate=1e3, rtol=1e-9)
    loaded = st.load(first.save(tmp_path / "first.nc"))
    for name in internal(first):
        assert np.array_equal(loaded.data[name], first.data[name])
        assert loaded.data[name].attrs["long_name"]
        assert loaded.data[name].attrs["units"] == first.data[name].attrs["units"]
    start = loaded.state(0.3)
    assert set(start.states) == set(internal(first))
    second = st.simulate(slider, 0.2, initial=start, sample_rate=1e3, rtol=1e-9)
    for name in ("u_x", *internal(first)):
        a, b = whole.data[name].values[300:], second.data[name].values
        assert largest(a - b) <= 1e-7 * max(largest(a), 1e-9)
    assert st.Description.from_json(second.description.to_json()) == second.description


def test_a_long_hold_creeps_down_to_nothing():
    """Slip decays over decades: d(ln V)/dt < 0 throughout, and V is right on a log axis.

    Without motion friction is a psi-dependent asinh of V, so that V follows from u and z alone.
    """
    run = st.simulate(
        TESTED.replace(drive=st.ConstantVelocity(0.0)),
        1e4,
        sample_rate=1.0,
        initial=st.Initial(u_x=0.5e-3, v_x=0.0, v_y=0.0, states={"log_theta": 0.0}),
    )
    V, z, u = columns(run, "slip_x", "log_theta", "u_x")[:, 1:]
    assert np.all(V > 0.0)
    assert np.all(V < 1e-9)
    law = AGEING
    grip = 2 * law.V_star * np.exp(-(law.mu_star + law.b * z) / law.a)
    wanted = grip * np.sinh(TESTED.k_x * u / (law.a * TESTED.normal_load))
    assert pytest.approx(wanted, rel=1e-5) == V


@pytest.mark.parametrize("kind", KINDS)
def test_a_driven_plate_may_jump(kind):
    """The slip velocity jumps with the plate's; the states and the elongation do not."""
    jumping = st.protocols.DriveProgram(
        velocity=5e-3, program=[st.protocols.Constant(duration=0.1), st.protocols.Step(2e-3)]
    )
    slider = alike(kind).replace(drive=jumping, phi="0 deg")
    run = st.simulate(slider, 0.2, sample_rate=1e6, rtol=1e-8)
    assert run.status.ok
    before, after = run.data.isel(time=100_000), run.data.isel(time=100_001)
    assert before["time"].item() == pytest.approx(0.1, abs=1e-12)
    # friction changes the slip by F/m times 1 us in between, 10 um/s
    jumped = after["slip_x"].item() - before["slip_x"].item()
    assert jumped == pytest.approx(2e-3, abs=1e-5)
    assert after["u_x"].item() == pytest.approx(before["u_x"].item(), abs=1e-8)


# --- descriptions -------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_law_says_of_itself(kind):
    law = kind.like(0.2, 0.15, 0.01)
    assert has_state(law)
    # the Stribeck speed of LuGre is where its coefficient is e^-1 above mu_c
    assert law.coefficient(1e-6) == pytest.approx(0.2, abs=1e-3)
    assert law.coefficient(1e-1) <= 0.15
    sliding = law.settled(1e-3)
    if kind not in (st.laws.LuGre, st.laws.LuGreHyperbolic):  # its steady state depends on the load
        assert law.change((1e-3, 0.0), 1.0, sliding) == pytest.approx(
            [0.0] * len(sliding), abs=1e-12
        )
        f = law.force((1e-3, 0.0), 10.0, sliding)
        assert f == pytest.approx((10.0 * law.coefficient(1e-3), 0.0))
    assert law.force((0.0, 0.0), 10.0, (0.0,) * len(sliding)) == (0.0, 0.0)


def test_a_direct_effect_too_small_for_floats_is_refused():
    """At the smallest one allowed, slip lands through three hundred decades."""
    with pytest.raises(st.DescriptionError, match=r"RateStateAgeing.a: must be at least"):
        st.laws.RateStateAgeing(a=5e-4, b=1e-3, D_c=1e-5, mu_star=0.6, V_star=1e-6)
    law = st.laws.RateStateAgeing(a=1e-3, b=2e-3, D_c=1e-5, mu_star=0.6, V_star=1e-6)
    assert st.simulate(PAPER.replace(friction=law), 5.0).status.ok


def test_states_that_do_not_fit_are_refused():
    slider = alike(st.laws.RateStateAgeing)
    with pytest.raises(st.DescriptionError, match=r"initial.states.theta: .*did you mean"):
        st.simulate(slider, 1.0, initial=st.Initial(states={"theta": 1.0}))
    two = alike(st.laws.RateStateAgeing2)
    with pytest.raises(st.DescriptionError, match=r"initial.states.log_theta_2: missing"):
        st.simulate(two, 1.0, initial=st.Initial(states={"log_theta_1": 1.0}))
    with pytest.raises(st.DescriptionError, match="no internal state"):
        st.simulate(PAPER, 1.0, initial=st.Initial(states={"log_theta": 1.0}))
    with pytest.raises(st.DescriptionError, match=r"run.regularisation: .*smooth"):
        st.simulate(slider, 1.0, regularisation=1e-8)


@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-9])
def test_a_vibration_after_a_long_hold_is_not_stepped_over(rtol):
    """Whole periods fit into one step, whose stages and inside lie at equal phases.

    The same vibration without the hold before it, whose steps start short, is the reference: what
    a hold of that length does to the state is given to it.
    """
    drive = st.protocols.DriveProgram(
        program=[st.protocols.Hold(1e3), st.protocols.Harmonic(1.5e-2, 10.0, "90 deg", 10.0)]
    )
    slider = TESTED.replace(drive=drive)
    start = st.Initial(u_x=5.3e-4, v_x=0.0, v_y=0.0, states={"log_theta": 0.0})
    whole = st.simulate(slider, 1010.0, initial=start, rtol=rtol)
    held = st.simulate(slider, 1e3, initial=start, rtol=1e-10)
    shaken = slider.replace(
        drive=st.protocols.DriveProgram(program=[st.protocols.Harmonic(1.5e-2, 10.0, "90 deg")])
    )
    kept = held.state(1e3).model_dump(exclude_unset=True)
    # over the spring's end nothing slips at once: the elongation rate jumps with the drive
    after = st.Initial(**(kept | {"time": 0.0, "v_x": 1.5e-2, "v_y": 0.0}))
    alone = st.simulate(shaken, 10.0, initial=after, rtol=1e-10)
    wanted = alone.final["u_x"].item()
    assert abs(wanted - 5.3e-4) > 2e-4  # it is shaken loose
    assert whole.final["u_x"].item() == pytest.approx(wanted, rel=10 * rtol)


def test_a_plate_starts_again_after_a_very_long_hold():
    """Steps in a landing may be far below what time resolves at 1e7 s."""
    drive = st.protocols.DriveProgram(
        velocity=1e-3,
        program=[
            st.protocols.Constant(duration=1.0),
            st.protocols.Hold(1e7),
            st.protocols.Constant(),
        ],
    )
    law = st.laws.RateStateSlip.like(0.2, 0.15, 0.01)
    assert st.simulate(PAPER.replace(friction=law, drive=drive), 1e7 + 2).status.ok


class Relaxing(NamedTuple):
    """A user's own law: a friction coefficient that follows its steady value over a distance."""

    mu: float
    distance: float
    viscous: float

    @staticmethod
    def states():
        return (("memory", "1", "friction coefficient remembered"),)

    def coefficient(law, v):
        return law.mu

    def settled(law, speed):
        return (law.mu,)

    def force(law, slip, load, state):
        r = sqrt(slip[0] * slip[0] + slip[1] * slip[1] + 1e-12)
        f = state[0] * load / r + law.viscous
        return f * slip[0], f * slip[1]

    def change(law, slip, load, state):
        r = sqrt(slip[0] * slip[0] + slip[1] * slip[1])
        return (r / law.distance * (law.mu - state[0]),)


class Clashing(Relaxing):
    """An internal state that is called as something else in results."""

    @staticmethod
    def states():
        return (("u_x", "1", "friction coefficient remembered"),)


def test_internal_states_have_names_of_their_own():
    with pytest.raises(st.DescriptionError, match="u_x"):
        st.simulate(PAPER.replace(friction=Clashing(0.2, 1e-4, 0.5)), 0.01)


def test_a_users_law_needs_no_derivatives():
    law = Relaxing(0.2, 1e-4, 0.5)
    start = st.Initial(states={"memory": 0.3})
    run = st.simulate(PAPER.replace(friction=law, phi="20 deg"), 5.0, initial=start, rtol=1e-8)
    assert run.status.ok
    # settled: friction 0.2 W and viscous along X, held by the spring
    assert run.final["memory"].item() == pytest.approx(0.2, abs=1e-4)
    c, s = run.slider.direction
    pull = run.final["spring_x"].item() * c + run.final["spring_y"].item() * s
    assert pull == pytest.approx(2.0 + 5e-4, rel=1e-4)
