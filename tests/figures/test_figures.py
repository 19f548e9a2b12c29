"""Every figure is drawn, and shows its data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from io import BytesIO
from itertools import pairwise
from math import degrees, pi, radians
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.markers import MarkerStyle
from matplotlib.patches import FancyArrowPatch
from matplotlib.path import Path as Outline
from PIL import Image
from tests.drawn import inside
from tests.rigs import SOFT_TESTER

import stiction as st
from stiction import theory
from stiction.analysis.creep.first_slip import first_slip_time, mean_creep_velocity
from stiction.analysis.motion.rest import stuck_until
from stiction.analysis.signals.spectrum import rate_spectrogram, spectrogram
from stiction.arrays import Floats
from stiction.plotting.analysis import overview
from stiction.plotting.analysis.cycles import plot_cycles
from stiction.plotting.analysis.energy import plot_energy
from stiction.plotting.analysis.rotation import TIMES
from stiction.plotting.analysis.trials import Trial, plot_trials
from stiction.plotting.apparatus.schematic import draw_schematic
from stiction.plotting.apparatus.shapes import drawn_misalignment
from stiction.plotting.inference.posterior import ParameterAxis, draw_parameter, panels_of
from stiction.plotting.maps import Side, draw_measure, draw_slice
from stiction.plotting.page.canvas import canvas, figure_of, fix_ticks
from stiction.plotting.page.parameter import Scale, label_decades, use_scale
from stiction.plotting.page.save import png, save, write
from stiction.plotting.page.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    PAGE,
    PURPLE,
    RED,
    lay_out,
    new_figure,
    style,
)
from stiction.plotting.page.words import plain, scales_in_words, system_in_words
from stiction.plotting.run.comparison import plot_comparison
from stiction.plotting.run.law import plot_law
from stiction.plotting.run.lines import draw_line, envelope, mean_course, oscillations
from stiction.plotting.run.overview import GAP, LINE, SERIES, plot_glance, plot_run
from stiction.plotting.run.time_series import UNSEEN, cut_open, draw_slip_speed
from stiction.plotting.shades import COLORS, measure_shades
from stiction.plotting.stability.damping import draw_damping_map
from stiction.reproduction.creep import creep, zero_slip
from stiction.reproduction.figures import figure3, figure4, figure5, schematic
from stiction.reproduction.first_look import first_look
from stiction.text.quantity.prefix import metric_prefix


def draw(fig: Figure) -> Figure:
    """Draw it for real, so that whatever is wrong with it shows."""
    fig.set_dpi(60)
    fig.draw_without_rendering()
    return fig


def words(ax: Axes) -> str:
    return " ".join(text.get_text() for text in ax.texts)


def curve(ax: Axes, index: int = 0) -> Floats:
    return np.asarray(ax.lines[index].get_xydata(), dtype=float)


@pytest.fixture(scope="module")
def fine(paper_run: st.Trajectory) -> st.Trajectory:
    """Four transverse periods in the first stick phase, sampled finely."""
    return st.simulate(
        paper_run.slider, 0.004, sample_rate=2e5, initial=paper_run.state(0.5), rtol=1e-5
    )


def places_of_labels(panels: Sequence[Axes]) -> set[float]:
    """Return where the labels of vertical axes end, in dots."""
    draw(panels[0].get_figure(root=True))
    return {round(ax.yaxis.label.get_window_extent().x1, 3) for ax in panels}


def test_labels_of_panels_above_each_other_are_aligned(
    paper_run: st.Trajectory, fine: st.Trajectory
) -> None:
    """Beside numbers of more digits a label would stand farther away."""
    budget = st.analysis.energy_budget(paper_run)
    overview, compared = overview_axes(paper_run), dict[str, Axes]()
    figure_of(lambda: compared.update(plot_comparison({"a run": paper_run})) or compared)
    named = {ax.get_ylabel(): ax for ax in zero_slip(fine, (0.5, 0.504)).axes}
    for panels in (
        figure3(paper_run).axes,
        figure4(paper_run).axes[:4],
        [named[r"$v_\mathrm{slip}$ (µm/s)"], named["$F$ (N)"]],
        [overview[name] for name in SERIES],
        [compared[name] for name in ("force", "X", "speed", "rest")],
        figure_of(plot_energy, budget).axes,
    ):
        assert len(places_of_labels(panels)) == 1


# --- figures of the paper ---


def test_a_first_look_shows_friction_that_turns_and_no_title_is_cut(
    paper_run: st.Trajectory,
) -> None:
    fig = draw(first_look(paper_run))
    titles = {ax.get_title(loc="left") + ax.get_title(): ax for ax in fig.axes}
    turn = titles["Friction on the mass, from above"]
    arrows = [patch for patch in turn.patches if isinstance(patch, FancyArrowPatch)]
    tips = np.array([patch._posA_posB[1] for patch in arrows])[:-1]  # the last is the drive
    assert len(tips) == 5
    np.testing.assert_allclose(np.hypot(*tips.T), paper_run.slider.F_0, rtol=1e-2)
    angles = np.degrees(np.arctan2(-tips[:, 1], -tips[:, 0]))
    assert (np.diff(angles) < 0.0).all()
    assert angles[0] > 80.0
    assert angles[-1] < 15.0
    window = fig.get_window_extent()
    for ax in fig.axes:
        for text in (ax.title, ax._left_title):
            extent = text.get_window_extent()
            assert not text.get_text() or window.x0 <= extent.x0 <= extent.x1 <= window.x1


def test_figure3_shows_five_quantities_with_units_and_the_creep(paper_run: st.Trajectory) -> None:
    fig = draw(figure3(paper_run))
    labels = [ax.get_ylabel() for ax in fig.axes]
    assert [label.split("(")[1] for label in labels] == ["N)", "N)", "N)", "deg)", "mm)"]
    assert fig.axes[-1].get_xlabel() == "time $t$ (s)"
    assert fig.axes[0].get_xlim() == (0.0, 5.0)
    force = curve(fig.axes[0])
    assert force[:, 1].max() == pytest.approx(1.9926, abs=1e-3)  # the peak outlives thinning
    (inset,) = fig.axes[-1].child_axes
    assert "µm" in inset.get_ylabel()
    assert 20 < curve(inset)[:, 1].max() < 50  # creep of tens of um before slip, not mm


def test_figure4_shows_the_falling_frequency(paper_run: st.Trajectory) -> None:
    fig = draw(figure4(paper_run))
    names = [ax.get_ylabel() for ax in fig.axes[:4]]
    assert names == ["$v_x$ (mm/s)", "frequency (kHz)", "$v_y$ (µm/s)", "frequency (kHz)"]
    assert fig.axes[4].get_xlabel() == "amplitude (dB re 1 µm/s)"
    (marked,) = (line for line in fig.axes[3].lines)
    assert marked.get_ydata()[0] == pytest.approx(1.0066, abs=1e-3)
    assert "omega_y" in words(fig.axes[3])


@pytest.mark.parametrize("axis", ["x", "y"])
def test_spectrum_starts_at_the_natural_frequency_and_falls(
    paper_run: st.Trajectory, axis: str
) -> None:
    found = rate_spectrogram(paper_run, axis).sel(frequency=slice(200.0, None)).idxmax("frequency")
    at = [float(found.sel(time=time, method="nearest")) for time in (0.1, 0.5, 1.0, 1.5, 1.8)]
    assert at[0] == pytest.approx(1006.6, abs=10)
    assert all(np.diff(at) < 0)
    assert at[-1] < 500


def test_figure5_has_its_cross_where_zeta_is_one(slider: st.Slider) -> None:
    fig = draw(figure5(slider))
    (ax,) = fig.axes
    crosses = [line for line in ax.lines if line.get_marker() == "x"]
    assert len(crosses) == 1  # none for 10 deg
    np.testing.assert_allclose(crosses[0].get_xydata(), [(3623.9, 3.733)], rtol=1e-4)
    ends = [curve(ax, index)[-1] for index in (0, 3)]
    assert [end[1] for end in ends] == pytest.approx([1.0, 10.0])
    assert ax.get_xlabel().endswith("(1)")
    assert ax.get_ylabel().endswith("(deg)")


def test_kinds_of_motion_are_told_apart_in_a_print_without_colour() -> None:
    """Stick-slip and transverse oscillation, half a map each, were the same grey.

    Patches that do not touch are told apart from a difference of about 5 in CIE lightness on.
    """
    colors = np.array([mpl.colors.to_rgb(each) for each in COLORS.values()])
    linear = np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)  # sRGB
    lightness = 116.0 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16.0
    assert np.diff(np.sort(lightness)).min() > 5.0


def test_the_boundary_of_the_damping_map_is_the_critical_angle() -> None:
    ax = new_figure(3, 3).subplots()
    (path,) = draw_damping_map(ax).get_paths()
    A, theta = path.vertices.T
    inside = A > 1.01
    np.testing.assert_allclose(
        theta[inside], np.degrees(theory.critical_angle(A[inside])), rtol=2e-3
    )


@pytest.mark.parametrize("change", [{"phi": "0 deg"}, {"drive": st.ConstantVelocity(0.0)}])
def test_what_has_no_damping_number_is_refused(
    slider: st.Slider, change: dict[str, object]
) -> None:
    with pytest.raises(ValueError, match="needs a drive and a misalignment"):
        figure5(slider.replace(**change))


# --- beyond the paper ---


def test_zero_slip_shows_rests_inside_the_circle(fine: st.Trajectory) -> None:
    fig = draw(zero_slip(fine, (0.5, 0.504)))
    speed, circle, arc, force = fig.axes
    assert speed.get_ylabel().endswith("(µm/s)")
    assert len(speed.collections[0].get_paths()) == 4  # shaded once each oscillation
    time, slip = curve(speed).T
    for start, end in (fine.stick_intervals - 0.5) * 1e3:
        inside = (time > start + 0.005) & (time < end - 0.005)
        assert np.all(slip[inside] == 0)
    friction = curve(force)[:, 1]
    assert friction.min() < 1.99
    assert friction.max() == pytest.approx(2.0, abs=1e-4)
    stick = curve(arc, 1)
    radius = np.hypot(*stick[np.isfinite(stick).all(axis=1)].T)
    assert radius.max() <= 2.0 + 1e-9
    assert radius.min() < 1.99
    assert circle.get_xlabel() == "$F_X$ (N)"
    box = arc.get_legend().get_window_extent()
    for line in arc.lines:
        drawn = line.get_transform().transform(line.get_xydata())
        whole = drawn[np.isfinite(drawn).all(axis=1)]
        assert not Outline(whole).intersects_bbox(box, filled=False)


def test_slips_shorter_than_a_dot_are_seen() -> None:
    """The tip of a force microscope slips for a 3000th of the axis: the first slips were white."""
    slider = st.presets.nakano_popov_2020().replace(
        mass="1e-11 kg", k_x="0.5 N/m", k_y="40 N/m", phi="5 deg", normal_load="20 nN",
        friction=st.ExponentialWeakening(0.5, 0.3, "10 um/s"), drive=st.ConstantVelocity("1 um/s"),
    )  # fmt: skip
    run = st.simulate(slider, "40 ms", sample_rate="1 MHz")
    with style():
        figure = Figure(figsize=(4.0, 1.2), dpi=300)
        page = FigureCanvasAgg(figure)
        ax = figure.add_axes((0.1, 0.1, 0.8, 0.8))
        draw_slip_speed(ax, run)
        ax.set_axis_off()
        page.draw()
    shade = 255 - np.asarray(page.buffer_rgba())[..., 0].astype(float)
    for end in run.stick_intervals[1:-1, 1]:
        after = (run.samples["time"] >= end) & (run.samples["time"] < end + 2e-5)
        top = float(run.samples["slip_speed"][after].max())
        column, up = ax.transData.transform((end, 0.9 * top))
        if up > ax.bbox.y0:
            near = shade[len(shade) - 1 - round(up), round(column) - 2 : round(column) + 3]
            assert near.max() > 100.0


def test_creep_agrees_with_theory(paper_run: st.Trajectory) -> None:
    mean = mean_creep_velocity(paper_run)
    early = mean.sel(time=slice(0.02, 1.5))
    exact = theory.creep_velocity(early["time"].values, 1e-3, radians(1), 2e-3)
    np.testing.assert_allclose(early.values, exact, rtol=0.012)
    assert 2.0 < first_slip_time(paper_run) < 2.04
    fig = draw(creep(paper_run))
    value, deviation = fig.axes
    assert value.get_yscale() == "log"
    assert len(value.get_legend().get_texts()) == 4
    assert deviation.get_ylabel().endswith("(%)")
    corrected, printed = curve(deviation, 2), curve(deviation, 3)
    middle = np.abs(corrected[:, 0] - 1.0).argmin()
    assert corrected[middle, 1] == pytest.approx(0.64, abs=0.05)
    assert printed[middle, 1] == pytest.approx(-48.2, abs=0.5)


# --- schematic ---


@pytest.mark.parametrize("phi", [0, 1, 10, 30, 45, 60, 85, 90, -1, -5, -45, -90])
def test_schematic_draws_the_misalignment(slider: st.Slider, phi: float) -> None:
    damped = slider.replace(phi=f"{phi} deg", c_x=1.0 if phi > 30 else 0.0, c_y=0.5)
    with style():
        fig = new_figure(3.4, 3.4)
        ax = draw_schematic(fig.subplots(), damped)
    draw(fig)
    shown = degrees(drawn_misalignment(radians(phi)))
    assert (shown == pytest.approx(phi)) == ("drawn at" not in words(ax))
    assert f"{phi}°".replace("-", "−") in words(ax)
    arrows = [patch for patch in ax.patches if isinstance(patch, FancyArrowPatch)]
    heads = {mpl.colors.to_hex(arrow.get_edgecolor()).upper(): way(arrow) for arrow in arrows[::-1]}
    assert heads[BLUE] == pytest.approx(0)  # X and the drive point to the right
    force = heads[PURPLE]  # opposite to slip, between -X and the negative y axis
    assert 0 <= np.sign(phi or 1) * (force % 360 - 180) <= max(90 - abs(shown), 1e-9)
    assert r"\psi" in words(ax) or phi in (0, 90, -90)


@pytest.mark.parametrize("phi", [1, 24, -30, 45, 60, 90])
def test_names_of_springs_and_dampers_stand_beside_them(slider: st.Slider, phi: float) -> None:
    """However large the letters are beside the drawing."""
    with style():
        fig = new_figure(2.4, 2.4)
        ax = draw_schematic(fig.subplots(), slider.replace(phi=f"{phi} deg", c_x=1.0, c_y=0.5))
    draw(fig)
    named = [text for text in ax.texts if "c_" in text.get_text()]
    assert len(named) == 2
    look = (BLACK, "-")
    dampers = [line for line in ax.lines if (line.get_color(), line.get_linestyle()) == look]
    for text in named:
        box = text.get_window_extent()
        for line in dampers:
            assert not line.get_path().transformed(line.get_transform()).intersects_bbox(box, False)


def way(arrow: FancyArrowPatch) -> float:
    """Direction of an arrow, in deg."""
    tail, head = arrow._posA_posB  # type: ignore[attr-defined]
    return float(np.degrees(np.arctan2(head[1] - tail[1], head[0] - tail[0])))


@pytest.mark.parametrize("velocity", [1e-3, 0.0, -1e-3])
def test_schematic_draws_any_drive(slider: st.Slider, velocity: float) -> None:
    fig = draw(schematic(slider.replace(drive=st.ConstantVelocity(velocity), phi="-40 deg")))
    apparatus, side, top, triangle = fig.axes
    assert ("V = 0" in words(top)) == (velocity == 0) == ("V = 0" in words(side))
    assert "leaf spring" in words(apparatus)
    assert r"\dot{u}_x" in words(triangle)


@pytest.mark.parametrize("phi", [8, -8])
def test_schematic_draws_springs_in_series_and_the_axes_of_masses(
    slider: st.Slider, phi: float
) -> None:
    cell = st.Spring("load cell", k_x="20 kN/m", k_y="rigid")
    leaf = st.Spring("leaf springs", k_x="1 kN/m", k_y="5 MN/m")
    chain = slider.replace(
        springs=[cell, leaf], mass_y="0.4 kg", mass_angle="20 deg", phi=f"{phi} deg"
    )
    with style():
        fig = new_figure(2.4, 2.4)
        ax = draw_schematic(fig.subplots(), chain)
    draw(fig)
    assert "1  load cell\n2  leaf springs" in words(ax)
    assert "$m_x$ 20° to $x$" in words(ax)
    assert [text.get_text() for text in ax.texts].count("2") == 2  # along x and along y
    zigzags = [line for line in ax.lines if len(line.get_xdata()) == 12]
    bars = [line for line in ax.lines if line.get_linewidth() == 2.4]
    assert (len(zigzags), len(bars)) == (3, 1)
    # the block's own line leans by 20 deg from x towards y
    look = (GREY, 1.0, "-")
    lines = ((each.get_color(), each.get_linewidth(), each.get_linestyle()) for each in ax.lines)
    (solid,) = [line for line, its in zip(ax.lines, lines, strict=True) if its == look]
    (x, y) = (np.diff(values)[0] for values in solid.get_data())
    drawn = degrees(drawn_misalignment(chain.misalignment))
    assert np.degrees(np.arctan2(y, x)) == pytest.approx(20.0 - drawn)


@pytest.mark.parametrize(("phi", "angle"), [(8, 30), (-8, 30), (0, -50), (45, 70), (-85, 10)])
def test_schematic_draws_dampers_along_their_own_axes(
    slider: st.Slider, phi: float, angle: float
) -> None:
    askew = slider.replace(phi=f"{phi} deg", c_x=1.0, c_y=2.0, damping_angle=f"{angle} deg")
    with style():
        fig = new_figure(2.4, 2.4)
        ax = draw_schematic(fig.subplots(), askew)
        along = draw_schematic(new_figure(2.4, 2.4).subplots(), askew.replace(c_y=1.0))
    draw(fig)
    assert f"$c_x$ {angle}° to $x$".replace("-", "−") in words(ax)
    assert "to $x$" not in words(along)  # where both are equal
    names = {text.get_text(): np.array(text.get_position()) for text in ax.texts}
    drawn = degrees(drawn_misalignment(askew.misalignment))
    for name, at in (("$c_x$", angle), ("$c_y$", angle + 90.0)):
        x, y = names[name]
        # of an axis, seen from the block in the middle
        seen = np.degrees(np.arctan2(y, x)) - (at - drawn)
        assert (seen + 90.0) % 180.0 - 90.0 == pytest.approx(0.0, abs=1e-9)


# --- overview ---


@pytest.mark.parametrize(
    ("changes", "rate"),
    [
        ({"phi": "0 deg"}, "1 kHz"),
        ({"phi": "90 deg", "c_x": 1.0}, "1 kHz"),
        ({"phi": "-3 deg"}, None),
        ({"drive": st.ConstantVelocity(0.0)}, "20 Hz"),
        ({"friction": st.Coulomb(mu_0=0.0)}, "1 kHz"),
        ({"mass": 1e-12, "k_x": 1e-6, "k_y": 1e-3, "normal_load": 1e-9}, "100 Hz"),
    ],
)
def test_overview_of_any_system(
    slider: st.Slider, changes: dict[str, object], rate: str | None
) -> None:
    run = st.simulate(slider.replace(**changes), 0.1, sample_rate=rate)
    fig = draw(figure_of(plot_run, run))
    text = " ".join(words(ax) for ax in fig.axes)
    assert run.status.value in text
    for ax in fig.axes[2:]:
        assert ax.get_ylabel().endswith(")"), "a label without its unit"


def test_overview_of_the_paper_shows_every_stick(paper_run: st.Trajectory) -> None:
    fig = draw(figure_of(plot_run, paper_run))
    assert "2959 sticks" in words(fig.axes[1])
    stairs = fig.axes[-1].patches[0].get_data()
    share = (stairs.values * np.diff(stairs.edges)).sum() / 100
    assert share == pytest.approx(0.3231, abs=1e-4)


def test_overview_of_a_run_that_broke_off_says_why(slider: st.Slider) -> None:
    run = st.simulate(slider, 1.0, sample_rate=1e3, max_steps=50)
    assert not run.status.ok
    assert "max_steps" in words(draw(figure_of(plot_run, run)).axes[1])


def overview_axes(run: st.Trajectory) -> dict[str, Axes]:
    """Return the axes of the overview of a run by their names, unknown to pyplot."""
    found: dict[str, Axes] = {}
    figure_of(lambda: found.update(plot_run(run)) or found)
    return found


@pytest.mark.parametrize(("most_steps", "color"), [(100_000, BLUE), (5, RED)])
def test_overview_writes_lines_below_headings(
    slider: st.Slider, most_steps: int, color: str
) -> None:
    run = st.simulate(slider, 0.02, sample_rate=1e4, max_steps=most_steps)
    panel = overview_axes(run)["words"]
    bold = [text.get_fontweight() == "bold" for text in panel.texts]
    headings = [text for text, its in zip(panel.texts, bold, strict=True) if its]
    assert [text.get_text() for text in headings] == ["System", "Friction", "Scales", "Run"]
    assert [text.xyann[0] for text in panel.texts] == [0 if its else 6 for its in bold]
    steps = [before.xyann[1] - after.xyann[1] for before, after in pairwise(panel.texts)]
    assert steps == pytest.approx([LINE + GAP * its for its in bold[1:]])
    end = bold.index(True, len(bold) - 1 - bold[::-1].index(True))
    colors = [text.get_color() for text in panel.texts]
    assert colors == [BLACK] * (end + 1) + [color] * (len(bold) - end - 1)
    assert not any(text.get_in_layout() for text in panel.texts)


def test_overview_has_one_axis_of_time(fine: st.Trajectory) -> None:
    panels = overview_axes(fine)
    series = [panels[name] for name in SERIES]
    assert [ax.get_xlabel() for ax in series] == [""] * 5 + ["time $t$ (s)"]
    assert {ax.get_xlim() for ax in series} == {(0.5, 0.504)}
    alone = figure_of(plot_glance, fine).axes  # which do not share it
    assert {ax.get_xlim() for ax in alone} == {(0.5, 0.504)}
    room = [ax.margins()[1] for ax in series]
    assert room == [0.12] * 4 + [mpl.rcParams["axes.ymargin"]] * 2


def test_overview_shows_both_spring_forces(slider: st.Slider, paper_run: st.Trajectory) -> None:
    begins = st.simulate(slider, 1e-4, sample_rate=1e6)
    ax = overview_axes(begins)["force"]
    along, across = ax.get_lines()
    assert [line.get_label() for line in (along, across)] == ["$k_x u_x$", "$k_y u_y$"]
    assert [line.get_color() for line in (along, across)] == [RED, ORANGE]
    assert along.get_zorder() > across.get_zorder()
    forces = [begins.samples[f"spring_{axis}"] for axis in "xy"]
    factor, prefix = metric_prefix(np.concatenate(forces))
    assert (factor, prefix) != (1.0, "")
    for line, force in zip((along, across), forces, strict=True):
        np.testing.assert_allclose(line.get_ydata(), factor * force)
    names = [
        [text.get_text() for text in overview_axes(run)["force"].get_legend().get_texts()]
        for run in (begins, paper_run)
    ]
    assert [len(each) for each in names] == [2, 3]
    assert names[1][2] == "fast oscillation"


def test_overview_has_the_law_up_to_the_largest_slip_speed(slider: st.Slider) -> None:
    run = st.simulate(slider, 3.0, sample_rate=1e3)
    fastest = float(run.samples["slip_speed"].max())
    assert fastest > 10.0 * slider.drive_speed
    (other,) = figure_of(plot_law, slider, fastest).axes
    axes = overview_axes(run)
    assert axes["law"].get_xlim() == pytest.approx(other.get_xlim())
    assert not axes["speed"].get_title(loc="right")  # which would say that samples hide its peaks


def test_overview_of_a_fault_is_in_years_and_says_what_its_samples_hide() -> None:
    """Slips of 0.13 m/s had 3e-8 m/s, 1e10 s had no year, and mu(v) bent where the law ends."""
    fault = st.Slider(
        mass="3e7 kg", k_x="3 MN/m", k_y="300 MN/m", phi="0 deg", normal_load="50 MN",
        friction=st.laws.RateStateAgeing(0.010, 0.015, "20 mm", 0.6, "1 um/s"),
        drive=st.ConstantVelocity("37 mm/yr"),
    )  # fmt: skip
    ax = overview_axes(st.simulate(fault, "1500 yr", sample_rate=4e-7))
    assert ax["speed"].get_xlabel() == "time $t$ (yr)"
    draw(ax["speed"].get_figure(root=True))
    labels = [float(text.get_text()) for text in ax["speed"].get_xticklabels() if text.get_text()]
    assert 1000.0 in labels
    assert not any(label % 100.0 for label in labels)
    assert ax["speed"].get_title(loc="right") == UNSEEN
    (law,) = ax["law"].lines
    mu = law.get_ydata()
    assert np.diff(mu).max() < 0.0  # it falls all along


# --- what they are made of ---


def test_spectrogram_gives_the_amplitude_of_a_sine() -> None:
    time = np.arange(10_000) / 1e4
    found = spectrogram(3 * np.sin(2 * pi * 1000 * time) + 5 + 7 * time, 1e4)
    assert float(found.max()) == pytest.approx(3.0, rel=1e-3)
    assert set(found.idxmax("frequency").values) == {1000.0}
    assert float(found.sel(frequency=0.0).max()) < 1e-3  # the trend is taken off
    assert float(found["time"][0]) == pytest.approx(0.05)
    assert float(found["time"][-1]) <= 0.95 + 1e-9


@pytest.mark.parametrize("bad", [np.zeros(10), np.full(2000, np.nan)])
def test_spectrogram_refuses_what_it_cannot_transform(bad: Floats) -> None:
    with pytest.raises(ValueError, match=r"window|finite"):
        spectrogram(bad, 1e4)


def test_envelope_keeps_the_extremes_and_the_gaps() -> None:
    time = np.linspace(0, 1, 20_000)
    values = np.sin(5000 * time)
    values[7777] = 9.0
    values[:4000] = np.nan
    thin, kept = envelope(time, values, bins=100)
    assert len(thin) == 200
    assert np.nanmax(kept) == 9.0
    assert np.isnan(kept[:38]).all()
    assert np.isfinite(kept[42:]).all()


def test_time_stuck_counts_parts_of_intervals() -> None:
    sticks = np.array([[0.0, 0.5], [2.0, 3.0]])
    np.testing.assert_allclose(stuck_until([0, 0.25, 1, 2.5, 9], sticks), [0, 0.25, 0.5, 1.0, 1.5])
    assert not stuck_until([0, 1], np.empty((0, 2))).any()


def test_units_suit_the_size() -> None:
    assert metric_prefix([2e-3, -4e-3]) == (1e3, "m")
    assert metric_prefix([np.nan, 0.0]) == (1.0, "")


def test_drawing_leaves_no_trace(slider: st.Slider) -> None:
    before = dict(mpl.rcParams)
    figure5(slider)
    assert dict(mpl.rcParams) == before


def test_save_writes_both_formats_small_and_whole(paper_run: st.Trajectory, tmp_path: Path) -> None:
    png, pdf = save(figure3(paper_run), tmp_path / "figure-3.v1")
    assert png.name == "figure-3.v1.png"
    assert png.read_bytes().startswith(b"\x89PNG")
    assert pdf.read_bytes().startswith(b"%PDF")
    assert pdf.stat().st_size < 1_000_000
    assert sorted(tmp_path.iterdir()) == [pdf, png]


def test_saving_in_vain_says_why(tmp_path: Path) -> None:
    with pytest.raises(st.ResultError, match="does not exist"):
        write(Figure(), tmp_path / "missing" / "a.png")
    with pytest.raises(st.ResultError, match=r"unknown format '\.bmp'"):
        write(Figure(), tmp_path / "a.bmp")


def test_angles_are_cut_where_none_lie():
    back_and_forth = np.array([-175.0, 5.0, 178.0, -8.0, np.nan])
    opened = cut_open(back_and_forth)
    assert np.nanmax(np.abs(np.mod(opened - back_and_forth + 180, 360) - 180)) < 1e-9
    assert np.nanmax(opened) - np.nanmin(opened) == pytest.approx(193.0)  # no jump from -175 to 178
    forward = np.array([-90.0, 0.0, 89.0])
    assert cut_open(forward).tolist() == forward.tolist()


def test_a_slow_period_among_fast_ones_makes_no_bar() -> None:
    """The friction of a mass that rests now and then: its band has no gaps."""
    period = np.full(600, 30.0)  # samples, three bins of ten each
    period[::40] = 55.0
    ends = np.cumsum(period)
    values = np.sin(2 * np.pi * np.interp(np.arange(15_000.0), ends, np.arange(len(ends))))
    (fast,) = oscillations(np.arange(15_000.0), values, 60.0, 0.1)
    assert fast.samples.start < 100  # the first period is a slow one
    assert fast.samples.stop == 15_000
    assert fast.period == pytest.approx(period[:490].mean(), rel=0.01)
    assert not oscillations(np.arange(15_000.0), values, 30.0, 0.1)  # the mean period is longer


@pytest.mark.parametrize(
    ("width", "samples", "damping"), inside(6, (0.5, 2.5), (8.0, 60.0), (0.1, 0.25))
)
def test_trials_that_die_out_are_bands_between_their_extremes(
    width: float, samples: float, damping: float
) -> None:
    """Swings of few or many samples and of a few widths of the line; a line if they can be seen."""
    period = width / (0.75 * 7.0 * 72.0)  # pt, of a page
    time = np.linspace(0.0, 1.0, round(samples / period))
    size = np.exp(-time / damping)
    dying = 2.0 + size * np.sin(2.0 * pi * time / period)
    before = st.Record(time=time, force=2.0 + 0.5 * (5.0 * time % 1.0))
    (ax,) = plot_trials(before, [Trial("faster", st.Record(time=time, force=dying))])
    (band,) = ax.collections
    corners = band.get_paths()[0].vertices
    for sign in (-1.0, 1.0):
        side = corners[np.sign(corners[:, 1] - 2.0) == sign]
        side = side[(side[:, 0] > 0.05) & (side[:, 0] < side[:, 0].max() - 0.05)]
        expected = np.interp(side[:, 0], time, size)
        np.testing.assert_allclose(np.abs(side[:, 1] - 2.0), expected, rtol=0.2)
    line = ax.get_lines()[-1].get_xydata()
    later = line[(line[:, 0] > 0.05) & (line[:, 0] < 0.95)]
    assert np.ptp(later[:, 1]) < 0.1  # of two: their mean
    (slow,) = plot_trials(before, [Trial("slow", st.Record(time=20.0 * time, force=dying))])
    assert slow.collections  # time alone changes nothing
    few = 2.0 + size * np.sin(2.0 * pi * 12.0 * time)
    (ax,) = plot_trials(before, [Trial("slow", st.Record(time=time, force=few))])
    assert not ax.collections
    assert np.ptp(ax.get_lines()[-1].get_ydata()) > 1.0


def test_a_few_fast_turns_in_each_cycle_leave_the_cycles_to_be_seen() -> None:
    time = np.linspace(0.0, 10.0, 20_001)
    within = time % 1.0
    force = within + 0.1 * np.exp(-within / 0.02) * np.sin(2.0 * pi * 100.0 * within)
    line = draw_line(Figure().add_subplot(), time, force)
    assert np.ptp(line.get_ydata()) > 0.9 * np.ptp(force)


@pytest.mark.parametrize("noise", [0.02, 0.05, 0.1])
def test_noise_on_an_oscillation_that_can_be_seen_does_not_flatten_it(noise: float) -> None:
    """The mean of a few turns of the noise took part of it away, here more and there less."""
    time = np.arange(0.0, 3.75, 5e-4)
    rng = np.random.default_rng(5)
    force = np.sin(2.0 * pi * 35.0 * time) + noise * rng.normal(size=len(time))
    panel = canvas(PAGE, 2.2).add_subplot()
    line = draw_line(panel, time, force, width=0.5)
    times, heights = line.get_xydata().T
    periods = [heights[(times >= a) & (times < a + 1 / 35)] for a in np.arange(1, 128) / 35]
    assert min(np.ptp(each) for each in periods) > 1.9  # of 2
    assert not panel.collections


def test_creep_that_oscillates_has_a_mean_and_a_highest_speed_beside_slip_and_rest() -> None:
    time = np.arange(4000.0)
    speeds = 1e-6 * (1.0 + 0.6 * np.sin(2.0 * pi * time / 10.3))
    speeds[2000:2020], speeds[3000:3500] = 1e-2, 0.0
    mean, high = mean_course(time, speeds, speeds, 20.0)
    assert mean[50:1950] == pytest.approx(1e-6, rel=0.01)
    assert high[50:1950] == pytest.approx(1.6e-6, rel=0.02)  # samples beside crests
    for part in (slice(1995, 2025), slice(3000, 3500)):
        assert (mean[part] == speeds[part]).all()
        assert (high[part] == speeds[part]).all()


def test_slips_that_ring_are_no_oscillation() -> None:
    """A few turns after each slip made a band of what are lines."""
    time = np.arange(0.0, 60.0, 2e-3)
    since = time % 0.9
    for rings in (0.05, 0.1):
        ringing = np.exp(-since / rings) * (1.0 + 0.5 * np.cos(2.0 * pi * since / rings))
        assert not oscillations(time, ringing, 1.2356, 5e-3 * np.ptp(ringing))
    assert oscillations(time, np.cos(2.0 * pi * time / 0.9), 1.2356, 0.01)


def test_an_oscillation_that_grows_or_shrinks_is_one_band(paper_run: st.Trajectory) -> None:
    """Swings before a slip were taken for larger ones among noise, and Fig. 4 had holes."""
    time, values = paper_run.samples["time"], paper_run.samples["v_y"]
    found = oscillations(time, values, 0.05, 5e-3 * np.ptp(values))
    bands = [(time[each.samples.start], time[each.samples.stop - 1]) for each in found]
    for start, end in ((0.0, 1.9), (2.1, 2.8), (3.05, 3.7), (3.95, 4.65)):  # between the slips
        assert any(first <= start and end <= last for first, last in bands), (start, end)
    before = time < 1.98
    growing = paper_run.samples["v_x"][before]
    first, *_ = oscillations(time[before], growing, 0.05, 5e-3 * np.ptp(growing))
    assert time[first.samples.start] < 0.2
    assert time[first.samples.stop - 1] > 1.85


def test_spikes_are_no_oscillation() -> None:
    """Sparse ones do not turn noise on stick-slip into another period."""
    time = np.arange(0.0, 20.0, 5e-4)
    rng = np.random.default_rng(5)
    force = 3.0 * (time % 2.0) + 0.2 * rng.normal(size=len(time))
    spikes = force.copy()
    spikes[rng.integers(len(time), size=150)] += 1.5
    panels = [canvas(PAGE, 2.2).add_subplot() for _ in range(2)]
    bare, spiked = (
        draw_line(panel, time, each) for panel, each in zip(panels, (force, spikes), strict=True)
    )
    assert all(panel.collections for panel in panels)
    assert np.abs(bare.get_ydata() - spiked.get_ydata()).max() < 0.4  # what spikes add to a mean


@pytest.mark.parametrize("seed", range(12))
def test_noise_does_not_slow_a_slip_down(seed: int) -> None:
    """Where noise is a band, its mean over many periods drew slips as slopes, below the peaks."""
    rng = np.random.default_rng(seed)
    rate, cycle = rng.choice([500.0, 2000.0, 10000.0]), rng.uniform(0.7, 1.3)
    time = np.arange(0.0, 20.0, 1.0 / rate)
    force = 1.0 + time % cycle / cycle
    noise = 10.0 ** rng.uniform(-3.0, -1.5)
    ax = canvas(PAGE, 2.2).add_subplot()
    line = draw_line(ax, time, force + noise * rng.normal(size=len(time)))
    drawn = np.asarray(line.get_xydata())
    off = np.abs(drawn[:, 1] - np.interp(drawn[:, 0], time, force))
    bin_ = 20.0 / 1500.0
    near = np.abs((drawn[:, 0] + 0.5 * cycle) % cycle - 0.5 * cycle) < 3.0 * bin_
    assert off[~near].max() < 0.02 + 5.0 * noise
    for at in np.arange(cycle, 19.0, cycle):  # the peak before each slip
        peak = drawn[np.abs(drawn[:, 0] - at) < 3.0 * bin_, 1].max()
        assert peak > 1.93 - 3.0 * noise


def test_a_trial_that_hardly_moves_beside_the_test_before_is_drawn_whole() -> None:
    time = np.linspace(0.0, 100.0, 5_001)
    before = st.Record(time=time, force=1.0 + 0.25 * (time % 4.0))
    tiny = st.Record(time=time, force=1.0 + 1e-3 * np.sin(2 * pi * 8.0 * time))
    (ax,) = plot_trials(before, [Trial("turned", tiny)])
    assert ax.get_xlim() == (0.0, 100.0)
    assert not ax.texts


def test_the_legend_of_trials_lies_above_a_title_of_two_lines() -> None:
    time = np.linspace(0.0, 100.0, 101)
    before = st.Record(time=time, force=1.0 + 0.25 * (time % 4.0))
    (ax,) = plot_trials(before, [Trial("a change with a name " * 4, before)])
    figure = ax.figure
    figure.draw_without_rendering()
    title = next(x for x in (ax.title, ax._left_title) if x.get_text())
    assert "\n" in title.get_text()
    assert not ax.get_legend().get_window_extent().overlaps(title.get_window_extent())


def test_trials_of_many_swings_show_a_few_of_them() -> None:
    """A solid block says nothing of the motion; what hardly moves is drawn whole."""
    time = np.linspace(0.0, 100.0, 40_001)
    before = st.Record(time=time, force=1.0 + 0.25 * (time % 4.0))
    many = st.Record(time=time, force=1.0 + 0.4 * np.sin(2 * pi * 20.0 * time))
    trials = [Trial("fast", many), Trial("slow", before)]
    fast, slow = plot_trials(before, trials)
    low, high = fast.get_xlim()
    assert (low, high) == pytest.approx((100.0 - 8 / 20.0, 100.0), abs=1e-2)
    blue = fast.get_lines()[-1].get_ydata()
    turns = np.count_nonzero(np.diff(np.sign(np.diff(blue))))
    assert 14 <= turns <= 18
    assert [text.get_text() for text in fast.texts] == ["the last 8 of some 2000 swings"]
    assert slow.get_xlim() == (0.0, 100.0)
    assert [ax.get_title(loc="left") for ax in (fast, slow)] == ["fast", "slow"]
    short = st.Record(time=time[:20_000] / 2.0, force=before.force[:20_000])
    (alone,) = plot_trials(short, [Trial("fast", many)])  # which ended before this part begins
    assert alone.get_xlim()[1] == 100.0
    assert len(alone.get_lines()) == 1


def test_trials_that_die_out_are_shown_from_their_beginning() -> None:
    """The last of their swings would not show that they do, and are too small to be counted."""
    time = np.linspace(0.0, 75.0, 80_001)
    before = st.Record(time=time / 9.0, force=1.8 + 0.5 * ((time / 9.0) % 1.0))
    dying = 1.8 + 3.0 * np.exp(-time / 9.0) * np.sin(2 * pi * 27.0 * time)
    (ax,) = plot_trials(before, [Trial("faster", st.Record(time=time, force=dying))])
    assert ax.get_xlim() == (0.0, 75.0)
    assert not ax.texts


def test_a_test_that_a_trial_outruns_is_a_band_in_the_legend() -> None:
    """At 200 times the speed the trial is over before the present test has loaded its spring."""
    time = np.linspace(0.0, 80.0, 8001)
    before = st.Record(time=time, force=np.where(time < 14.0, time / 2.2, 5.3 + (time % 2.2) / 2))
    fast = st.Record(time=time / 100.0, force=np.minimum(20.0 * time, 6.0))
    whole = st.Record(time=time, force=np.minimum(time / 2.2, 6.3))
    first, second = plot_trials(before, [Trial("fast", fast), Trial("damped", whole)])
    assert len(first.get_lines()) == 1
    (band,) = first.patches
    low, high = band.get_extents().transformed(first.transData.inverted()).intervaly
    late = before.force[4000:]
    assert (low, high) == pytest.approx((late.min(), late.max()))
    assert len(second.get_lines()) == 2
    legend = first.get_legend()
    assert legend is not None
    named = [text.get_text() for text in legend.get_texts()]
    assert named == ["range of the force now", "changed", "now"]


def test_a_test_that_moves_slowly_does_not_look_calm_beside_a_fast_one() -> None:
    """In the last few swings of a fast trial its force hardly changes."""
    time = np.linspace(0.0, 130.0, 65_001)
    slow = st.Record(time=time, force=1.5 + 0.5 * (time / 46.0 % 1.0))
    fast = st.Record(time=time, force=1.5 + 0.3 * np.sin(2 * pi * 10.0 * time))
    (ax,) = plot_trials(slow, [Trial("faster", fast)])
    assert len(ax.get_lines()) == 1
    assert len(ax.patches) == 1


def test_the_titles_of_trials_stand_side_by_side() -> None:
    """The longest that an audit writes, and one of a spring with a long name."""
    time = np.linspace(0.0, 1.0, 1001)
    record = st.Record(time=time, force=1.0 + time % 0.1)
    titles = [
        "drive velocity V = 198.6 µm/s: transitional oscillation, still changing",
        "stiffness k_x of the double parallelogram = 38.44 MN/m: irregular vibration",
        "misalignment φ = 14.35 deg: steady sliding",
    ]
    fig = figure_of(plot_trials, record, [Trial(title, record) for title in titles])
    axes = draw(fig).axes[:3]
    boxes = [ax._left_title.get_window_extent() for ax in axes]
    shown = [" ".join(ax.get_title(loc="left").split()) for ax in axes]
    assert shown == [title.replace("k_x", "$k_{x}$") for title in titles]
    assert boxes[0].x1 < boxes[1].x0
    assert boxes[1].x1 <= fig.bbox.x1
    for box, ax in zip(boxes, axes, strict=True):
        assert box.y0 >= ax.get_window_extent().y1
    assert boxes[2].y1 < axes[0].xaxis.label.get_window_extent().y0


def test_a_close_up_marks_every_cycle_in_it() -> None:
    time = np.arange(0.0, 20.0, 0.01)
    axes = plot_cycles(st.Record(time=time, force=1.0 + np.sin(2 * pi * time)))
    low, high = axes[1].get_xlim()
    for label in ("peak", "trough"):
        whole, near = (
            next(line for line in ax.lines if line.get_label() == label).get_xdata() for ax in axes
        )
        np.testing.assert_array_equal(
            near[(near > low) & (near < high)], whole[(whole > low) & (whole < high)]
        )


def test_trials_show_the_start_where_swings_are_not_small_beside_it() -> None:
    """Both were simulated from rest, and the loading was cut off."""
    time = np.arange(0.0, 10.0, 0.01)
    loading = np.minimum(time, 3.6)
    before = st.Record(time=time, force=loading + 0.6 * np.sin(4.0 * time) * (time > 4.0))
    (ax,) = plot_trials(before, [Trial("a damper", st.Record(time=time, force=loading))])
    assert ax.get_ylim()[0] <= 0.0


def test_trials_show_what_is_small_beside_the_loading() -> None:
    time = np.arange(0.0, 10.0, 0.01)
    loading = np.minimum(time, 3.6)
    before = st.Record(time=time, force=loading + 0.03 * np.sin(40.0 * time) * (time > 4.0))
    (ax,) = plot_trials(before, [Trial("a damper", st.Record(time=time, force=loading))])
    low, high = ax.get_ylim()
    assert 3.5 < low < 3.57
    assert 3.63 < high < 3.7


def test_marks_of_a_small_force_leave_it_to_be_seen() -> None:
    """They touch it with their tips: that of a peak stands above, that of a trough below."""
    time = np.arange(0.0, 40.0, 0.01)
    force = np.minimum(time, 3.6) + 0.01 * np.sin(10.0 * time) * (time > 4.0)
    ax = draw(figure_of(plot_cycles, st.Record(time=time, force=force))).axes[0]
    for label, side in (("peak", 1.0), ("trough", -1.0)):
        (marks,) = [line for line in ax.lines if line.get_label() == label]
        look = MarkerStyle(marks.get_marker())
        corners = look.get_path().transformed(look.get_transform()).vertices[:, 1]
        assert (side * corners).min() == pytest.approx(0.0, abs=1e-9)


def test_times_of_milliseconds_are_written_so() -> None:
    time = np.arange(0.0, 8e-4, 1e-6)
    record = st.Record(time=time, force=1.0 + np.sin(2 * np.pi * time / 5e-5))
    ax = draw(figure_of(plot_cycles, record)).axes[-1]
    assert ax.get_xlabel() == "time $t$ (ms)"
    labels = [float(text.get_text()) for text in ax.get_xticklabels() if text.get_text()]
    assert 0.1 < max(labels) <= 0.8


def test_wild_samples_do_not_flatten_the_cycles() -> None:
    time = np.arange(0.0, 20.0, 1e-3)
    force = 1.0 + np.sin(2 * pi * time)
    force[[3300, 3700]] = 99.9
    whole, part = plot_cycles(st.Record(time=time, force=force))
    assert whole.get_ylim()[1] < 3.0
    assert [text.get_text() for text in whole.texts] == ["2 samples beyond the axis"]
    assert not list(part.texts)


@pytest.mark.parametrize(
    ("speed", "phi", "other"),
    [*inside(8, (-5.0, -1.5), (0.3, 6.0), (8.0, 30.0)), (-1.523, 1.0, 14.35)],
)
def test_words_in_the_damping_diagram_cover_no_others(
    slider: st.Slider, speed: float, phi: float, other: float
) -> None:
    apart = slider.replace(drive=st.ConstantVelocity(10.0**speed), phi=f"{phi} deg")
    (ax,) = draw(figure5(apart, radians(other))).axes
    boxes = [text.get_window_extent() for text in ax.texts]
    for at, box in enumerate(boxes):
        assert not any(box.overlaps(each) for each in boxes[:at]), ax.texts[at].get_text()
    paths = [line.get_window_extent() for line in ax.lines if len(line.get_xdata()) > 1]
    for text, box in zip(ax.texts, boxes, strict=True):
        if "theta" in text.get_text():  # the place was free before the legend shrank the axes
            assert not any(box.overlaps(path) for path in paths), text.get_text()


def test_an_oscillation_too_fast_to_be_seen_is_a_band_about_its_mean() -> None:
    time = np.linspace(0.0, 1.0, 60_001)
    for turns, fast in ((20.0, False), (6000.0, True)):
        ax = Figure().add_subplot()
        line = draw_line(ax, time, 3.0 + np.sin(2.0 * np.pi * turns * time))
        heights = np.asarray(line.get_ydata(), dtype=np.float64)
        assert len(ax.collections) == fast
        if fast:  # a bin holds 4 periods: their mean is 3 but for the part of one that is cut off
            np.testing.assert_allclose(heights, 3.0, atol=0.05)
            band = ax.collections[0].get_paths()[0].vertices[:, 1]
            assert band.min() < 2.05
            assert band.max() > 3.95
        else:
            assert np.ptp(heights) == pytest.approx(2.0, abs=1e-4)


def test_a_mass_that_rests_has_no_axis_of_rounding(slider: st.Slider) -> None:
    run = st.simulate(slider, "2 ms", sample_rate="100 kHz")  # the first stick lasts 11 ms
    panels = run.plot()
    for name, said in (("position", "at rest"), ("speed", "no slip")):
        assert [text.get_text() for text in panels[name].texts] == [said]
        assert not len(panels[name].get_yticks())
    friction = panels["friction"].get_lines()[0].get_ydata()
    assert np.isnan(friction[0])  # it is let go with a millionth of V, and sticks at once
    assert np.nanmax(friction) < 0.2 * slider.F_0  # 2 of 11.5 ms


def test_units_reach_down_to_a_microscope_s_energies() -> None:
    assert metric_prefix([1.4e-17]) == (pytest.approx(1e18), "a")


def test_large_numbers_have_a_power_of_ten() -> None:
    assert plain(25664.3) == "25660"
    assert plain(99.81, 2) == "100"
    assert plain(1.878e7) == r"$1.878\times 10^{7}$"


def test_a_constant_force_has_no_axis_of_rounding() -> None:
    """Vibration across the drive: friction is constant, to 1e-14, and its axis shows it so."""
    panels = plot_run(st.run(st.presets.transverse_vibration()))
    low, high = panels["friction"].get_ylim()
    assert high - low > 1e-3 * high
    words = " ".join(text.get_text() for text in panels["words"].texts)
    assert "±-" not in words


def test_beats_of_too_few_samples_are_named(slider: st.Slider) -> None:
    """The mass sticks a thousand times a second: samples at 200 Hz show other, slower swings."""
    for rate, named in (("200 Hz", True), ("20 kHz", False)):
        run = st.simulate(slider, "0.5 s", sample_rate=rate)
        words = " ".join(text.get_text() for text in plot_run(run)["words"].texts)
        assert ("too few samples for such short slips" in words) == named


def test_a_recorded_drive_is_named_for_what_it_is(slider: st.Slider, tmp_path: Path) -> None:
    """A mean of 2 mm/s, and 1.5 mm/s more or less of it; a load of 10 N, and 0.5 N."""
    time = np.linspace(0.0, 2.0, 401)
    wave = np.sin(2.0 * pi * 4.0 * time)
    table = tmp_path / "stage.csv"
    rows = np.column_stack([time, 2.0 + 1.5 * wave])
    np.savetxt(table, rows, delimiter=",", header="time [s],velocity [mm/s]", comments="")
    program = [st.protocols.read_recorded(table)]
    load = st.protocols.RecordedLoad(time=time, load=10.0 + 0.5 * wave)
    driven = slider.replace(
        drive=st.protocols.DriveProgram(program=program),
        load=st.protocols.LoadProgram(program=[load]),
    )
    panels = st.simulate(driven, "20 ms", sample_rate="10 kHz").plot()
    words = " ".join(text.get_text() for text in panels["words"].texts)
    assert "stage.csv: 2 mm/s on average, off by up to 1.5 mm/s" in words
    assert "recorded: 10 N on average, off by up to 500 mN" in words
    assert "= 0 m/s" not in words


def test_how_slow_the_last_sample_of_a_slip_is_does_not_stretch_its_axis() -> None:
    """It depends on when it is taken: a block that sticks and slips at 0.1 m/s and more."""
    slider = st.Slider(
        mass="1 kg", k_x="1 kN/m", k_y="100 kN/m", phi="0 deg", normal_load="10 N",
        friction=st.Coulomb(mu_0=0.2, mu_static=0.6), drive=st.ConstantVelocity("1 mm/s"),
    )  # fmt: skip
    lows = []
    for rate in ("1 kHz", "1.37 kHz", "3.1 kHz"):
        ax = st.simulate(slider, "30 s", sample_rate=rate).plot()["speed"]
        lows.append(ax.get_ylim()[0])
        assert lows[-1] > 1e-4
    assert max(lows) < 5.0 * min(lows)


def test_labels_of_slip_speed_within_a_decade_or_two_do_not_touch() -> None:
    """Between 1.0 and 1.5 decades the ticks between are labelled at two and five only."""
    slider = st.Slider(
        mass="150 g", k_x="1.2 kN/m", k_y="3 MN/m", phi="1 deg", normal_load="8 N",
        friction=st.Coulomb(mu_0=0.45, mu_static=0.6), drive=st.ConstantVelocity("1 mm/s"),
    )  # fmt: skip
    settings = st.Settings(duration="15 s", sample_rate="10 kHz")
    described = st.Description(slider, st.Initial(), settings)
    panels = plot_comparison(st.compare(described, ["stribeck"]))
    fig = panels["speed"].figure
    fig.draw_without_rendering()
    low, high = panels["speed"].get_ylim()
    assert 1.0 < np.log10(high / low) < 1.9  # with margins
    ticks = panels["speed"].yaxis.get_minor_ticks()
    boxes = [tick.label1.get_window_extent() for tick in ticks if tick.label1.get_text()]
    boxes = sorted((box for box in boxes if box.height > 0.0), key=lambda box: box.y0)
    assert all(below.y1 < above.y0 for below, above in pairwise(boxes))
    hidden = panels["portrait"].yaxis.get_minor_ticks()
    assert not any(tick.label1.get_visible() and tick.label1.get_text() for tick in hidden)


def test_a_slice_shows_the_range_of_the_study_where_few_runs_have_a_value() -> None:
    ax = new_figure(3, 3).subplots()
    values = np.array([np.nan, np.nan, np.nan, 0.05])
    side = Side(Scale("$\\mu$", 1.0, "1"), np.array([0.45, 0.53, 0.62, 0.7]), False)
    draw_slice(ax, side, values, "N")
    low, high = ax.get_xlim()
    assert low < 0.45
    assert high > 0.7
    low, high = ax.get_ylim()
    assert 0.0 < low < 0.05 < high


def test_laws_that_swing_too_fast_for_the_panel_are_bands(slider: st.Slider) -> None:
    rig = slider.replace(k_x=1e6, k_y=1e8, drive=st.ConstantVelocity("30 mm/s"))
    runs = {"own": st.simulate(rig, "1 s", sample_rate="10 kHz")}
    panels = plot_comparison(runs)
    force = np.asarray(panels["force"].lines[0].get_ydata(), dtype=float)
    assert np.ptp(force[len(force) // 2 :]) < 0.1 * np.ptp(force)
    assert len(panels["force"].collections) == 1


def test_creep_that_oscillates_is_one_line_in_the_phase_portrait() -> None:
    run = st.simulate(SOFT_TESTER, "3.2 s", sample_rate="2 kHz")
    [line] = plot_comparison({"own": run}, {"portrait": new_figure(3, 3).subplots()})[
        "portrait"
    ].lines
    force, speed = (np.asarray(each, dtype=float) for each in line.get_data())
    top = int(np.nanargmax(speed))  # of the first slip, which is left as it is
    assert speed[top] == pytest.approx(run.samples["slip_speed"].max(), rel=0.02)
    assert speed[top - 20] == pytest.approx(speed[top + 20], rel=0.2)
    loading = (force > 0.4) & (force < 0.62) & (np.arange(len(force)) < top - 300)
    assert (np.fmax.accumulate(speed[loading]) < 1.15 * speed[loading]).all()


def test_speeds_about_a_millimetre_a_second_are_labelled_alike() -> None:
    ax = Figure().add_subplot()
    ax.set(yscale="log", ylim=(5e-4, 8e-3))
    label_decades(ax.yaxis, 5e-4, 8e-3)
    draw(ax.figure)
    ticks = [*ax.get_yticklabels(), *ax.get_yticklabels(minor=True)]
    shown = {text.get_text() for text in ticks} - {""}
    assert len(shown) > 2
    assert all("10^{" in each for each in shown), shown


def test_a_logarithmic_axis_of_a_decade_has_three_labels() -> None:
    """The misalignment from 0.53 to 4.7 deg had the labels 1 and 2 alone."""
    for low, high in ((0.53, 4.7), (0.21, 1.9), (1e-3, 0.04), (2.1, 19.0)):
        ax = Figure().add_subplot()
        use_scale(ax, "x", True)
        ax.set_xlim(low, high)
        draw(ax.figure)
        assert sum(low <= tick <= high for tick in ax.get_xticks()) >= 3


def test_a_notebook_that_turns_interactive_inside_the_style_stays_so() -> None:
    """Its backend does when pyplot is first imported; else only the first figure would show."""
    for before, within in ((False, True), (True, False), (False, False)):
        with mpl.rc_context({"interactive": before}):
            with style():
                mpl.interactive(within)
            assert mpl.is_interactive() is within


def test_a_figure_is_written_for_print(tmp_path: Path) -> None:
    """A journal asks for 300 dots in an inch; a picture in a page has fewer."""
    fig = new_figure(3.375, 2.0)
    fig.add_subplot().plot([0.0, 1.0])
    with Image.open(write(fig, tmp_path / "a.png")) as image:
        assert image.info["dpi"] == pytest.approx((300.0, 300.0), rel=1e-3)
        assert image.size == (1012, 600)
    with Image.open(BytesIO(png(fig))) as image:
        assert image.size == (675, 400)


def test_the_layout_is_the_one_that_matplotlib_finds_when_it_writes(tmp_path: Path) -> None:
    """To the last pixel, of a figure with ticks, a power of ten beside an axis, and a legend."""
    fig = new_figure(3.375, 2.0)
    with style():
        ax = fix_ticks([fig.add_subplot()])[0]
        ax.plot([0.0, 1e-7], [1e9, 3e9], label="$k_x$")
        ax.set_xlabel("time")
        ax.legend()
    engine = fig.get_layout_engine()
    write(fig, tmp_path / "a.png")
    assert fig.get_layout_engine() is engine
    with style():
        fig.savefig(tmp_path / "b.png")
    with Image.open(tmp_path / "a.png") as one, Image.open(tmp_path / "b.png") as other:
        assert np.array_equal(np.asarray(one), np.asarray(other))


def test_labels_of_ticks_are_plain_text() -> None:
    with style():
        ax = fix_ticks([new_figure(3.375, 2.0).add_subplot()])[0]
        ax.plot([-1.0, 0.0], [1e9, 3e9])
        ax.figure.draw_without_rendering()
    assert "\N{MINUS SIGN}1.0" in [each.get_text() for each in ax.get_xticklabels()]
    assert not any("$" in each.get_text() for each in ax.get_yticklabels())
    assert r"\times\mathdefault{10^{9}}" in ax.yaxis.get_offset_text().get_text()


def test_a_window_keeps_its_size_while_its_figure_is_written(tmp_path: Path) -> None:
    figure = pyplot.figure(figsize=(2.0, 1.5), layout="constrained")
    figure.subplots()
    manager, engine = figure.canvas.manager, figure.get_layout_engine()
    assert manager is not None
    manager.resize = refuse  # type: ignore[method-assign]
    write(figure, tmp_path / "a.png")
    assert figure.canvas.manager is manager
    assert figure.get_layout_engine() is engine
    assert figure.dpi == pyplot.rcParams["figure.dpi"]


def refuse(*_: object) -> None:
    raise AssertionError("resized")


def test_a_sharp_posterior_leaves_its_prior_visible() -> None:
    """A posterior 500 times narrower than the prior made both invisible."""
    before, after = (np.random.default_rng(4).normal(0.6, width, 4000) for width in (0.1, 0.0002))
    ax = Figure().add_subplot()
    draw_parameter(ax, ParameterAxis(1.0, "mu_0", log=False), after, before, True)
    prior, posterior = ax.patches
    assert prior.get_data().values.max() > 0.15 * ax.get_ylim()[1]
    assert posterior.get_data().values.max() > 0.9 * ax.get_ylim()[1]


def test_a_prior_uniform_in_the_logarithm_is_level() -> None:
    """On an even axis it is a spike at the low end, and the posterior a sliver."""
    before, after = (10.0 ** np.linspace(low, high, 4000) for low, high in ((-3, -1), (-2.1, -1.9)))
    ax = Figure().add_subplot()
    draw_parameter(ax, ParameterAxis(1.0, "jitter", log=True), after, before, True)
    prior, posterior = (each.get_data() for each in ax.patches)
    assert ax.get_xscale() == "log"
    assert np.ptp(prior.values) < 0.1 * prior.values.mean()
    assert posterior.edges[[0, -1]] == pytest.approx(after[[0, -1]])
    ax.set_xlim(0.006, 0.015)  # a short axis has ticks
    assert sum(0.006 <= tick <= 0.015 for tick in ax.get_xticks()) >= 3


def test_labels_of_ticks_have_room_beside_a_panel_that_a_legend_makes_lower() -> None:
    fig = new_figure(7.0, 2.9)
    left, right = fig.subplots(1, 2)
    for at in range(6):
        right.plot([0.0, 1.0], [-0.4, 0.5 * at], label=f"line {at}")
    right.legend(loc="upper center", bbox_to_anchor=(0.42, -0.22))
    lay_out(fig)
    first = [ax.get_position().bounds for ax in (left, right)]
    lay_out(fig)
    again = [ax.get_position().bounds for ax in (left, right)]
    assert np.array(first) == pytest.approx(np.array(again), abs=1e-3)


@pytest.mark.parametrize(("count", "across"), [(1, 3), (4, 4), (5, 3), (6, 3), (7, 4), (9, 3)])
def test_rows_of_parameters_are_as_long_as_each_other(count: int, across: int) -> None:
    """Of five, four stood in a row and one below, beside an empty place for three."""
    panels = panels_of(None, count, 1.6)
    assert len(panels) == count
    places = [ax.get_subplotspec() for ax in panels]
    assert {each.get_gridspec().ncols for each in places if each is not None} == {across}


def test_times_to_a_slip_of_less_than_two_decades_do_not_touch() -> None:
    """A brake pad's 6 x 10^-4, 5 x 10^-4, ... of a second ran into one another."""
    pad = st.Slider(
        mass="350 g", k_x="1.8 MN/m", k_y="45 MN/m", phi="3 deg", normal_load="1.5 kN",
        c_x="20 N s/m", c_y="60 N s/m", drive=st.ConstantVelocity("1 m/s"),
        friction=st.ExponentialWeakening(0.45, 0.32, "0.5 m/s"),
    )  # fmt: skip
    found = st.analyse(st.simulate(pad, "50 ms", sample_rate="50 kHz"))
    assert found.curves is not None
    ax = st.plotting.plot_creep(found.curves, found.creep, V=1.0)
    low, high = sorted(ax.get_xlim())
    assert 10.0 < high / low < 100.0
    ax.figure.draw_without_rendering()
    ticks = [*ax.xaxis.get_major_ticks(), *ax.xaxis.get_minor_ticks()]
    seen = [each.label1 for each in ticks if low <= each.get_loc() <= high]
    boxes = [each.get_window_extent() for each in seen if each.get_text()]
    boxes.sort(key=lambda box: box.x0)
    assert len(boxes) > 1
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


