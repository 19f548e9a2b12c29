"""What a page is given: curves, forms, exports, sources."""

import json
import re
import sys
import tomllib
import zipfile
from dataclasses import replace
from importlib import resources
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib import colormaps, pyplot
from matplotlib.collections import QuadMesh
from tests.explored import an_opened

import stiction as st
from stiction.explorer import motion, spectrum
from stiction.explorer.answers import ANSWERS, study_map, tables_of
from stiction.explorer.decimation import columns_of, extremes, share_stuck
from stiction.explorer.door import explore
from stiction.explorer.exports import NAMES, export, own_law, python_lines
from stiction.explorer.form import form
from stiction.explorer.protocols import TESTS, names, protocol
from stiction.explorer.source import open_sources
from stiction.friction import LAWS
from stiction.linear_stability.linear import growth_rate
from stiction.media.sound import LOUD
from stiction.own_code.source import Text
from stiction.presets import PRESETS
from stiction.study.view.mapping import Map, plot_map
from stiction.system.description import Settings

EXAMPLES = Path(__file__).parents[3] / "examples"


def free():
    """Nobody interrupts."""


@pytest.fixture(scope="module")
def description():
    return an_opened().description


def answers(request, what=None):
    what = what or an_opened()
    return list(ANSWERS[request["do"]](what, request, free))


def test_no_peak_is_lost():
    rng = np.random.default_rng(7)
    times = np.sort(rng.uniform(0.0, 1.0, 5000))
    values = rng.normal(size=5000)
    values[rng.integers(5000, size=40)] = np.nan
    places, starts = columns_of(times, (0.2, 0.9), 37)
    found = extremes(values, starts)
    column = np.floor((times - 0.2) * 37 / 0.7)
    inside = (times >= 0.2) & (times <= 0.9)
    for place, row in zip(places, found, strict=True):
        mine = values[inside & (np.clip(column, 0, 36) == place)]
        assert row[1] == np.nanmin(mine)
        assert row[2] == np.nanmax(mine)
        np.testing.assert_array_equal(row[[0, 3]], mine[[0, -1]])
    assert len(places) == 37


def test_slip_is_zero_in_each_column_that_holds_rest(description):
    """Rest between two samples left out, the lowest slip speeds showed beats."""
    run = st.simulate(description.slider, 0.3)
    window, columns = (0.1, 0.12), 400
    times = np.linspace(*window, 140)  # seven a period
    solution, table = motion.simulate(description._replace(run=Settings(duration=0.3)), times, free)
    drawn = motion.curves(table, solution.sticks, window, columns)
    starts, ends = run.sticks["stick_start"].values, run.sticks["stick_end"].values
    edges = np.linspace(*window, columns + 1)
    rests = np.array([((starts < b) & (ends > a)).any() for a, b in pairwise(edges)])
    assert 30 < rests.sum() < columns / 2
    places = drawn["column"].astype(int)
    np.testing.assert_array_equal(drawn["slip_speed"][:, 1] == 0.0, rests[places])


def test_rests_as_frequent_as_columns_do_not_beat_with_them(description):
    run = description._replace(run=Settings(duration=0.3))
    _, drawn = list(motion.run(run, 600, free))[-1]  # two columns a period
    sliding = drawn["column"] * 0.3 / 600 > 0.02
    assert (drawn["slip_speed"][sliding, 1] == 0.0).all()


def microscope_tip():
    return st.Slider(
        mass=1e-11, k_x=0.5, k_y=40.0, phi="5 deg", normal_load=2e-8,
        friction=st.ExponentialWeakening(mu_0=0.5, mu_inf=0.3, v_f=1e-5),
        drive=st.ConstantVelocity(1e-6),
    )  # fmt: skip


def test_the_phase_portrait_holds_slips_that_are_short_beside_the_run():
    """Few samples fell in a slip of 28 us of 0.2 s: chords fanned out, of another top each."""
    description = st.Description(microscope_tip(), st.Initial(), st.Settings(duration=0.05))
    quick, full = motion.run(description, 400, free)
    assert (quick[0]["quick"], full[0]["quick"]) == (True, False)
    run = st.run(description)
    start, end = run.sticks["stick_end"].values[-2], run.sticks["stick_start"].values[-1]
    _, wanted = motion.simulate(description, np.linspace(start, end, 2001), free)
    top = wanted["V_X"].max()
    times, speeds = full[1]["track_time"], full[1]["track_V_X"]
    inside = (times >= start) & (times <= end)
    assert inside.sum() >= 48
    assert speeds[inside].max() == pytest.approx(top, rel=0.01)


