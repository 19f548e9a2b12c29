"""The parts of the drive's work, against closed forms and the solver's tolerance."""

from itertools import pairwise
from math import pi

import numpy as np
import pytest
from benchmarks.accuracy.energy import balance
from benchmarks.explore.systems.seismic import seismic_system
from benchmarks.explore.systems.set_valued import system

import stiction as st
from stiction.analysis.quadrature import GAUSS, KRONROD, NODES, integrals, panels
from stiction.plotting.analysis.energy import ENERGY_TERMS, plot_energy
from stiction.plotting.page.canvas import figure_of
from stiction.solver.accuracy import tolerance

PROGRAM = st.protocols.DriveProgram(
    velocity=1e-3,
    program=[
        st.protocols.Constant(duration=0.1),
        st.protocols.Ramp(3e-3, 0.1),
        st.protocols.Step(-1e-3, 0.1),
        st.protocols.Step(2e-3),
    ],
    along=st.protocols.Modulation(2e-4, 30.0),
    across=st.protocols.Modulation(1e-4, 70.0),
)


def closure(budget) -> tuple[float, float]:
    """Residual and bound of the quadrature, as shares of all that is exchanged."""
    total = budget.sum("interval")
    parts = ("work", "friction_x", "friction_y", "spring_x", "spring_y", "kinetic")
    exchanged = sum(abs(float(total[name])) for name in parts)
    return abs(float(total["residual"])) / exchanged, float(total["quadrature"]) / exchanged


def test_the_quadrature_is_of_the_order_that_its_authors_say():
    for rule, degree in ((KRONROD, 22), (GAUSS, 13)):
        powers = NODES[None, :] ** np.arange(degree + 2)[:, None] @ rule
        exact = 1.0 / np.arange(1, degree + 3)
        assert powers[:-1] == pytest.approx(exact[:-1], rel=1e-14)
    assert pytest.approx(1 / 41, rel=1e-12) != KRONROD @ NODES**40


def test_panels_break_where_sticks_and_programs_do(slider):
    program = st.protocols.DriveProgram(
        program=[st.protocols.Step(1e-3, 0.031), st.protocols.Step(2e-3)]
    )
    run = st.simulate(slider.replace(drive=program), 0.05)
    starts, lengths = panels(run, np.array([0.0, 0.02, 0.05]))
    assert starts[1:] == pytest.approx((starts + lengths)[:-1], abs=1e-16)
    for edge in (0.02, 0.031, *run.stick_intervals[run.stick_intervals < 0.05].ravel()):
        assert np.abs(starts - edge).min() < 1e-12
    middle, (begin, end) = starts + 0.5 * lengths, run.stick_intervals.T
    slipping = ~((begin[:, None] < middle) & (middle < end[:, None])).any(axis=0)
    period = 2 * pi * np.sqrt(slider.mass / slider.k_y)
    assert 0.0 < lengths[slipping].max() <= period < lengths.max()


def test_poor_panels_are_split_until_the_bound_is_met(slider):
    run = st.simulate(slider.replace(drive=st.ConstantVelocity(0.0)), 1.0)
    edges = np.array([0.0, 0.3, 1.0])
    found = integrals(run, edges, lambda t, rows: np.stack([np.abs(t - 0.41) ** 0.5, t]), 1e-6, 2)
    root = (0.41**1.5 - 0.11**1.5, 0.11**1.5 + 0.59**1.5)
    assert found.value[0] == pytest.approx(np.array(root) * 2 / 3, abs=found.error[0].max())
    assert found.error.sum() < 1e-6
    assert found.value[1] == pytest.approx([0.045, 0.455], rel=1e-13)