@pytest.mark.parametrize(("least", "low", "end"), [(1e-3, 0.1, "min"), (0.05, 0.05, "neither")])
def test_swings_that_died_out_do_not_take_the_colours_of_the_others(least, low, end):
    """Six decades of them left two shades for a map of stick-slip."""
    values = np.geomspace(0.1, 10.0, 400).reshape(20, 20)
    values[0, :5] = least, *[1e-7 if least < 0.01 else 0.1] * 4
    shades = measure_shades(values)
    assert shades.log
    assert shades.limits == pytest.approx((low, 10.0), rel=0.2)
    side = Side(Scale("$\\mu$", 1.0, "1"), np.linspace(0.1, 0.2, 20), False)
    mesh, _ = draw_measure(mpl.figure.Figure().add_subplot(), side, side, values, "amplitude (N)")
    assert mesh.colorbar.extend == end
    low, high = measure_shades(np.array([[1e-9, 1.0]])).limits  # a bar must have a length
    assert low < high


def test_axes_without_names_are_refused_with_what_to_write(paper_run):
    _, axes = pyplot.subplots(2)
    for given in (axes[0], axes, list(axes)):
        with pytest.raises(st.DescriptionError, match=r"name those to draw, such as \{'force': ax"):
            st.plot(paper_run, given)
    assert st.plot(paper_run, {"force": axes[0]})["force"] is axes[0]