def test_the_phase_portrait_holds_a_rapid_slip_among_very_many_short_ones():
    """Of 135 000 slips none was sampled, the four rapid ones neither: chords to any height."""
    law = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f="1 mm/s")
    slow = st.presets.nakano_popov_2020().replace(friction=law, drive=st.ConstantVelocity(2e-5))
    description = st.Description(slow, st.Initial(), st.Settings(duration=120.0))
    *_, (_, drawn) = motion.run(description, 400, free)
    solution, _ = motion.simulate(description, np.array([0.0]), free)
    gaps = solution.sticks[1:, 0] - solution.sticks[:-1, 1]
    assert len(gaps) > motion.MOST_SAMPLES
    longest = int(np.argmax(gaps))
    start, end = solution.sticks[longest, 1], solution.sticks[longest + 1, 0]
    _, wanted = motion.simulate(description, np.linspace(start, end, 2001), free)
    times, speeds = drawn["track_time"], drawn["track_V_X"]
    inside = (times >= start) & (times <= end)
    assert speeds[inside].max() == pytest.approx(wanted["V_X"].max(), rel=0.01)


@pytest.mark.parametrize("window", [(0.0, 2.0), (1.0, 1.9), (1.395, 1.43)])
def test_a_part_of_a_run_shows_the_slips_of_the_whole(window):
    """A zoomed view, and a pinned run, had no spike where a slip of 6 us lay."""
    slider = st.Slider(
        mass=0.365, k_x=507.0, k_y=3187.0, phi="5.4 deg", normal_load=27.7, c_x=0.027,
        friction=st.laws.HyperbolicWeakening(mu_0=0.594, mu_inf=0.178, v_h=4.8e-3, mu_static=0.771),
        drive=st.protocols.DriveProgram(
            velocity=-2.6e-4,
            program=[
                st.protocols.Constant(value=-5.2e-4, duration=0.4),
                st.protocols.Ramp(to=2.6e-4, duration=1.0),
                st.protocols.Hold(),
            ],
        ),
    )  # fmt: skip
    description = st.Description(slider, st.Initial(), st.Settings(duration=2.0))
    *_, (head, whole) = motion.run(description, 600, free)
    facts = {each["name"]: each["value"] for each in head["facts"]}
    # it begins where the drive steps to 260 um/s; the numbers said "at least 389 nm/s"
    assert facts["largest slip speed"] == pytest.approx(2.6e-4, rel=0.01)
    *_, (head, drawn) = motion.zoom(description, window, 600, free)
    assert head["quick"] is False
    time = (whole["column"] + 0.5) * 2.0 / 600
    inside = (time > 1.39) & (time < 1.43)
    assert whole["slip_speed"][inside, 2].max() > 1e-4
    time = window[0] + (drawn["column"] + 0.5) * (window[1] - window[0]) / 600
    there = (time > 1.39) & (time < 1.43)
    for name in ("slip_speed", "friction"):
        wanted = whole[name][inside, 2].max()
        assert drawn[name][there, 2].max() == pytest.approx(wanted, rel=0.02), name


def test_the_better_track_holds_the_first_one(description):
    """Between thousands of short slips the long ones were left out."""
    long = description._replace(run=Settings(duration=3.0))
    quick, full = (arrays for _, arrays in motion.run(long, 400, free))
    assert set(quick["track_time"]) < set(full["track_time"])
    assert len(full["track_time"]) <= motion.MOST_SAMPLES + len(quick["track_time"])
    highest = [arrays["track_V_X"].max() for arrays in (quick, full)]
    assert highest[1] >= highest[0] > 0.01  # m/s


def test_a_run_whose_slips_are_sampled_well_is_drawn_once(description):
    plain = description.slider.replace(phi="0 deg")
    parts = list(
        motion.run(description._replace(slider=plain, run=Settings(duration=2.5)), 400, free)
    )
    assert [head["quick"] for head, _ in parts].count(False) == 1


def test_the_lines_of_python_are_a_script_that_shows_its_figure(monkeypatch):
    """`python run.py` simulated, drew and ended, and nothing was seen."""
    seen = []
    monkeypatch.setattr(pyplot, "show", lambda: seen.extend(pyplot.get_fignums()))
    exec(python_lines(an_opened().description), {})
    assert len(seen) == 1
    pyplot.close(seen[0])


def test_a_run_that_ends_before_any_slip_says_so(description):
    """A law with internal state was "0 s at rest" all the time, and nothing said what to do."""
    ageing = st.laws.RateStateAgeing(a=0.008, b=0.014, D_c="10 um", mu_star=0.6, V_star="1 um/s")
    resting = description.slider.replace(friction=ageing)
    for slider in (resting, description.slider):
        short = description._replace(slider=slider, run=Settings(duration=5e-3))
        for head, _ in motion.run(short, 400, free):
            assert "set a longer duration" in head["rested"]
    assert [head["rested"] for head, _ in motion.run(description, 400, free)][-1] == ""


def test_columns_without_samples_are_left_out():
    places, starts = columns_of(np.array([0.05, 0.95]), (0.0, 1.0), 10)
    assert places.tolist() == [0, 9]
    assert starts.tolist() == [0, 1, 2]
    places, starts = columns_of(np.array([2.0]), (0.0, 1.0), 10)
    assert extremes(np.array([1.0]), starts).shape == (0, 4)


