"""A part of a run is drawn as large as the whole."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis.measurement.excerpt import excerpt
from stiction.cli import main
from stiction.result.window import window_of

PAPER = st.presets.nakano_popov_2020()


def inside(*arguments: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(each) for each in arguments])
    return int(end.value.code or 0)


@pytest.fixture(scope="module")
def run() -> st.Trajectory:
    return st.simulate(PAPER, "20 ms", sample_rate="10 kHz")


def test_a_part_of_a_run_has_its_samples_and_rests(run):
    part = excerpt(run, ("5 ms", 0.010))
    assert part.samples["time"].tolist() == run.samples["time"][50:101].tolist()
    assert part.samples["u_x"].tolist() == run.samples["u_x"][50:101].tolist()
    within = run.stick_intervals.clip(0.005, 0.010)
    assert np.ptp(part.stick_intervals, axis=1).sum() == np.ptp(within, axis=1).sum() > 0.0
    assert part.stick_intervals.min() >= 0.005
    assert part.stick_intervals.max() <= 0.010
    assert (np.ptp(part.stick_intervals, axis=1) > 0.0).all()
    assert excerpt(run, None) is run
    duration = PAPER, st.Initial(), st.Settings(duration=0.3)
    assert window_of(st.Description(*duration), (0.0, 0.1 + 0.2)) == (0.0, 0.3)  # but for rounding


def test_a_window_fills_the_panels_and_the_words_name_it(run):
    panels = st.plot(run, window=("5 ms", "10 ms"))
    assert panels["force"].get_xlim() == pytest.approx((0.005, 0.010))
    lines = [text.get_text() for text in panels["words"].texts]
    assert lines.index("5 ms to 10 ms shown") == lines.index("20 ms simulated") + 1
    base = st.Description(PAPER, st.Initial(), st.Settings(duration="20 ms"))
    panels = st.plot(st.compare(base, ["coulomb"]), window=("5 ms", "10 ms"))
    assert panels["rest"].get_xlim() == pytest.approx((0.005, 0.010), rel=1e-3)


def test_a_run_that_broke_off_later_has_no_early_end_in_the_window():
    early = st.simulate(PAPER, "20 ms", sample_rate="10 kHz", max_steps=30)
    end = early.samples["time"][-1]
    assert not early.status.ok
    assert excerpt(early, (0.0, 0.5 * end)).status.ok
    assert not excerpt(early, (0.5 * end, 0.020)).status.ok
    red = early.plot(window=(0.0, 0.5 * end))["words"].texts
    assert any(text.get_text().startswith("the run used up its") for text in red)


def test_of_runs_that_are_compared_the_one_without_the_window_is_named(run):
    early = st.simulate(PAPER, "20 ms", sample_rate="10 kHz", max_steps=10)
    late = ("15 ms", "20 ms")
    with pytest.raises(st.StictionError, match=r"^broken off: window: 0.+ has 0 of the"):
        st.plotting.plot_comparison({"whole": run, "broken off": early}, window=late)


@pytest.mark.parametrize(
    ("window", "message"),
    [
        (("5", "10 ms"), "^window: '5' has no unit; write for example"),
        (("10 ms", "5 ms"), "window must end after it starts, is 0.01 s to 0.005 s"),
        (("5 ms",), r"window must be a start and an end, is \('5 ms',\); write for example"),
        (0.005, "window must be a start and an end, is 0.005"),
        (("5.01 ms", "5.09 ms"), "window: 0.00501 s to 0.00509 s has 0 of the run's samples"),
    ],
)
def test_a_window_in_which_nothing_can_be_drawn_is_refused(run, window, message):
    with pytest.raises(st.ResultError, match=message):
        st.plot(run, window=window)


def test_what_has_no_time_has_no_window():
    with pytest.raises(st.StictionError, match="window: Stability has none; a run or"):
        st.plot(st.stability(PAPER, "phi"), window=("1 s", "2 s"))


def test_the_command_line_has_the_same_window(run, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run.save("a.nc")
    assert inside("plot", "a.nc", "-o", "a.svg", "--window", "5ms", "10ms") == 0
    assert inside("plot", "a.nc", "-o", "b.svg", "--window", "1s", "2s") == 2
    st.init("my.toml")
    given = ("my.toml", "--law", "coulomb", "-o", "b.svg", "--set", "duration=20ms")
    assert inside("compare", *given, "--window", "5ms", "2s") == 2
    assert capsys.readouterr().err.count("is not a part of the run, 0 s to 0.02 s") == 2
    assert not (tmp_path / "b.svg").exists()
    assert inside("compare", *given, "--window", "5ms", "10ms") == 0