def test_a_slider_is_drawn_whatever_holds_it(slider):
    _, ax = pyplot.subplots()
    description = st.Description(slider, st.Initial(), st.Settings(duration=1.0))
    for each in (slider, description, st.Rig(slider)):
        assert st.plot(each, ax) is ax
    assert slider.plot(ax) is ax


@pytest.fixture(scope="module")
def turning() -> st.analysis.Analysis:
    run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
    return st.analyse(run)


def test_the_force_turns_on_its_arc_and_not_on_the_straight_line(
    turning: st.analysis.Analysis, tmp_path: Path
) -> None:
    figure = figure_of(st.plotting.plot_rotation, turning)
    ax, bar = figure.axes
    arc, straight = ax.get_lines()[:2]
    x, y = np.transpose(arc.get_xydata())
    assert np.hypot(x, y) == pytest.approx(turning.parts["rotation"].F_0)
    assert arc.get_linestyle() == "-" != straight.get_linestyle()
    (paths,) = ax.collections
    ways = paths.get_paths()
    assert len(ways) == turning.cycles.sizes["cycle"]
    for way in ways:  # its middle: the ring-down of a slip begins it, inertia ends it
        middle = way.vertices[20:60]
        assert np.hypot(*middle.T) == pytest.approx(np.hypot(x[0], y[0]), rel=0.02)
    assert len({tuple(each) for each in paths.cmap(paths.norm(paths.get_array()))}) == len(ways)
    assert bar.get_ylabel() == "time of the loading (s)"
    assert ax.get_aspect() == 1.0
    assert "Rotation of the force" in turning.write_html(tmp_path / "a.html").read_text("utf-8")
    assert "each loading a line" in (tmp_path / "a.html").read_text("utf-8")