def test_the_share_of_rest_counts_every_interval():
    rng = np.random.default_rng(3)
    ends = np.sort(rng.uniform(0.0, 1.0, 400)).reshape(-1, 2)
    found = share_stuck(ends, (0.1, 0.8), 21)
    fine = np.linspace(0.1, 0.8, 21 * 20000 + 1)
    middles = 0.5 * (fine[1:] + fine[:-1])
    which = np.searchsorted(ends[:, 0], middles, side="right") - 1
    stuck = (which >= 0) & (middles < ends[which, 1])
    # each end of an interval is off by at most one of 20000 points of a column
    np.testing.assert_allclose(found, stuck.reshape(21, -1).mean(axis=1), atol=40 / 20000)
    assert not share_stuck(np.empty((0, 2)), (0.0, 1.0), 5).any()


def test_the_form_has_what_the_registries_have(monkeypatch):
    found = form()
    assert set(found["laws"]) == set(LAWS)
    units = {each["key"]: each["unit"] for each in found["laws"]["exponential-weakening"]["fields"]}
    assert units == {"mu_0": "", "mu_inf": "", "v_f": "m/s", "mu_static": ""}
    mass = found["tables"]["slider"][0]
    assert (mass["low"], mass["low_allowed"], mass["required"]) == (0, False, True)
    assert {"ramp", "hold", "free"} <= set(found["pieces"]["drive"])
    level = {each["key"]: each["unit"] for each in found["pieces"]["load"]["ramp"]}
    assert level == {"to": "N", "duration": "s"}
    monkeypatch.setitem(LAWS, "brand-new", LAWS["coulomb"])
    assert "brand-new" in form()["laws"]


def test_a_users_law_has_fields_and_an_entry_of_its_menu():
    """Its sliders gave numbers without units, which were refused; it was gone from the menu."""
    what = open_sources([EXAMPLES / "own_law.toml"])
    ((head, _),) = answers({"do": "start"}, what)
    (name,) = what.own
    found = {each["key"]: each for each in head["form"]["laws"][name]["fields"]}
    assert {key: each["unit"] for key, each in found.items()} == {"mu_0": "", "b": "", "v_c": "m/s"}
    assert (found["b"]["low"], found["b"]["low_allowed"]) == (0, True)
    assert (found["v_c"]["low"], found["v_c"]["low_allowed"]) == (0, False)
    ((other, _),) = answers({"do": "law", "name": "coulomb", "tables": head["tables"]}, what)
    ((back, _),) = answers({"do": "law", "name": name, "tables": other["tables"]}, what)
    assert back["tables"] == head["tables"]
    head["tables"]["friction"]["anisotropy"] = {"ratio": 0.5}
    grained = what.read(head["tables"])
    assert grained.slider.law.law == what.description.slider.law
    assert replace(what, description=grained).read(head["tables"]) == grained  # opened with it


def test_every_law_and_protocol_can_be_chosen(description):
    tables = tables_of(description)
    for name in LAWS:
        ((head, _),) = answers({"do": "law", "name": name, "tables": tables})
        assert an_opened().read(head["tables"]).slider.law is not None
        assert head["tables"]["friction"]["law"] == name
    for table, tests in names().items():
        for name in tests:
            ((head, _),) = answers(
                {"do": "protocol", "table": table, "name": name, "tables": tables}
            )
            assert an_opened().read(head["tables"]) is not None
    assert names().keys() == TESTS.keys()
    with pytest.raises(st.StictionError, match="known:"):
        protocol(description, "drive", "nothing")


@pytest.mark.parametrize("name", ["velocity steps", "slide-hold-slide", "reversal loops"])
def test_the_mass_slides_before_a_test_begins(name):
    """Of a soft spring the first hold, or turn, came before it slid: no test at all."""
    slider = st.presets.nakano_popov_2020().replace(k_x="50 N/m", friction=st.Coulomb(mu_0=0.2))
    slow = st.Description(slider, st.Initial(), st.Settings(duration="5 s"))
    found = protocol(slow, "drive", name)
    assert found.run.duration >= st.protocols.end(found.slider.drive)
    first = found.slider.drive.program[0].duration
    run = st.simulate(found.slider, first, sample_rate=100.0)
    assert run.samples["X"][-1] > run.samples["X"][-2] > 0.0
    assert run.samples["V_X"][-1] == pytest.approx(1e-3, rel=0.1)


def test_a_test_that_would_never_begin_is_refused():
    """The menu gave runs of 30 years, which were refused where they were computed."""
    soft = st.presets.nakano_popov_2020().replace(k_x="1 uN/m")
    with pytest.raises(st.StictionError, match=r"63\.38 yr to load the spring"):
        protocol(
            st.Description(soft, st.Initial(), st.Settings(duration=5)), "drive", "reversal loops"
        )


