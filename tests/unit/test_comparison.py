"""One apparatus under several friction laws: the numbers, the names, the figure, the command."""

from __future__ import annotations

import dataclasses
from math import log
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import stiction as st
from stiction import comparison
from stiction.analysis import slip
from stiction.analysis.motion.cycles import find_cycles
from stiction.analysis.slip import averaged_slip, cell_force, is_undersampled, outcome
from stiction.cli import main
from stiction.comparison import comparable, exchange_law, read_laws, shared_traits
from stiction.friction import LAWS
from stiction.friction.equivalent import like, traits
from stiction.plotting.page.canvas import figure_of
from stiction.plotting.page.words import wrap_words
from stiction.plotting.run.comparison import LAST, MANY, legend_text, plot_comparison
from stiction.plotting.run.curves import BROAD, NARROW, RunCurve, curves_of, draw_curve
from stiction.result.peak import largest_spring_force
from stiction.result.table import as_table, fastest_slip
from stiction.simulation import automatic_times

WEAKENING = st.ExponentialWeakening(mu_0=0.20, mu_inf=0.15, v_f=0.01)
# a method of the law in `examples/mylaw.py`, which has lost all at 1000 v_c
LIKE = """
    @classmethod
    def like(kind, static, kinetic, speed):
        return kind(static, (static - kinetic) / log1p(1e3), speed / 1e3)
"""
PANELS = {"force", "words", "X", "speed", "portrait", "rest", "held"}


class Stribeck(NamedTuple):
    """A user's law: weakening, then viscous strengthening."""

    mu: float = 0.2

    def coefficient(law, v: float) -> float:
        return law.mu / (1 + v / 0.01) + 0.5 * v

    def slope(law, v: float) -> float:
        return -law.mu / 0.01 / (1 + v / 0.01) ** 2 + 0.5


class Logarithmic(NamedTuple):
    """What is looked at of a law with internal state: no coefficient at rest."""

    mu: float = 0.2

    @staticmethod
    def states() -> tuple[tuple[str, str, str], ...]:
        return (("age", "s", "age of the contacts"),)

    def coefficient(law, v: float) -> float:
        return law.mu - 0.005 * log(v / 1e-3)


@pytest.fixture(scope="module")
def described(slider: st.Slider) -> st.Description:
    settings = st.Settings(duration=0.2, sample_rate=10e3)
    return st.Description(slider, st.Initial(), settings)


@pytest.fixture(scope="module")
def runs(described: st.Description) -> dict[str, st.Trajectory]:
    """With true stick beside creep: the last has no misalignment to creep by."""
    found = st.compare(described, ["coulomb", '{law = "coulomb", mu_0 = 0.15}'])
    straight = described.slider.replace(phi="0 deg", friction=st.Coulomb(0.2))
    still = st.Initial(epsilon=0.0)
    return {**found, "held": st.simulate(straight, 0.2, sample_rate=10e3, initial=still)}


def command(*arguments: object) -> int:
    with pytest.raises(SystemExit) as end:
        main(["compare", *map(str, arguments)])
    return int(end.value.code or 0)