def noisy_stick_slip() -> st.Record:
    """Return 19 cycles after a first loading, in noise of 0.4 % of the force."""
    time = np.arange(0.0, 20.0, 1e-3)
    cycle = (
        1.4
        + np.minimum((time - 2.0) % 0.93, 0.9)
        - 30.0 * np.maximum((time - 2.0) % 0.93 - 0.9, 0.0)
    )
    force = np.where(time < 1.97, 2.3 * time / 1.97, np.where(time < 2.0, 1.4, cycle))
    noise = 4e-3 * np.random.default_rng(6).standard_normal(len(time))
    return st.Record(time=time, force=force + noise, normal_load=4.0)


def test_the_peak_of_the_first_loading_is_marked_like_the_others() -> None:
    """Its trough was marked alone, though the table begins with its break-away."""
    record = noisy_stick_slip()
    axes = plot_cycles(record)
    found = st.analyse(record)
    peaks, troughs = (
        next(each for each in axes[0].lines if each.get_label() == name)
        for name in ("peak", "trough")
    )
    assert len(peaks.get_xdata()) == len(troughs.get_xdata()) == 1 + found.cycles.sizes["cycle"]
    assert peaks.get_xdata()[0] == pytest.approx(1.97, abs=0.01)
    assert peaks.get_ydata()[0] == pytest.approx(found.friction.break_away.force, abs=0.02)
    later = record.part(record.time > 2.2)  # a record that begins in a rise has its peak, too
    (cut, *_), drawn = st.analyse(later).cycles["start"].values, plot_cycles(later)
    first = next(each for each in drawn[0].lines if each.get_label() == "peak").get_xdata()[0]
    assert first < cut


