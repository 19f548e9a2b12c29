"""The figures of stability are drawn, and show their data."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import stiction as st
from stiction import theory
from stiction.linear_stability import boundary, critical, modes_over
from stiction.linear_stability.axis import axis
from stiction.plotting.page.canvas import figure_of
from stiction.plotting.page.parameter import parameter_symbol, scale_of
from stiction.plotting.stability.boundary import plot_boundary, signed_distance
from stiction.plotting.stability.modes import plot_modes
from stiction.plotting.stability.onset import plot_onset

PAPER = st.presets.nakano_popov_2020()
PLANE = {"x_between": ("0 deg", "25 deg"), "y_between": ("0.1 mm/s", "100 mm/s")}


def draw(fig: Figure) -> Figure:
    fig.set_dpi(60)
    fig.draw_without_rendering()
    return fig


def test_the_map_names_both_sides_and_marks_the_slider():
    speeds = np.geomspace(1e-4, 0.1, 50)
    mu, slope = ([f(v) for v in speeds] for f in (PAPER.law.coefficient, PAPER.law.slope))
    known = theory.critical_misalignment(speeds, mu, slope)
    curve = boundary(PAPER, "phi", "drive.velocity", **PLANE)
    (ax,) = draw(figure_of(plot_boundary, curve, (known, speeds))).axes
    places = {text.get_text(): text.get_position() for text in ax.texts}
    assert places.keys() == {"stable", "unstable"}
    for name, (x, y) in places.items():  # fractions of the axes: is it so there?
        slider = PAPER.replace(
            phi=f"{25 * x} deg", drive=st.ConstantVelocity(f"{0.1 * 1000**y} mm/s")
        )
        assert (st.linear_stability.growth_rate(slider) > 0) == (name == "unstable")
    assert (ax.get_xlabel(), ax.get_ylabel()) == (r"$\varphi$ (deg)", "$V$ (mm/s)")
    own = next(line for line in ax.lines if line.get_label() == "this slider")
    assert own.get_xydata() == pytest.approx(np.array([[1.0, 1.0]]))


def test_a_drive_the_other_way_has_the_same_map():
    """Over the size of its velocity, on a logarithmic axis."""
    back = PAPER.replace(drive=st.ConstantVelocity("-1 mm/s"))
    other = {"x_between": PLANE["x_between"], "y_between": ("-100 mm/s", "-0.1 mm/s")}
    drawn = []
    for slider, plane in ((PAPER, PLANE), (back, other)):
        curve = boundary(slider, "phi", "drive.velocity", **plane)
        (ax,) = draw(figure_of(plot_boundary, curve)).axes
        (line,) = (each for each in ax.lines if each.get_label() == "boundary")
        phi, speed = np.array(sorted(line.get_xydata(), key=lambda point: point[1])).T
        drawn.append(np.interp([20.0, 40.0, 60.0, 80.0], speed, phi))
        assert (ax.get_yscale(), sorted(ax.get_ylim())) == ("log", pytest.approx([0.1, 100.0]))
    assert ax.get_ylabel() == "−$V$ (mm/s)"
    # chords of 0.02 of the plane, 0.5 deg, along a curve whose radius is a tenth of it or more
    assert drawn[1] == pytest.approx(drawn[0], abs=0.5 * 0.02 / (8.0 * 0.1))


def test_a_plane_without_a_boundary_is_named_as_a_whole():
    slider = PAPER.replace(friction=st.Coulomb(mu_0=0.2))
    curve = boundary(slider, "phi", "mass", x_between=("1 deg", "89 deg"))
    (ax,) = draw(figure_of(plot_boundary, curve)).axes
    assert [text.get_text() for text in ax.texts] == ["stable"]


def test_modes_have_the_critical_value_marked():
    between = ("1 deg", "30 deg")
    found = critical(PAPER, "phi", between)
    above, below = draw(figure_of(plot_modes, modes_over(PAPER, "phi", between), found)).axes
    assert r"$\varphi$ = 8.656°" in [text.get_text() for text in above.texts]
    assert (above.get_ylabel(), below.get_ylabel()) == ("growth rate (1/s)", "frequency (Hz)")
    assert below.get_xlabel() == r"$\varphi$ (deg)"


def test_the_onset_shows_both_sweeps_and_the_hysteresis():
    law = st.laws.Stribeck(mu_s=0.3, mu_c=0.15, v_s="20 mm/s")
    slider = PAPER.replace(phi="0 deg", k_y=2e3, friction=law, drive=st.ConstantVelocity("36 mm/s"))
    c = -law.slope(0.036) * slider.normal_load
    found = st.analysis.find_onset(slider, "c_x", [0.8 * c, 1.2 * c, 2.2 * c])
    assert found.kind == "hard"
    fig = draw(figure_of(plot_onset, found, critical=c))
    (ax,) = fig.axes
    labels = {text.get_text() for legend in [ax.get_legend()] for text in legend.get_texts()}
    known = {"swept up", "swept down", "hysteresis", "linear: $c_{x}$ = 10.57 N s/m"}
    assert labels == known | {"undecided"}
    assert ax.get_ylabel() == "amplitude along the drive (mm)"


def test_parameters_have_symbols_and_units():
    assert parameter_symbol("k_x, k_y") == "$k_{x}$ = $k_{y}$"
    assert parameter_symbol("load.modulation.frequency") == "load modulation frequency"
    assert parameter_symbol("load.program.1.to, run.duration") == "load program 1 to = run duration"
    assert parameter_symbol("springs.load-cell.k_x") == "load cell $k_{x}$"
    assert scale_of("k_x", "N/m", (1e3, 5e3)).label == "$k_{x}$ (kN/m)"
    assert scale_of("drive.velocity", "m/s", (1e-6, 1.0), logarithmic=True).unit == "mm/s"
    assert scale_of("phi", "rad", (0.0, 1.0)).quantity(np.radians(8.0)) == r"$\varphi$ = 8°"


VELOCITY = {"x": "drive.velocity", "x_between": ("0.01 mm/s", "1 m/s")}
STIFFNESS = {"x": "k_y", "x_between": (1e3, 1e8)}
MIRRORED = {"y": "phi", "y_between": ("-89 deg", "89 deg")}
AGEING = st.laws.RateStateAgeing(0.01, 0.015, 1e-5, 0.6, 1e-6)
TILTED = PAPER.replace(phi="5 deg")
PLANES = {  # slider, plane, connected curves
    "anisotropic": (
        TILTED.replace(friction=st.laws.Anisotropic(PAPER.law, 1.3, "20 deg")),
        VELOCITY | {"y": "k_y", "y_between": (1e3, 1e8)},
        2,
    ),
    "Stribeck": (
        TILTED.replace(friction=st.laws.Stribeck(0.3, 0.15, "10 mm/s")),
        STIFFNESS | MIRRORED,
        2,
    ),
    "ageing": (TILTED.replace(friction=AGEING), STIFFNESS | MIRRORED, 2),
    "corners": (TILTED.replace(friction=AGEING, k_y=1.54e6, c_x=18.75), VELOCITY | MIRRORED, 3),
}


@pytest.mark.parametrize("name", PLANES)
def test_no_piece_of_the_boundary_is_missing(name):
    """The side that a point is on, as the curves have it, is that of its eigenvalues."""
    slider, plane, branches = PLANES[name]
    curve = boundary(slider, **plane)
    assert len(np.unique(curve["branch"])) == branches
    grid = (np.arange(12) + 0.5) / 12
    across, up = np.meshgrid(grid, grid)
    signed = signed_distance(curve, across, up)
    x, y = (axis(slider, plane[way], plane[f"{way}_between"]) for way in "xy")
    for a, b, side in zip(across.flat, up.flat, signed.flat, strict=True):
        growth = st.linear_stability.growth_rate(y.on(x.on(slider, a), b))
        assert (growth > 0) == (side > 0) or abs(side) < 1e-3  # how far a chord may be off


def test_numbers_of_close_critical_values_stand_apart():
    law = st.ExponentialWeakening(mu_0=0.35, mu_inf=0.22, v_f="5 mm/s")
    rig = {"mass": 0.2, "k_x": 150, "k_y": 6e4, "phi": "0.5 deg", "normal_load": 2}
    soft = st.Slider(**rig, friction=law, drive=st.ConstantVelocity("2 mm/s"))
    found = st.stability(soft, over="phi")
    fig = draw(figure_of(plot_modes, found.modes, found.criticals[0]))
    first, second = (text.get_window_extent() for text in fig.axes[0].texts)
    assert first.x1 < second.x0


@pytest.mark.parametrize(
    ("k_y", "labels"),
    [("10 MN/m", {"1", "10", "100", "1000"}), ("200 kN/m", {"10", "20", "50", "100"})],
)
def test_modes_without_a_critical_value_are_drawn_and_frequencies_labelled_alike(k_y, labels):
    rig = PAPER.replace(k_y=k_y, friction=st.Coulomb(mu_0=0.2), phi="3 deg")
    found = st.stability(rig, over="phi", between=("1 deg", "89 deg"))
    assert not len(found.criticals[0].values)
    above, below = draw(figure_of(found.plot)).axes
    assert not above.texts
    low, high = below.get_ylim()
    ticks = [*below.get_yticklabels(), *below.get_yticklabels(minor=True)]
    shown = {text.get_text() for text in ticks if low <= text.get_position()[1] <= high} - {""}
    assert shown, ticks
    assert shown <= labels, shown