@pytest.mark.parametrize("driven", ["plate", "spring"])
@pytest.mark.parametrize("changes", [{}, {"c_x": 1.0, "c_y": 20.0, "drive": PROGRAM}])
def test_the_budget_closes_to_the_tolerance(slider, driven, changes):
    off = []
    for rtol in (1e-4, 1e-8):
        run = st.simulate(slider.replace(driven=driven, **changes), 0.4, rtol=rtol)
        budget = st.analysis.energy_budget(run)
        residual, quadrature = closure(budget)
        assert (np.abs(budget["residual"]) <= budget["bound"]).all()
        # the work comes, goes into friction and springs, and some of the springs' goes on
        assert float(budget["bound"].sum()) < 4 * tolerance(rtol) * float(budget["work"].sum())
        assert quadrature < 2 * rtol  # bounds of several quantities add up
        off.append(residual)
    assert off[1] < 0.1 * off[0]


@pytest.mark.parametrize("shaken", [None, st.protocols.Modulation(1e-10, 1.0)])
def test_friction_that_turns_over_between_two_points_in_time_is_not_missed(shaken):
    """Slip all but vanishes and comes back within a thousandth of a panel, beside its end."""
    slider = st.Slider(
        mass=1.0,
        k_x=5788.940616492286,
        k_y=680766.6468494682,
        phi="0.0685 deg",
        normal_load=10.0,
        friction=st.Coulomb(0.2),
        drive=st.protocols.DriveProgram(velocity=0.1, along=shaken),
    )
    start = st.Initial(u_x=0.0023521650501143734, v_x=0.0, v_y=0.0)
    budget = st.analysis.energy_budget(
        st.simulate(slider, 0.4954862093524758, initial=start, rtol=1e-7)
    )
    assert abs(float(budget["residual"][0])) < float(budget["bound"][0])


def test_a_plate_that_jumps_and_is_shaken_works_on_each_interval(slider):
    """Jumps lie on edges of intervals, between them, and at the end of the last."""
    program = [
        st.protocols.Step(3e-3, 0.02),
        st.protocols.Step(-1e-3, 0.03),
        st.protocols.Ramp(2e-3, 0.05),
        st.protocols.Step(1e-3),
    ]
    drive = st.protocols.DriveProgram(program=program, along=st.protocols.Modulation(5e-4, 40.0))
    run = st.simulate(slider.replace(drive=drive, c_x=1.0), 0.12)
    for edges in ([0.0, 0.02, 0.04, 0.1], [0.01, 0.05, 0.07, 0.1, 0.12]):
        budget = st.analysis.energy_budget(run, edges)
        assert (np.abs(budget["residual"]) <= budget["bound"]).all()
        assert (budget["bound"] < 1e-3 * np.abs(budget["work"])).all()


def test_a_changing_load_does_no_work(slider):
    load = st.protocols.LoadProgram(modulation=st.protocols.Modulation(1.0, 7.0))
    run = st.simulate(slider.replace(load=load), 0.4)
    assert closure(st.analysis.energy_budget(run))[0] < 1e-6


@pytest.mark.parametrize("driven", ["plate", "spring"])
def test_bristles_close_as_well(slider, driven):
    system = slider.replace(driven=driven, friction=st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 30.0))
    off = [
        closure(st.analysis.energy_budget(st.simulate(system, 0.4, rtol=rtol)))[0]
        for rtol in (1e-4, 1e-8)
    ]
    assert off[1] < tolerance(1e-8)
    assert off[1] < 0.1 * off[0]


RARE = st.Slider(
    mass=1.13e-5, k_x=440.0, k_y=660.0, phi="0 deg", normal_load=1.787,
    friction=st.laws.RateStateSlip(mu_star=0.79, a=0.004, b=0.0068, D_c=8.4e-6, V_star=1.5e-6),
    drive=st.ConstantVelocity(1e-9), driven="spring",
)  # fmt: skip


@pytest.mark.parametrize("duration", [3.25e6, 4e6, 6e6])
def test_a_slip_of_a_millionth_of_the_run_is_not_missed(duration):
    """It lay between all nodes of equal panels: 99 % of the work was in the residual."""
    start = st.Initial(v_x=1e-9, v_y=0.0)
    run = st.simulate(RARE, duration, rtol=1e-7, sample_rate=0, initial=start)
    budget = st.analysis.energy_budget(run, duration * np.array([0.0, 0.3, 0.77, 1.0]))
    assert (np.abs(budget["residual"]) <= budget["bound"]).all()
    assert float(budget["bound"].sum()) < 1e-4 * float(budget["work"].sum())