def test_noise_on_slow_cycles_is_no_band_with_a_mean() -> None:
    """The rises were braided of a band, its edges and a mean, as if there were two forces."""
    axes = plot_cycles(noisy_stick_slip())
    assert not any(ax.collections for ax in axes)
    run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="10 kHz")
    song = st.Record(time=run.samples["time"], force=run.samples["spring_y"])
    ax = new_figure(4.0, 2.0).add_subplot()
    draw_line(ax, song.time, song.force)
    assert ax.collections


def test_an_arc_about_an_unknown_zero_ends_where_the_loadings_do(
    turning: st.analysis.Analysis,
) -> None:
    """A circle ran on beyond the data, and beside them, as if the fit was bad."""
    its = turning.parts["rotation"]._replace(kind="not determined", stated=False)
    figure = figure_of(st.plotting.plot_rotation, replace(turning, parts={"rotation": its}))
    ax, _ = figure.axes
    arc = ax.get_lines()[0]
    x, y = np.transpose(arc.get_xydata())
    (paths,) = ax.collections
    shown = np.concatenate([each.vertices for each in paths.get_paths()])
    assert shown[:, 1].min() < y.min() < y.max() < shown[:, 1].max()
    middle = np.concatenate([each.vertices[20:60] for each in paths.get_paths()])
    fits = np.hypot(*(middle[:, None] - np.transpose([x, y])[None]).T).min(axis=0)
    assert fits.max() < 0.02 * np.hypot(x, y).max()
    legend = [each.get_text() for each in ax.get_legend().get_texts()]
    assert any(each.startswith("best arc (fitted zero, ") for each in legend)