def test_every_preset_can_be_chosen():
    for name in PRESETS:
        ((head, _),) = answers({"do": "preset", "name": name})
        assert an_opened().read(head["tables"]).slider.normal_load > 0.0


def test_a_state_restores_the_description(description):
    assert an_opened().read(tables_of(description)) == description


@pytest.mark.parametrize("kind", NAMES)
def test_exports(description, kind, tmp_path):
    name, content = export(description, kind, free)
    assert name == NAMES[kind]
    if kind == "toml":
        assert st.Description.from_dict(tomllib.loads(content.decode())) == description
    elif kind == "python":
        scope = {}
        exec(content.decode().replace("run.plot()", ""), scope)
        assert scope["run"].description == description
    elif kind == "csv":
        assert sorted(zipfile.ZipFile(BytesIO(content)).namelist()) == ["run-sticks.csv", "run.csv"]
    elif kind == "nc":
        (tmp_path / name).write_bytes(content)
        assert st.load(tmp_path / name).description == description
    else:
        assert content.startswith({"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}[kind])
    assert python_lines(description).startswith("import stiction as st\n")


def test_lines_of_python_hold_all_rows_of_a_recorded_drive_and_load():
    """One can paste them; in a session only the number of rows is shown."""
    time = np.linspace(0.0, 0.2, 41)
    drive = st.protocols.Recorded(time=time, velocity=1e-3 * (1.0 + np.sin(20.0 * time)) / 3.0)
    load = st.protocols.RecordedLoad(time=time, load=10.0 + time / 3.0)
    slider = st.presets.nakano_popov_2020().replace(
        drive=st.protocols.DriveProgram(program=[drive]),
        load=st.protocols.LoadProgram(program=[load]),
    )
    description = st.Description(slider, st.Initial(), st.Settings(duration=0.1))
    assert "<41 values>" in repr(slider)
    scope = {}
    exec(python_lines(description).replace("run.plot()", ""), scope)
    assert scope["run"].description == description


@pytest.mark.parametrize("name", ["mylaw.py", "my law.py", "laws/mylaw.py", "lambda.py", "script"])
def test_lines_of_python_know_a_users_law(tmp_path, monkeypatch, name):
    """They named a class that nothing imported."""
    text = (EXAMPLES / "mylaw.py").read_text() + f"# {name}\n"  # one of the same text is loaded
    file = tmp_path / ("mylaw.py" if name == "script" else name)
    file.parent.mkdir(exist_ok=True)
    file.write_text(text)
    table = (EXAMPLES / "own_law.toml").read_text().replace("mylaw.py:", f"{name}:")
    (tmp_path / "own.toml").write_text(table.replace("script:", "mylaw.py:"))
    description = st.Description.from_toml(tmp_path / "own.toml")
    description = description._replace(run=Settings(duration=0.01))
    if name == "script":
        monkeypatch.setattr(type(description.slider.law), "__module__", "__main__")
        monkeypatch.setattr("stiction.friction.user.loading.text_of", lambda _: Text(name, text))
    monkeypatch.syspath_prepend(tmp_path)
    for module in ("mylaw", "my law", "laws", "laws.mylaw", "lambda"):
        monkeypatch.delitem(sys.modules, module, raising=False)
    scope = {"__name__": "pasted"}
    exec(python_lines(description).replace("run.plot()", ""), scope)
    assert scope["run"].status.ok
    assert tuple(scope["slider"].law) == tuple(description.slider.law)
    assert type(scope["slider"].law).__name__ == "Logarithmic"
    law = description.slider.law
    assert own_law(st.laws.Anisotropic(law, ratio=1.3)) == own_law(law) != ""


def test_what_is_heard_is_the_transverse_rate(description):
    ((head, arrays),) = answers({"do": "sound", "tables": tables_of(description)})
    run = st.simulate(description.slider, description.run.duration, sample_rate=head["rate"])
    count = len(arrays["sound"])
    assert count == int(description.run.duration * head["rate"])
    # the times differ by rounding
    wanted = run.samples["v_y"][:count]
    np.testing.assert_allclose(arrays["sound"], wanted - wanted.mean(), rtol=1e-4, atol=1e-10)


def test_what_is_too_high_to_be_heard_is_as_deep_as_of_listen():
    """Sampled at 48 kHz, lines of 150 kHz were folded to any pitch."""
    description = st.Description(microscope_tip(), st.Initial(), st.Settings(duration=0.02))
    what = replace(an_opened(), description=description)
    ((head, arrays),) = answers({"do": "sound", "tables": tables_of(description)}, what)
    wanted = st.listen(st.run(description))
    assert head["speed"] == wanted.speed == 0.01
    found = arrays["sound"] / np.abs(arrays["sound"]).max() * LOUD
    np.testing.assert_allclose(found, wanted.samples, atol=1e-5)
    short = description._replace(run=Settings(duration=1e-5))
    with pytest.raises(st.StictionError, match=r"10 µs is too short .*; let it last 100 µs"):
        answers({"do": "sound", "tables": tables_of(short)}, what)


def test_of_a_long_run_a_minute_is_heard(description, monkeypatch):
    monkeypatch.setattr(
        "stiction.explorer.answers.rate_at", lambda _, times, **__: np.ones(len(times))
    )
    for duration, heard in ((50.0, 50), (1000.0, 60)):
        long = description._replace(run=Settings(duration=duration))
        what = replace(an_opened(), description=long)
        ((head, arrays),) = answers({"do": "sound", "tables": tables_of(long)}, what)
        assert head["speed"] == 1.0
        assert len(arrays["sound"]) == heard * head["rate"]


@pytest.mark.parametrize("duration", [1.0, 200.0])
def test_columns_of_the_spectrogram_are_at_the_middles_of_their_windows(
    description, monkeypatch, duration
):
    """The first window begins, and the last one ends, with the run, or less than a step before."""
    monkeypatch.setattr(spectrum, "sample", lambda _, times, __: np.sin(1e4 * times))
    long = description._replace(run=Settings(duration=duration))
    amplitude, frequency, times = spectrogram_and_its_frequencies(long)
    window = 1.0 / frequency[1]
    step = times[1] - times[0]
    assert amplitude.shape[1] > 10
    assert times[0] == pytest.approx(0.5 * window, rel=0.01)
    assert -0.01 * window <= duration - 0.5 * window - times[-1] < 1.01 * step


def test_rounding_of_the_elongation_is_not_in_the_spectrogram(description, monkeypatch):
    """A mass that rests has none; an oscillation of a thousand roundings has one."""
    least = np.spacing(1.0)

    def still(_, times, __):
        return 1.0 + least * np.random.default_rng(1).integers(-1, 2, len(times))

    monkeypatch.setattr(spectrum, "sample", still)
    amplitude, *_ = spectrogram_and_its_frequencies(description)
    assert not amplitude.any()
    monkeypatch.setattr(
        spectrum, "sample", lambda _, times, __: 1.0 + 1e3 * least * np.sin(3e3 * times)
    )
    amplitude, *_ = spectrogram_and_its_frequencies(description)
    assert amplitude.any()


def test_a_run_without_a_transverse_oscillation_has_no_sound(description):
    """Zeros were played, and nothing said why nothing was heard."""
    plain = description._replace(slider=description.slider.replace(phi="0 deg"))
    with pytest.raises(st.StictionError, match="nothing oscillates along y"):
        answers({"do": "sound", "tables": tables_of(plain)})


def test_the_numbers_say_whether_steady_sliding_is_stable(description):
    """For those who do not see the map."""
    programs = [st.protocols.DriveProgram(velocity=1e-3, program=[st.protocols.Hold(duration=1)])]
    for drive in (st.ConstantVelocity("1 mm/s"), st.ConstantVelocity("1 m/s"), *programs):
        slider = description.slider.replace(drive=drive)
        *_, (head, _) = motion.run(description._replace(slider=slider), 50, free)
        (fact,) = [each for each in head["facts"] if each["name"] == "steady sliding"]
        if drive in programs:
            assert fact["text"] == "there is none"
        else:
            assert fact["text"] == ("stable" if growth_rate(slider) < 0.0 else "unstable")


def spectrogram_and_its_frequencies(description):
    what = replace(an_opened(), description=description)
    ((head, arrays),) = answers({"do": "spectrogram", "tables": tables_of(description)}, what)
    amplitude, (first, last) = arrays["amplitude"], head["times"]
    frequency = np.linspace(*head["frequency"], len(amplitude))
    return amplitude, frequency, np.linspace(first, last, amplitude.shape[1])


def test_the_spectrogram_of_a_long_run_is_not_folded():
    """From 75 s on it had fewer than two samples in a period: 853 Hz were shown as 253 Hz.

    Where windows overlapped, at 20 to 38 s, amplitudes were up to 1e10 times as large.
    """
    slow = st.presets.nakano_popov_2020().replace(drive=st.ConstantVelocity(20e-6))
    loudest = []
    for duration in (15.0, 25.0, 60.0, 100.0, 1000.0):
        description = st.Description(slow, st.Initial(), st.Settings(duration=duration))
        amplitude, frequency, times = spectrogram_and_its_frequencies(description)
        loudest.append(amplitude.max())
        at = np.abs(times - 10.0).argmin()
        start = st.simulate(slow, 15.0, sample_rate=8e3).samples
        near = np.abs(start["time"] - times[at]) < 0.5
        if near.sum() < 4000:  # the window lies beyond
            continue
        above = frequency > 100.0
        line = frequency[above][amplitude[above, at].argmax()]
        rate = st.analysis.spectrogram(start["v_y"][near], 8e3, width=0.5)
        wanted = rate.sel(frequency=slice(100.0, 2e3)).mean("time").idxmax("frequency")
        assert abs(line - float(wanted)) < 2 * frequency[1] + 2.0  # Hz: windows of 0.5 s
    assert max(loudest) < 2.0 * loudest[0]


def test_amplitudes_of_the_spectrogram_are_those_of_the_rate():
    description = an_opened(duration=1.0).description
    amplitude, frequency, times = spectrogram_and_its_frequencies(description)
    rate, width = 64.0 * frequency[-1], 1.0 / frequency[1]
    run = st.simulate(description.slider, 1.0, sample_rate=rate)
    wanted = st.analysis.spectrogram(run.samples["v_y"], rate, width=width, step=width / 6)
    known = wanted.interp(time=times, frequency=frequency).mean("time").values
    above = frequency > 0.25 * frequency[-1]  # below is the start, which windows share differently
    # folded is an eighth of the weakest of the lines beyond, at most
    np.testing.assert_allclose(
        amplitude.mean(axis=1)[above], known[above], atol=0.02 * known[above].max()
    )


def test_a_run_that_ends_within_the_first_window_has_no_spectrogram(description, monkeypatch):
    monkeypatch.setattr(spectrum, "sample", lambda *_: np.zeros(20))
    with pytest.raises(st.ResultError, match="ended before a spectrum could be taken"):
        spectrogram_and_its_frequencies(description)


def test_samples_under_the_microscope_have_all_digits():
    """A slow turn of friction fell in eight steps of the spacing of single precision at 40 deg."""
    turned = st.Slider(
        mass=0.1, k_x=2e3, k_y=4e6, phi="40 deg", normal_load=6.0, drive=st.ConstantVelocity(1e-3),
        friction=st.ExponentialWeakening(mu_0=0.25, mu_inf=0.15, v_f=0.01),
    )  # fmt: skip
    description = st.Description(turned, st.Initial(), st.Settings(duration=4.0))
    ((_, arrays),) = motion.fine(description, 3.5, 4e-3, free)
    assert (np.diff(arrays["theta"]) < 0.0).all()
    *_, (_, drawn) = motion.zoom(description, (3.5, 3.501), 600, free)
    assert len(np.unique(drawn["psi"])) > 0.9 * drawn["psi"].size / 4


def test_the_spectrogram_shows_the_transverse_oscillation(description):
    what = an_opened(duration=0.5)
    ((head, arrays),) = answers({"do": "spectrogram", "tables": tables_of(what.description)}, what)
    amplitude = arrays["amplitude"]
    frequency = np.linspace(*head["frequency"], len(amplitude))
    _, fast = description.slider.natural_frequencies
    above = frequency > 0.5 * fast  # the turn of friction is slow, and stronger
    strongest = frequency[above][amplitude[above].mean(axis=1).argmax()]
    line = frequency[1] - frequency[0]
    assert abs(strongest - fast) < line  # sin(theta) > 0.98 until 0.5 s


def test_the_map_agrees_with_the_critical_misalignment(description):
    found = answers({"do": "stability", "tables": tables_of(description)})
    head, arrays = found[-1]
    growth = arrays["growth"]
    speeds = np.geomspace(*head["speeds"], len(growth) + 1)
    row = int(np.searchsorted(speeds, 1e-3) - 1)
    edges = np.geomspace(*head["angles"], growth.shape[1] + 1)
    middle = np.sqrt(speeds[row] * speeds[row + 1])
    slider = description.slider.replace(drive=st.ConstantVelocity(middle))
    critical = np.degrees(st.stability(slider, "phi", ("0.1 deg", "90 deg")).criticals[0].values)
    stable = growth[row] < 0.0
    wanted = [int(np.searchsorted(critical, x)) % 2 == 1 for x in np.sqrt(edges[1:] * edges[:-1])]
    assert stable.tolist() == wanted
    assert [arrays["growth"].shape for _, arrays in found][-1] == (48, 48)


def test_the_scene_has_the_axes_of_springs_and_dampers():
    parts = [st.Spring("a", 2e3, 4e4, "30 deg"), st.Spring("b", 3e3, 9e4, "-5 deg")]
    description = an_opened().description
    askew = {"c_x": 1.0, "damping_angle": "40 deg"}
    rig = description.slider.replace(springs=parts, phi="20 deg", **askew)
    request = {"do": "run", "tables": tables_of(description._replace(slider=rig)), "columns": 50}
    scene = answers(request)[0][0]["scene"]
    assert scene["phi"] == rig.misalignment != rig.phi
    assert scene["dampers"] == [("c_x", np.radians(40.0) - rig.turn)]
    assert answers(request | {"tables": tables_of(description)})[0][0]["scene"]["dampers"] == []


def test_a_record_lies_over_a_description(tmp_path):
    rig = st.init(tmp_path / "my.toml")
    record = tmp_path / "force.csv"
    record.write_text("time [ms],force [mN]\n0,0\n1,5\n2,7\n")
    what = open_sources([rig, record])
    assert what.name == "my.toml"
    np.testing.assert_allclose(what.measured["time"], [0.0, 1e-3, 2e-3])
    asked = {"do": "measured", "window": [0.0, 2e-3], "run": [0.0, 5.0], "columns": 16}
    ((head, arrays),) = answers(asked, what)
    assert head["origin"] == "measured"
    assert arrays["spring_x"].max() == pytest.approx(7e-3, rel=1e-15)
    assert open_sources([record]).description.slider == st.presets.nakano_popov_2020()


@pytest.mark.parametrize(
    ("first", "run", "shown", "says"),
    [
        (93.9, (0.0, 5.0), 0.0, "measured, from 93.9 s on"),
        (-8.0, (0.0, 5.0), 0.0, "measured, from -8 s on"),
        (0.0, (20.0, 25.0), 20.0, "measured, from 0 s on"),
        (5.0, (0.0, 5.0), 0.0, "measured, from 5 s on"),  # only their ends touch
        (-1.0, (0.0, 5.0), 0.0, "measured, from -1 s on"),
        (4.9, (0.0, 5.0), 4.9, "measured"),
        (-0.9, (0.0, 5.0), -0.9, "measured"),
    ],
)
def test_a_record_beside_the_run_is_shown_from_its_start(tmp_path, first, run, shown, says):
    """Nothing of it was in the window, below a legend that said "measured"."""
    record = tmp_path / "force.csv"
    times = [first + later for later in (0.0, 0.5, 1.0)]
    rows = "".join(f"{time:.3f},{force}\n" for time, force in zip(times, (0, 5, 7), strict=True))
    record.write_text(f"time [s],force [mN]\n{rows}")
    what = open_sources([st.read_record(record)])
    assert what.name == "force.csv"  # not "a Record"
    asked = {"do": "measured", "window": run, "run": run, "columns": 5000}
    ((head, arrays),) = answers(asked, what)
    assert head["origin"] == says
    inside = [time for time in (shown, shown + 0.5, shown + 1.0) if run[0] <= time <= run[1]]
    columns = [round((time - run[0]) * 1000) for time in inside]
    np.testing.assert_allclose(arrays["column"], columns, atol=1.0)


def test_a_record_of_one_sample_where_the_run_starts_keeps_its_clock():
    what = open_sources([st.Record(time=[0.0], force=[1.0])])
    assert what.measured_during((0.0, 5.0))[1] == "measured"


def test_a_record_comes_into_view_by_its_own_clock_as_the_run_grows():
    what = open_sources([st.Record(time=[7.0, 8.0], force=[1.0, 2.0])])
    assert what.measured_during((0.0, 5.0))[0].tolist() == [0.0, 1.0]
    assert what.measured_during((0.0, 7.5))[0].tolist() == [7.0, 8.0]


def test_a_record_without_samples_opens_the_papers_case():
    empty = st.Record(time=np.zeros(0), force=np.zeros(0))
    what = open_sources([empty])
    assert len(what.measured["time"]) == 0
    assert what.origin == "measured"


def test_a_result_is_opened_with_its_curves(tmp_path, description):
    path = st.run(description).save(tmp_path / "run.nc")
    what = open_sources([path])
    assert what.description == description
    assert what.origin == "stored"
    with pytest.raises(st.ResultError, match="both describe a system"):
        open_sources([path, path])


def test_what_cannot_be_explored_is_refused(tmp_path):
    path = tmp_path / "x.csv"
    path.write_text("")
    for what in (path, tmp_path / "none.csv", tmp_path / "none.toml", 3.0):
        with pytest.raises(st.StictionError):
            open_sources([what])


def test_objects_of_a_session_are_explored(description):
    run = st.run(description)
    record = st.Record(time=[0.0, 1.0], force=[1.0, 2.0], position=[0.0, 1e-3])
    what = open_sources([run.slider, record])
    assert what.description.slider == run.slider
    assert set(what.measured) == {"time", "spring_x", "X"}
    assert open_sources([run]).origin == "stored"
    assert open_sources([description]).description is description


def test_a_system_is_named_by_its_origin(tmp_path):
    """Every preset was the paper's figure; of a session, "a Description"."""
    assert open_sources([]).name == "Nakano & Popov 2020, Fig. 3"
    slider = st.presets.nakano_popov_2020()
    assert open_sources([slider]).name == "Nakano & Popov 2020, Fig. 3"
    assert open_sources([slider.replace(mass="1 kg")]).name == "a Slider"
    belt, title = st.presets.leine_belt(), "leine-belt (Leine et al. 1998)"
    what = open_sources([belt])
    assert (what.name, what.preset) == (title, "leine-belt")
    longer = belt._replace(run=Settings(duration=7.0))
    heavier = belt._replace(slider=belt.slider.replace(mass="2 kg"))
    assert what.title(longer, "leine-belt") == (title, False)
    assert what.title(heavier, "leine-belt") == (title, True)
    assert what.title(heavier, {"phi": 1}) == (title, True)  # a link of a study: none is open
    opened = an_opened()
    assert opened.title(belt, "leine-belt") == (title, False)
    assert opened.title(opened.description, "") == ("a test", False)
    assert opened.title(belt, None) == ("a test", True)


def test_a_study_is_a_map_whose_runs_open(tmp_path):
    study = st.Study(
        base=an_opened(duration=2e-3).description,
        axes={"phi": st.Values(["1 deg", "2 deg"]), "V": st.Values(["1 mm/s", "3 mm/s", "5 mm/s"])},
        measures=["peak_force"],
    )
    st.sweep(study, tmp_path / "a.zarr")
    what = open_sources([tmp_path / "a.zarr"])
    ((head, arrays),) = answers({"do": "start"}, what)
    axes = {each["dim"]: each["values"] for each in head["study"]["axes"]}
    assert axes["phi"] == [1.0, 2.0]
    assert arrays["map"].shape == (2, 3, 4)
    ((head, _),) = answers({"do": "pick", "at": {"phi": 1, "drive.velocity": 2}}, what)
    picked = what.read(head["tables"]).slider
    assert (np.degrees(picked.phi), picked.motion.velocity) == (pytest.approx(2.0), 5e-3)
    place = {"phi": 1, "drive.velocity": 2}
    assert what.title(what.read(head["tables"]), place) == ("a.zarr", False)
    assert what.title(what.read(head["tables"]), place | {"phi": 0}) == ("a.zarr", True)
    with pytest.raises(st.StictionError, match="no study"):
        answers({"do": "pick", "at": {}})


@pytest.fixture
def finished_study(tmp_path):
    """A study of two runs of which one is missing, by kind and by a measure of three decades."""
    study = st.Study(
        base=an_opened(duration=2e-3).description,
        axes={"phi": st.Values(["1 deg", "2 deg", "3 deg"]), "V": st.Values(["1 mm/s", "3 mm/s"])},
        measures=["regime", "peak_force"],
    )
    st.sweep(study, tmp_path / "a.zarr")
    return tmp_path / "a.zarr"


def map_colors(axes):
    """Return the colours that a figure gives the cells of its map, rows by the first dimension."""
    (mesh,) = [each for each in axes.collections if isinstance(each, QuadMesh)]
    values = mesh.get_array()
    colors = mesh.cmap(mesh.norm(values), bytes=True)
    return np.swapaxes(colors.reshape(*values.shape, 4), 0, 1)


@pytest.mark.parametrize("measure", ["regime", "peak_force"])
def test_a_study_has_the_colours_of_its_figure(finished_study, monkeypatch, measure):
    """The page had other colours for the kinds, and all measures on a linear scale without unit."""
    view = open_sources([finished_study]).study
    force = view.data["peak_force"].values
    force[:] = [[1e-3, 2e-2], [np.nan, 0.5], [1.0, 3.0]]  # N: in decades, one without a value
    view.data["regime"].values[0] = [-1, 3]  # one that failed
    monkeypatch.setattr("stiction.study.view.view.choose_measures", lambda *_: [measure])
    head, arrays = study_map(replace(an_opened(), study=view))
    (axes,) = plot_map(Map(view, (measure,)))
    np.testing.assert_array_equal(arrays["map"], map_colors(axes))
    if measure == "regime":
        legend = axes.figure.legends[0]
        words = [each.get_text() for each in legend.get_texts()][: len(head["kinds"]) + 1]
        assert words == [name for name, _ in head["kinds"]] + [head["missing"]]
        assert "stuck or creeping" in words  # a run that ends before the first slip
    else:
        bar = next(each for each in axes.figure.axes if each is not axes)
        assert head["measure"] == bar.get_ylabel() == "peak force (N)"
        assert head["bar"] == {"limits": pytest.approx(bar.get_ylim()), "log": True}
        assert head["missing"] == "no value"
        assert arrays["map"][1, 0].tolist() == [0, 0, 0, 0]


def test_the_spectrogram_has_the_shades_of_its_figure():
    text = (resources.files("stiction.explorer") / "pages" / "views.js").read_text()
    table = json.loads(re.search(r"const VIRIDIS = (\[[^;]*),\n\];", text).group(1) + "]")
    wanted = colormaps["viridis"](np.linspace(0.0, 1.0, len(table)), bytes=True)[:, :3]
    np.testing.assert_allclose(table, wanted)


def test_without_the_extra_the_command_is_named(monkeypatch):
    monkeypatch.setattr("stiction.explorer.door.find_spec", lambda name: None)
    with pytest.raises(st.StictionError, match="uv run --extra explorer stiction explore"):
        explore()
    monkeypatch.undo()
    with pytest.raises(st.StictionError, match="port must lie"):
        explore(port=70000)