def test_a_layer_after_a_jump_of_the_load_is_not_missed():
    """Slip relaxes in a millionth of the time in which the contacts do."""
    law = st.laws.RateStateAgeing(mu_star=0.486, a=0.0103, b=0.0073, D_c=2e-5, V_star=6.6e-7)
    levels = [st.protocols.Constant(4.2e5, 97234.0), st.protocols.Constant(2.17e5, 28700.0)]
    slider = st.Slider(
        mass=2.7, k_x=1e9, k_y=1e10, phi="0 deg", normal_load=4.2e5, c_x=7e3, c_y=7e3,
        friction=law, drive=st.ConstantVelocity(6.5e-9), driven="spring",
        load=st.protocols.LoadProgram(program=levels),
    )  # fmt: skip
    start = st.Initial(v_x=6.5e-9, v_y=0.0)
    run = st.simulate(slider, 125934.0, sample_rate=0, initial=start)
    (budget,) = np.abs(st.analysis.energy_budget(run)[["residual", "bound"]].to_array()).T.values
    assert budget[0] <= budget[1] < 1e-2


@pytest.mark.parametrize(
    ("draw", "number", "delta"),
    [(seismic_system, 22, None), (seismic_system, 42, None), (seismic_system, 47, None),
     (system, 23, 1e-3)],
)  # fmt: skip
def test_slips_close_in_any_interval(draw, number, delta):
    """After 1e5 years a step is some roundings of the time; or springs swing on after a slip."""
    drawn = draw(92 if delta is None else 94, number)
    smoothed = None if delta is None else delta * drawn.slider.drive.velocity
    run = st.simulate(
        drawn.slider, drawn.duration, rtol=drawn.rtol, sample_rate=0, regularisation=smoothed
    )
    inside = drawn.duration * np.random.default_rng(number).random(4)
    edges = np.sort([0.0, *inside, drawn.duration])
    budget = st.analysis.energy_budget(run, edges)
    assert (np.abs(budget["residual"]) <= budget["bound"]).all()


def test_intervals_add_up_to_the_whole(paper_run):
    whole = st.analysis.energy_budget(paper_run).sum("interval")
    parts = st.analysis.energy_budget(paper_run, [0.0, 0.7, 1.9, 3.2, 5.0]).sum("interval")
    for name in ("work", "friction_x", "friction_y", "spring_x", "spring_y"):
        assert float(parts[name]) == pytest.approx(float(whole[name]), abs=1e-6 * 6.83e-3)


def test_it_agrees_with_the_balance_of_the_benchmarks(slider):
    """That one has another quadrature, and the spring driven."""
    system = slider.replace(c_x=1.0, c_y=20.0, driven="spring")
    found = st.analysis.energy_budget(st.simulate(system, 0.1, rtol=1e-9)).sum("interval")
    known = balance(system, 0.1, 1e-9)
    work = known.work[-1]
    assert float(found["work"]) == pytest.approx(work, rel=1e-8)
    friction = float(found["friction_x"] + found["friction_y"])
    assert friction == pytest.approx(known.friction[-1], abs=1e-8 * work)
    assert float(found["damper_x"] + found["damper_y"]) == pytest.approx(known.damper[-1], rel=1e-6)


def test_a_first_stick_stores_all_work_in_the_springs(slider):
    """K u = K v_d t: energy |k v^2| t^2/2 in each spring, and nothing anywhere else."""
    budget = st.analysis.energy_budget(st.simulate(slider.replace(driven="spring"), 0.011)).sum()
    V, (c, s) = 1e-3, slider.direction
    stored = [0.5 * k * (V * n * 0.011) ** 2 for k, n in ((slider.k_x, c), (slider.k_y, s))]
    # it starts with a slip of 1e-9 m/s that lasts 1e-10 s
    assert float(budget["spring_x"]) == pytest.approx(stored[0], rel=1e-8)
    assert float(budget["spring_y"]) == pytest.approx(stored[1], rel=1e-8)
    assert float(budget["work"]) == pytest.approx(sum(stored), rel=1e-8)
    assert abs(float(budget["friction_x"] + budget["friction_y"])) < 1e-12 * sum(stored)