def test_the_force_of_an_aligned_rig_has_no_plane_to_draw() -> None:
    """An empty panel had a colour bar, an arc in its legend alone, and one name over another."""
    slider = st.presets.nakano_popov_2020().replace(phi="0 deg")
    found = st.analyse(st.simulate(slider, "5 s", sample_rate="1 kHz"))
    assert found.parts["rotation"] is not None
    assert "rotation" not in overview.figures(found)
    with pytest.raises(st.ResultError, match="it has no part across"):
        st.plotting.plot_rotation(found)


def test_names_of_arrows_that_lie_close_together_do_not_overlap() -> None:
    slider = st.presets.nakano_popov_2020().replace(phi="0.2 deg", k_y="20 kN/m")
    found = st.analyse(st.simulate(slider, "5 s", sample_rate="1 kHz"))
    figure = figure_of(st.plotting.plot_rotation, found)
    figure.canvas.draw()
    early, late = (
        each.get_window_extent()
        for each in figure.axes[0].texts
        if each.get_text() in ("early", "before slip")
    )
    assert not early.overlaps(late)


def test_colours_of_the_loadings_are_ordered_in_print() -> None:
    """Without colour a later loading is lighter, and the last stands out from the paper."""
    shades = TIMES(np.linspace(0.0, 1.0, 20))[:, :3] @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(shades) > 0.0).all()
    assert shades[-1] < 0.8