@pytest.fixture
def config(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A short run of the paper's system, in the current folder."""
    monkeypatch.chdir(tmp_path)
    path = Path("my.toml")
    with pytest.raises(SystemExit):
        main(["init", str(path)])
    path.write_text(path.read_text().replace('"5 s"', '"50 ms"'))
    return path


@pytest.mark.parametrize("column", [2, 4])
def test_times_and_speeds_of_the_table_have_up_to_three_digits(
    runs: dict[str, st.Trajectory], column: int
) -> None:
    shown = (comparison.row(*each, outcome(each[1])) for each in runs.items())
    cells = [row[column].split() for row in shown]
    digits = [len(number.replace(".", "").strip("0")) for number, _ in cells]
    assert max(digits) == 3
    assert {unit for _, unit in cells} & {"ms", "µm/s"}


# --- what makes laws comparable ---


@pytest.mark.parametrize("other", ["ageing", "slip", "perrin"])
def test_laws_of_rate_and_state_differ_in_the_change_of_their_state_only(other):
    """The critical stiffness (b - a) W/D_c was another one: a, b and V_star were made up."""
    known = {"a": 0.008, "b": 0.012, "D_c": 5e-6, "mu_star": 0.6, "V_star": 1e-6}
    slider = st.presets.nakano_popov_2020().replace(friction=st.laws.RateStateSlip(**known))
    described = st.Description(slider, st.Initial(), st.Settings(duration=1.0))
    assert comparable(LAWS[f"rate-and-state-{other}"], described)._asdict() == known


@pytest.mark.parametrize(
    ("law", "wanted"),
    [
        (WEAKENING, (0.20, 0.15, 0.01)),
        (st.ExponentialWeakening(0.15, 0.20, 1e-5), (0.15, 0.20, 1e-5)),  # strengthening
        (st.ExponentialWeakening(0.20, 0.20, 0.01), (0.20, 0.20, 1e-3)),  # no change: the drive's
        (st.Coulomb(0.15), (0.15, 0.15, 1e-3)),
        (st.Coulomb(0.15, 0.2), (0.20, 0.15, 1.27e-4)),  # at once: a thousandth of fast slip
        (st.ExponentialWeakening(0.20, 0.15, 0.01, 0.25), (0.25, 0.15, 0.00306853)),
    ],
)
def test_traits_of_known_laws(law: st.Coulomb, wanted: tuple[float, ...]) -> None:
    assert traits(law, 1e-3, 0.127) == pytest.approx(wanted, rel=2e-5)


def test_traits_of_a_law_that_strengthens_again_are_those_of_its_minimum() -> None:
    speeds = np.linspace(0, 0.127, 100_000)
    least = min(Stribeck().coefficient(speed) for speed in speeds)
    found = traits(Stribeck(), 1e-3, 0.127)
    assert found.static == 0.2
    assert found.kinetic == pytest.approx(least, rel=1e-5)
    part = (found.static - Stribeck().coefficient(found.speed)) / (found.static - found.kinetic)
    assert part == pytest.approx(1 - np.exp(-1), rel=1e-4)


def test_traits_of_a_law_with_state_are_those_of_its_steady_sliding() -> None:
    static, kinetic, speed = traits(Logarithmic(), 1e-3, 0.1)
    assert static == pytest.approx(0.2 + 0.005 * log(1e3))
    assert kinetic == pytest.approx(0.2 - 0.005 * log(1e2))
    assert log(speed / 1e-6) / log(1e5) == pytest.approx(1 - np.exp(-1), rel=1e-3)


@pytest.mark.parametrize("law", [WEAKENING, st.Coulomb(0.15), st.Coulomb(0.15, 0.2)])
def test_a_law_is_like_itself(described: st.Description, law: st.Coulomb) -> None:
    made = like(type(law), shared_traits(exchange_law(described, law)))
    assert [made.coefficient(v) for v in (0.0, 0.01, 0.1)] == pytest.approx(
        [law.coefficient(v) for v in (0.0, 0.01, 0.1)], rel=1e-4
    )


def test_a_law_that_cannot_be_like_another_says_what_to_write() -> None:
    with pytest.raises(st.DescriptionError, match="write a table with its parameters: mu_0"):
        like(type("Bare", (), {"_fields": ("mu_0",), "_field_defaults": {}}), (0.2, 0.1, 1.0))
    with pytest.raises(st.DescriptionError, match=r"0\.2 at rest.*mu_0, mu_inf, v_f"):
        like(st.ExponentialWeakening, traits(st.Coulomb(0.2), 0.0, 1.0)._replace(speed=-1.0))


# --- runs ---


def test_each_run_is_that_of_its_law_alone(
    runs: dict[str, st.Trajectory], described: st.Description
) -> None:
    labels = ["exponential-weakening", "coulomb, mu_static = 0.2", "coulomb"]
    assert list(runs) == [*labels, "held"]
    laws = (WEAKENING, st.Coulomb(0.15, 0.20), st.Coulomb(0.15))
    for run, law in zip(runs.values(), laws, strict=False):
        assert run.slider.law == law
        alone = st.simulate(described.slider.replace(friction=law), 0.2, sample_rate=10e3)
        np.testing.assert_array_equal(run.data["u_x"].values, alone.data["u_x"].values)


def test_laws_are_read_in_every_form(described: st.Description, tmp_path: Path) -> None:
    path = tmp_path / "other.toml"
    path.write_text('[friction]\nlaw = "coulomb"\nmu_0 = 0.17\n')
    forms = ["coulomb", ' {law = "coulomb", mu_0 = 0.15}', path, {"law": "coulomb", "mu_0": 0.16}]
    laws = read_laws(described, [*forms, st.Coulomb(0.18)])
    assert [law.mu_0 for law in laws] == [0.15, 0.15, 0.17, 0.16, 0.18]


def test_a_user_s_law_by_name_is_like_the_described_one_or_says_what_to_write(
    described: st.Description, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It said that three parameters were missing."""
    monkeypatch.chdir(tmp_path)
    text = (Path(__file__).parents[2] / "examples" / "mylaw.py").read_text("utf-8")
    Path("bare.py").write_text(text)
    with pytest.raises(st.DescriptionError, match=r"write a table with its parameters: mu_0, b, v"):
        read_laws(described, ["bare.py:Logarithmic"])
    Path("comparable.py").write_text(text + LIKE)
    (law,) = read_laws(described, ["comparable.py:Logarithmic"])
    shared = traits(described.slider.law, 1e-3, 0.1)
    assert law.mu_0 == pytest.approx(shared.static, rel=1e-3)
    assert law.coefficient(1e3 * law.v_c) == pytest.approx(shared.kinetic, rel=1e-3)


def test_a_law_by_name_is_in_proportion_to_the_apparatus(described: st.Description) -> None:
    names = ["lugre", "rate-and-state-ageing"]
    paper = read_laws(described, names)
    assert (paper[0].sigma_0, paper[0].sigma_1) == (1e5, 316.2)  # published, for some 1 N
    assert paper[1].D_c == 1e-5
    tip = described.slider.replace(mass=1e-11, k_x=0.5, k_y=40.0, normal_load=20e-9)
    small = read_laws(described._replace(slider=tip), names)
    assert small[0].sigma_0 == 50.0
    assert small[1].D_c == pytest.approx(20e-9 * 0.2 / 0.5 / 200.0)
    aged = st.laws.RateStateAgeing(0.008, 0.014, 3e-6, 0.6, 1e-6)
    rock = described._replace(slider=described.slider.replace(friction=aged))
    assert read_laws(rock, ["rate-and-state-slip"])[0].D_c == 3e-6  # as the described law has it


GENERAL = st.Slider(
    mass="0.3 kg", mass_y="0.8 kg", mass_angle="35 deg", k_x="1.1 kN/m", k_y="9 kN/m",
    c_x="3 N s/m", c_y="12 N s/m", damping_angle="-50 deg", cell_angle="20 deg", phi="25 deg",
    normal_load="10 N", friction=WEAKENING, drive=st.ConstantVelocity("20 mm/s"),
)  # fmt: skip
QUARTER = GENERAL.replace(
    k_x="9 kN/m", k_y="1.1 kN/m", phi="-65 deg", mass_angle="-55 deg", damping_angle="-140 deg"
)


def test_which_axis_is_called_x_changes_nothing_of_a_general_rig() -> None:
    """All axes are turned by a right angle, and so are laws by name, and their runs."""
    names = ["coulomb", "lugre", "rate-and-state-ageing"]
    settings = st.Settings(duration=0.2, sample_rate=500.0, rtol=1e-8)
    one, other = (
        st.compare(st.Description(each, st.Initial(), settings), names)
        for each in (GENERAL, QUARTER)
    )
    assert list(one) == list(other) == ["exponential-weakening", *names]
    assert one.ok
    for name, run in one.items():
        assert run.slider.law == other[name].slider.law
        for variable in ("X", "V_X", "mu"):
            a, b = (each.data[variable].values for each in (run, other[name]))
            # local errors differ, and grow while the mass slips
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-5 * np.abs(a).max())


def test_a_comparison_shows_the_force_of_the_load_cell() -> None:
    settings = st.Settings(duration=0.1, sample_rate=500.0)
    found = st.compare(st.Description(GENERAL, st.Initial(), settings), ["coulomb"])
    run = found["coulomb"]
    fine = st.simulate(run.slider, 0.1, sample_rate=2e5).data["mu"].values
    # from one sample to the next is 0.27 rad of the faster swing; the cubic between them is off by
    # x^4/384 of that
    assert outcome(run).peak == pytest.approx(np.abs(fine).max(), rel=0.27**4 / 384)
    assert "largest cell force/W" in found.tables()[0].table.headings
    ax = panels(figure_of(plot_comparison, found))
    assert ax["force"].get_ylabel() == ax["held"].get_xlabel() == "cell force (N)"
    drawn = max(np.abs(line.get_ydata()).max() for line in ax["force"].lines)
    forces = [each.data["mu"].values * 10.0 for each in found.values()]
    assert drawn == pytest.approx(max(np.abs(each).max() for each in forces), rel=1e-12)


@pytest.mark.parametrize("cycles", range(30, 100, 5))
def test_equal_swings_look_alike_whatever_the_width_of_the_line(cycles: int) -> None:
    """The broad line of the first law was a mean with a band where the others' were swings."""
    time = np.linspace(0.0, 1.0, 5001)
    bands = []
    for width in (NARROW, BROAD):
        look = {"color": "black", "linestyle": "solid", "linewidth": width, "zorder": 2.0}
        ax = Figure(figsize=(4.0, 2.0)).add_subplot()
        curve = RunCurve("", None, look, None)  # type: ignore[arg-type]
        draw_curve(ax, curve, time, np.sin(2.0 * np.pi * cycles * time))
        bands.append(len(ax.collections))
        assert ax.lines[0].get_linewidth() == width
    assert bands[0] == bands[1]


def test_the_name_of_the_described_law_means_that_law_once(described: st.Description) -> None:
    assert read_laws(described, ["exponential-weakening"])[0] is described.slider.law
    short = described._replace(run=st.Settings(duration=0.01, sample_rate=1e3))
    assert list(st.compare(short, ["exponential-weakening"])) == ["exponential-weakening"]


def test_labels_tell_repeated_laws_apart() -> None:
    laws = [WEAKENING, st.Coulomb(0.15), st.Coulomb(0.15), st.Coulomb(0.15 + 1e-9), Stribeck()]
    assert comparison.labels(laws) == [
        "exponential-weakening",
        "coulomb",
        "coulomb (2)",
        "coulomb (3)",
        "Stribeck",
    ]
    assert comparison.labels([WEAKENING, WEAKENING._replace(v_f=0.05)])[1].endswith(", v_f = 0.05")


def test_a_parameter_that_is_not_set_is_no_part_of_a_name():
    own, other = st.Coulomb(0.2, mu_static=0.2), st.Coulomb(0.15)
    named = ["coulomb, mu_0 = 0.2, mu_static = 0.2", "coulomb, mu_0 = 0.15"]  # not mu_static = 0
    assert comparison.labels([own, other]) == named
    around = [st.laws.Anisotropic(law, 1.5) for law in (own, other)]
    assert comparison.labels(around) == [f"anisotropic {each}" for each in named]


def test_every_wrong_law_is_reported(described: st.Description, tmp_path: Path) -> None:
    empty = tmp_path / "empty.toml"
    empty.write_text("")
    wrong = [
        "coulom",
        '{law = "coulomb", mu_0 = -1, mu = 2}',
        '{law = "coulomb" mu_0',
        "none.toml",
        empty,
        "",
        3.0,
        {"law": "coulomb"},
    ]
    with pytest.raises(st.DescriptionError) as error:
        st.compare(described, ["coulomb", *wrong])
    lines = str(error.value).splitlines()
    assert len(lines) == 9
    for line, start, remedy in zip(
        lines,
        [*wrong[:2], *wrong[1:5], "7", "8", "9"],
        [
            "did you mean 'coulomb'?",
            "mu_0: must not be below 0, is -1",
            "mu: unknown key 'mu'; did you mean 'mu_0' or 'mu_static'?",
            "write for example '{law = ",
            "No such file",
            "has no table [friction]",
            "known: coulomb",
            "write for example st.Coulomb",
            "mu_0: missing",
        ],
        strict=True,
    ):
        assert line.startswith(f"law {start}: "), line
        assert remedy in line


def test_progress_covers_all_runs(described: st.Description) -> None:
    seen: list[float] = []
    st.compare(described, "coulomb", progress=seen.append)
    assert seen == sorted(seen)
    assert 0 < seen[0] <= 0.5
    assert seen[-1] == pytest.approx(1.0)


# --- numbers behind the picture ---


def test_outcome_tells_creep_from_rest(runs: dict[str, st.Trajectory]) -> None:
    creep, _, constant, held = map(outcome, runs.values())
    rotation = 1e-3 * np.sin(np.radians(1.0))  # V sin(phi)
    for found in (creep, constant):
        assert found.creep == pytest.approx(rotation, rel=0.03)
        assert found.slowest == 0.0  # before the spring across is loaded, and in between
    assert held.creep == held.slowest == held.fastest == 0.0
    assert held.sticks == 1
    assert held.time_stuck == pytest.approx(0.2)
    assert creep.peak == pytest.approx(0.02, rel=0.01)  # V t k_x/W
    assert creep.status.ok


def test_a_mass_at_rest_has_no_creep_by_rounding_and_one_sample_has_its_speed(
    slider: st.Slider,
) -> None:
    """Places of 3 mm are known to 1e-18 m, over hundredths of a second."""
    assert outcome(st.simulate(slider.replace(phi="0 deg"), 3.0, sample_rate=1e3)).creep == 0.0
    one = st.simulate(slider, 1e-6, sample_rate=1e3)
    assert outcome(one).creep == one.samples["slip_speed"][0] > 0.0


def test_the_speed_at_the_release_is_not_the_slowest_slip(slider: st.Slider) -> None:
    """It is the description's epsilon V, 1 nm/s."""
    law = st.laws.LuGre(0.15, 0.2, "10 mm/s", sigma_0=1e5, sigma_1=316.0)
    assert outcome(st.simulate(slider.replace(friction=law), 0.2, sample_rate=1e3)).slowest > 1e-6


@pytest.mark.parametrize(("rate", "shown"), [(3.5, False), (1e3, True)])
def test_slips_between_samples_are_not_said_to_be_slow(
    slider: st.Slider, rate: float, shown: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two days of a shear frame at 1 Hz had a "fastest slip" of 0 m/s beside four slips."""
    run = st.simulate(slider, 5.0, sample_rate=rate)
    found = outcome(run)
    assert not found.hidden
    assert found.fastest == pytest.approx(26.29e-3, rel=1e-3)  # 16 samples in a step
    assert not any(cell.startswith("> ") for cell in comparison.row("own", run, found))
    monkeypatch.setattr(slip, "MOST_STEPS", 100)  # if the run has too many to be solved again
    bound = outcome(run)
    assert bound.hidden != shown
    assert 3e-3 < bound.fastest < 26.4e-3  # at least 0.9 mm in a sample
    cells = comparison.row("own", run, bound)
    assert any(cell.startswith("> ") for cell in cells) != shown


@pytest.mark.parametrize("rate", [3.0, 4.0, 5.0])
def test_a_sample_by_chance_in_a_slip_is_not_its_fastest(rate: float) -> None:
    """A rock slips for 10 ms: where one of twelve had a sample near its peak, that counted."""
    rock = st.Slider(
        mass=1.0, k_x="200 kN/m", k_y="20 MN/m", phi="1 deg", normal_load="5 kN",
        friction=st.laws.RateStateAgeing(0.008, 0.014, "10 um", 0.6, "1 um/s"),
        drive=st.ConstantVelocity("1 um/s"),
    )  # fmt: skip
    run = st.simulate(rock, 20e3, sample_rate=rate)
    chance, shown = fastest_slip(run.samples)
    assert not shown
    assert chance < 0.87
    found = outcome(run)
    assert not found.hidden
    assert found.fastest == pytest.approx(0.88828, rel=1e-3)  # peak_velocity of a study


@pytest.mark.parametrize("rate", [500.0, 700.0, 1e3, 1e4])
def test_the_median_creep_does_not_depend_on_the_samples(slider: st.Slider, rate: float) -> None:
    """At 1 kHz, the frequency of the oscillation, it was 23 % too large; 93 % on a random rig."""
    run = st.simulate(slider.replace(friction=st.Coulomb(0.2)), 0.5, sample_rate=rate)
    # over hundredths of five periods each, of which a part more or less is counted
    assert outcome(run).creep == pytest.approx(1.7583e-5, rel=0.01)


def test_the_largest_coefficient_may_lie_between_samples(slider: st.Slider) -> None:
    """40 samples in a swing of a harmonic vibration are up to 3e-3 of its size below its peak."""
    swings = slider.natural_frequencies[0]
    runs = [
        st.simulate(slider, 3.0, sample_rate=rate, initial=st.Initial(u_x="2 mm"))
        for rate in (40.0 * swings, 4000.0 * swings)
    ]
    coarse, fine = (outcome(run).peak for run in runs)
    assert coarse == pytest.approx(fine, rel=1e-5)
    load = slider.normal_load
    assert coarse == largest_spring_force(runs[0].samples, slider.k_x).force / load
    assert max(abs(cell_force(runs[0]))) / load < (1.0 - 1e-5) * fine


def test_averages_keep_the_distance_and_the_peaks(runs: dict[str, st.Trajectory]) -> None:
    run = runs["exponential-weakening"]
    speed = run.data["slip_speed"].values
    slip = averaged_slip(run, 20)
    assert slip.high.max() == speed.max()
    late = slip.time > 0.03
    assert slip.mean[late].mean() == pytest.approx(speed[300:].mean(), rel=0.01)
    assert np.ptp(slip.mean[late]) < 0.1 * np.ptp(speed[300:])  # free of the oscillation
    assert (slip.high >= slip.mean).all()
    assert not averaged_slip(runs["held"], 20).mean.any()  # zero stays zero
    single = averaged_slip(run, 10_000)
    np.testing.assert_array_equal(single.mean, speed)


def test_too_few_samples_make_no_beats(described: st.Description) -> None:
    """A mass that sticks 950 times a second, seen at rates that nearly divide that."""
    for rate in (190.0, 237.0, 316.0):
        fine = st.simulate(described.slider, "0.5 s", sample_rate=100.0 * rate).data
        x, y = (fine[name].values[::100] for name in ("X", "Y"))
        coarse = st.simulate(described.slider, "0.5 s", sample_rate=rate)
        slip = averaged_slip(coarse, 500)
        moved = np.hypot(x[2:] - x[:-2], y[2:] - y[:-2]) * rate / 2.0
        np.testing.assert_allclose(slip.mean[1:-1], moved, rtol=1e-6)  # samples change no step
        assert np.ptp(slip.mean[10:]) < 0.2 * slip.mean[10:].mean()
        by_chance = coarse.data["slip_speed"].values[10:]
        assert np.ptp(by_chance) > by_chance.mean()


def test_slips_shorter_than_a_sample_are_not_seen() -> None:
    """A slip lasts half a period of the mass on its spring at least, here 50 ms."""
    slider = st.Slider(
        mass="0.25 kg", k_x="1 kN/m", k_y="10 MN/m", phi="0 deg", normal_load="10 N",
        friction=st.Coulomb(mu_0=0.15, mu_static=0.2), drive=st.ConstantVelocity("1 mm/s"),
    )  # fmt: skip
    for rate, unseen in ((10.0, True), (1e3, False)):
        assert is_undersampled(st.simulate(slider, "20 s", sample_rate=rate)) == unseen


# --- figure ---


def panels(fig: Figure) -> dict[str, Axes]:
    """Draw it for real; return the axes by their names."""
    fig.set_dpi(60)
    fig.draw_without_rendering()
    return {ax.get_label(): ax for ax in fig.axes}


def test_the_figure_has_units_on_every_axis(runs: dict[str, st.Trajectory]) -> None:
    ax = panels(figure_of(plot_comparison, runs))
    assert set(ax) == PANELS
    assert ax["force"].get_ylabel() == "$k_x u_x$ (N)"
    assert ax["X"].get_ylabel() == "$X$ (µm)"
    assert ax["speed"].get_ylabel().endswith("(m/s)")
    assert ax["rest"].get_xlabel() == "time $t$ (s)"
    assert ax["held"].get_xlabel() == "$k_x u_x$ (N)"
    assert ax["speed"].get_yscale() == ax["portrait"].get_yscale() == "log"
    assert ax["speed"].get_ylim() == ax["portrait"].get_ylim()
    looks = {(line.get_color(), str(line.get_linestyle())) for line in ax["force"].lines}
    assert len(looks) == len(runs)


def test_a_phase_portrait_of_many_cycles_shows_the_last_ones() -> None:
    run = st.simulate(st.presets.nakano_popov_2020(), "12 s", sample_rate="1 kHz")
    cycles = find_cycles(run)
    assert cycles.sizes["cycle"] > MANY
    axes = {"portrait": Figure().subplots()}
    ax = plot_comparison({"paper": run}, axes)["portrait"]
    force = ax.lines[0].get_xdata()
    assert force.min() > 0.9 * cycles["trough"].values.min()  # not the first loading
    assert np.count_nonzero(np.diff(np.sign(force - 1.6))) == pytest.approx(2 * LAST, abs=1)


def test_a_mass_that_rests_has_no_position_of_rounding(described: st.Description) -> None:
    settings = st.Settings(duration=1e-3, sample_rate=1e5)
    short = st.Description(described.slider, described.initial, settings)
    ax = panels(figure_of(plot_comparison, st.compare(short, ["coulomb"])))
    assert all(not line.get_ydata().any() for line in ax["X"].lines)


def test_runs_that_never_slip_say_so_and_have_no_empty_axis(described: st.Description) -> None:
    settings = st.Settings(duration=1e-3, sample_rate=1e5)
    short = st.Description(described.slider, described.initial, settings)
    found = st.compare(short, ["coulomb"])
    ax = panels(figure_of(plot_comparison, found))
    for name, said in (("X", "at rest"), ("speed", "no slip"), ("portrait", "no slip")):
        assert [text.get_text() for text in ax[name].texts] == [said]
        assert not len(ax[name].get_yticks()) + len(ax[name].get_yticks(minor=True))
    for name in ("speed", "portrait"):
        assert all(np.isnan(line.get_ydata()).all() for line in ax[name].lines)
    legend = [text.get_text() for text in ax["words"].get_legend().get_texts()]
    assert all(each.endswith("no slip") for each in legend)
    fastest = found.tables()[0].table.rows[0][4]
    assert fastest == "0 m/s"  # not the speed of the release, which a rest follows at once


def test_zero_slip_is_shown_as_such(runs: dict[str, st.Trajectory]) -> None:
    ax = panels(figure_of(plot_comparison, runs))
    heights = [patch.get_data() for patch in ax["rest"].patches]
    shares = [stairs.values - stairs.baseline for stairs in heights]
    assert shares[3] == pytest.approx(0.8)  # held all the time: a full row
    total = sum(shares[1] / 0.8 * np.diff(heights[1].edges))
    assert total == pytest.approx(runs["coulomb, mu_static = 0.2"].statistics.time_stuck)
    assert np.isnan(ax["speed"].lines[3].get_ydata()).all()  # and no place among the decades
    held = ax["held"].patches[3].get_data()
    assert max(held.values - held.baseline) == pytest.approx(0.8)


def test_speeds_over_many_decades_have_a_readable_axis(runs: dict[str, st.Trajectory]) -> None:
    run = runs["exponential-weakening"]
    data = run.data.copy(deep=True)
    data["slip_speed"].values[:] = np.geomspace(1e-20, 1e-1, data.sizes["time"])
    wide = dataclasses.replace(run, arrays=lambda: as_table(data))
    ax = panels(figure_of(plot_comparison, runs | {"wide": wide}))["speed"]
    low, high = ax.get_ylim()
    assert 1e-10 < low < 1e-9  # a millionth of the drive's speed: what is slower rests
    assert high > 0.1

    ticks = [tick for tick in ax.get_yticks() if low < tick < high]
    assert 4 <= len(ticks) <= 9


def test_a_run_that_ended_early_is_marked(described: st.Description) -> None:
    runs = st.compare(described, ["coulomb"], max_steps=40)
    ended = [curve for curve in curves_of(runs) if not curve.run.status.ok]
    assert ended
    assert "× ended early at" in legend_text(ended[0])
    assert "too many steps" in legend_text(ended[0])
    ax = panels(figure_of(plot_comparison, runs))
    for name in ("force", "X", "speed", "portrait"):
        crosses = [line for line in ax[name].lines if line.get_marker() == "x"]
        assert len(crosses) == len(ended)


@pytest.mark.parametrize("rate", [None, "20 Hz"])
def test_few_samples_and_no_drive_are_drawn(described: st.Description, rate: str | None) -> None:
    still = described.slider.replace(drive=st.ConstantVelocity(0.0))
    settings = st.Settings(duration=0.2, **({} if rate is None else {"sample_rate": rate}))
    runs = st.compare(st.Description(still, st.Initial(), settings), ["coulomb"])
    ax = panels(figure_of(plot_comparison, runs))
    assert len(ax["force"].lines) == len(runs)
    assert not any(np.any(line.get_ydata()) for line in ax["force"].lines)  # it rests all the time
    for row in range(len(runs)):
        held = ax["rest"].patches[row].get_data()
        assert max(held.values - held.baseline) == pytest.approx(0.8)


def test_legends_are_broken_between_parameters() -> None:
    words = [rf"$\mu_{k}$ = 0.123{k}" for k in range(9)]
    lines = wrap_words(words, 30)
    assert len(lines) > 1
    assert " ".join(lines) == ", ".join(words)
    assert all(line.endswith(",") for line in lines[:-1])


# --- command ---


def test_compare_draws_and_tabulates(
    config: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    names = ("exponential", "coulomb")
    capsys.readouterr()
    table = '{law = "coulomb", mu_0 = 0.15}'
    assert command(config, "--law", "coulomb", "--law", table, "-o", "a.png", "--data", "runs") == 0
    text = capsys.readouterr().out
    assert Path("a.png").read_bytes().startswith(b"\x89PNG")
    rows = [line.rsplit(maxsplit=10) for line in text.splitlines() if line.startswith(names, 1)]
    assert [row[0].strip() for row in rows] == [
        "exponential-weakening",
        "coulomb, mu_static = 0.2",
        "coulomb",
    ]
    paths = sorted(Path("runs").iterdir())
    assert [path.name for path in paths] == [
        "1-exponential-weakening.nc",
        "2-coulomb-mu_static-0.2.nc",
        "3-coulomb.nc",
    ]
    for path, row in zip(paths, rows, strict=True):
        assert str(path) in text
        run = st.load(path)
        assert str(run.statistics.stick_count) == row[1]
    assert {path.name for path in Path().iterdir()} == {"my.toml", "a.png", "runs"}


def test_compare_samples_where_the_description_does_not(
    config: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = config.read_text()
    config.write_text("\n".join(line for line in text.splitlines() if "sample_rate" not in line))
    given = []
    whole = comparison.run
    monkeypatch.setattr(comparison, "run", lambda d, **more: given.append(d) or whole(d, **more))
    assert command(config, "--law", "coulomb", "-o", "a.png") == 0
    samples = len(automatic_times(st.Description.from_toml(config))) - 1  # as of `simulate`
    assert [d.run.sample_rate for d in given] == [samples / 0.05] * 2


def test_compare_says_when_a_run_ended_early(
    config: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = comparison.run
    monkeypatch.setattr(comparison, "run", lambda d, **more: whole(d, **(more | {"max_steps": 50})))
    assert command(config, "--law", "coulomb", "-o", "a.png") == 1
    assert "exponential-weakening ended early: the run used up" in capsys.readouterr().out
    assert Path("a.png").is_file()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--law", "coulom", "--law", "none.toml", "-o", "a.png"), ["did you mean", "No such"]),
        (("--law", "coulomb", "-o", "a.bmp"), ["unknown format '.bmp'; use .png"]),
        (("--law", "coulomb", "-o", "no/a.png"), ["make it first"]),
        (("--law", "coulomb", "-o", "a.png", "--data", "my.toml"), ["not a folder"]),
        (("--law", "coulomb", "-o", "a.png", "--data", "no/runs"), ["make it first"]),
    ],
)
def test_what_is_wrong_is_one_message_and_nothing_is_written(
    config: Path,
    arguments: tuple[str, ...],
    words: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(comparison, "run", None)  # nothing is simulated in vain
    assert command(config, *arguments) == 2
    text = capsys.readouterr().err
    for word in words:
        assert word in text
    assert "Traceback" not in text
    assert [path.name for path in Path().iterdir()] == ["my.toml"]


def test_a_figure_that_cannot_be_drawn_leaves_the_old_one(
    config: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("a.png").write_text("old")

    def failing(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", failing)
    assert command(config, "--law", "coulomb", "-o", "a.png") == 2
    assert Path("a.png").read_text() == "old"
    assert {path.name for path in Path().iterdir()} == {"my.toml", "a.png"}


@pytest.mark.parametrize(
    ("program", "low", "high"),
    [
        ([st.protocols.Ramp("20 N", "3 s")], 0.14, 0.2),
        ([st.protocols.Constant(duration="2 s"), st.protocols.Step(to="2 N")], 0.9, 1.0),
    ],
)
def test_the_largest_ratio_of_force_and_load_is_told(
    program: list[Any], low: float, high: float
) -> None:
    """It was 0.2495 under a load that doubles, over the first load, and 0.197 under one that falls,
    at the largest force."""
    load = st.protocols.LoadProgram(program=program)
    rig = st.presets.nakano_popov_2020().replace(load=load)
    run = st.simulate(rig, "3 s", sample_rate="1 kHz")
    ratio = np.abs(run.samples["spring_x"]) / run.samples["normal_load"]
    assert outcome(run).peak == pytest.approx(ratio.max(), rel=1e-12)
    assert low < ratio.max() < high