def test_free_oscillation_loses_what_its_swings_lose():
    """Friction takes F times the way slid; each swing is 2 F/k shorter than that before it."""
    slider = st.Slider(
        mass=1.0, k_x=1.0, k_y=1.0, phi="0 deg", normal_load=1.0, friction=st.Coulomb(1.0)
    )
    start = st.Initial(u_x=-12.0, v_x=-6.0, v_y=0.0)
    budget = st.analysis.energy_budget(st.simulate(slider, 30.0, initial=start, rtol=1e-10)).sum()
    swings = [13.317821 - 2.0 * n for n in range(8)]  # the last ends before the middle
    slid = (swings[0] - 12.0) + sum(a + b for a, b in pairwise(swings))
    assert float(budget["friction_x"]) == pytest.approx(slid, abs=1e-5)  # digits of 13.317821
    assert float(budget["work"]) == 0.0


def test_a_run_that_broke_off_and_one_read_back_have_a_budget(slider, tmp_path):
    run = st.simulate(slider, 5.0, max_steps=3000)
    assert not run.status.ok
    assert closure(st.analysis.energy_budget(run))[0] < 1e-6
    again = st.analysis.energy_budget(st.load(run.save(tmp_path / "run.nc")))
    np.testing.assert_array_equal(again["work"], st.analysis.energy_budget(run)["work"])


def test_edges_outside_the_run_or_out_of_order_are_refused(slider):
    run = st.simulate(slider, 0.01)
    with pytest.raises(st.ResultError, match=r"the run goes from 0 s to 0\.01 s, the edges from"):
        st.analysis.energy_budget(run, [0.0, 0.02])
    with pytest.raises(st.ResultError, match="two times or more that ascend"):
        st.analysis.energy_budget(run, [0.01, 0.0])


def test_the_figure_says_what_is_drawn(slider):
    budget = st.analysis.energy_budget(st.simulate(slider.replace(c_x=1.0), 0.1), [0.0, 0.05, 0.1])
    upper, lower = figure_of(plot_energy, budget).axes
    assert upper.get_ylabel() == "energy (µJ)"
    assert lower.get_xlabel() == "time $t$ (ms)"
    _, labels = upper.get_legend_handles_labels()
    assert {"work of the drive", "friction, $y$", "spring, $x$"} <= set(labels)
    heights = [bar.get_height() for each in upper.containers for bar in each]
    parts = [budget[name].values for name in ENERGY_TERMS]
    assert sum(heights) == pytest.approx(1e6 * np.sum(parts), rel=3e-3)  # small ones are left out


def test_bars_end_below_the_frame():
    """A part of no height on top of a bar was a bound of the axis."""
    import xarray as xr

    parts = {name: ("interval", np.zeros(2)) for name in ENERGY_TERMS}
    parts |= {"friction_x": ("interval", [1.0, 0.3]), "spring_y": ("interval", [0.0, 0.1])}
    work = {name: ("interval", [1.0, 0.4]) for name in ("work", "residual", "bound")}
    times = {"start": ("interval", [0.0, 1.0]), "end": ("interval", [1.0, 1.5])}
    top, _ = figure_of(plot_energy, xr.Dataset({**parts, **work}, times)).axes
    assert top.get_ylim()[1] > 1.02


@pytest.mark.filterwarnings("error")
def test_one_sample_is_drawn_but_has_no_energy_budget(slider):
    one = st.simulate(slider, "50 ms", sample_rate=0.1)
    one.plot()
    with pytest.raises(st.ResultError, match="one sample, at 0 s"):
        st.analysis.energy_budget(one)