def test_a_record_without_the_force_across_has_no_figure_of_its_rotation(
    turning: st.analysis.Analysis,
) -> None:
    record = st.Record(time=turning.record.time, force=turning.record.force)
    found = st.analyse(record)
    assert "rotation" not in overview.figures(found)
    assert "rotation" in overview.figures(turning)
    with pytest.raises(st.ResultError, match="no rotation of the force to draw: the record has"):
        st.plotting.plot_rotation(found)


def test_an_overview_has_no_empty_panels(slider: st.Slider) -> None:
    """Of an aligned rock rig three of eight were empty, and rounding was a "fast oscillation"."""
    law = st.laws.RateStateAgeing(a=0.008, b=0.014, D_c="10 um", mu_star=0.6, V_star="1 um/s")
    rig = {"mass": 1.0, "k_x": 1e7, "k_y": 1e9, "phi": "0 deg", "normal_load": 5e3}
    rock = st.Slider(**rig, friction=law, drive=st.ConstantVelocity("10 um/s"))
    axes = st.simulate(rock, "60 s", sample_rate="20 Hz").plot()
    assert not {"direction", "stuck"} & axes.keys()
    assert len(axes["force"].get_legend().get_texts()) == 2
    axes = st.simulate(slider, "1 s", sample_rate="1 kHz").plot()
    assert {"direction", "stuck"} <= axes.keys()


def test_the_words_of_a_ramp_have_the_range_of_its_velocity(slider: st.Slider) -> None:
    p = st.protocols
    ramp = slider.replace(drive=p.DriveProgram(velocity=1e-4, program=[p.Ramp(5e-3, duration=2.0)]))
    assert "$V$ = 100 µm/s to 5 mm/s" in " ".join(system_in_words(ramp))
    assert "zeta" in " ".join(scales_in_words(slider))
    assert "zeta" not in " ".join(scales_in_words(ramp))  # which was that of the start
    assert "$V$ = 1 mm/s" in " ".join(system_in_words(slider))
