import csv
import json
import pickle
import re
from collections import Counter
from dataclasses import replace
from math import degrees

import numpy as np
import pytest
import xarray as xr
from tests.drawn import inside
from tests.parts import assess, creep_of

import stiction as st
from stiction.analysis.creep.mean_curve import calibrate
from stiction.analysis.export import write
from stiction.analysis.motion.cycle_columns import mean_in_words
from stiction.analysis.parts import creep
from stiction.cli import main
from stiction.plotting.analysis.overview import figures
from stiction.text.columns import SHOWN_ROWS, rows_left_out
from stiction.text.sections import first_clause
from stiction.text.suggestion import as_option, suggest

PAPER = st.presets.nakano_popov_2020()


@pytest.mark.parametrize("count", [0, SHOWN_ROWS, SHOWN_ROWS + 1])
def test_rows_that_a_table_lacks_are_told(count):
    said = (
        f"These are the first {SHOWN_ROWS} of {count} rows; export(...) writes all, stiction "
        "analyse to energy.csv."
    )
    assert rows_left_out(count, "rows", "energy.csv") == [said] * (count > SHOWN_ROWS)


@pytest.fixture(scope="module")
def run():
    return st.simulate(PAPER, duration=5.0, sample_rate=10e3)


@pytest.fixture(scope="module")
def found(run):
    return st.analyse(run)


def test_a_run_says_everything_of_itself(found):
    assert found.missing == {}
    assert found.regime.kind == "stick-slip"
    assert found.cycles.sizes["cycle"] == 3
    assert found.phases.sizes["phase"] == 4  # the first loading is one
    assert float(found.energy["work"].sum()) > 0.0
    assert degrees(found.misalignment.phi) == pytest.approx(1.0, abs=0.02)


def test_what_other_tests_ask_for_one_finding_is_what_an_analysis_finds(run, found):
    its = creep_of(run)
    assert (its.divergence, its.misalignment) == (found.divergence, found.misalignment)
    record = st.measure(run, st.Sensor(noise="2 mN"), seed=1)
    part, whole = assess(record), st.analyse(record)
    assert part.stated
    assert repr((part.stated, part.warnings)) == repr((whole.parts["metadata"], whole.warnings))
    assert repr(part.friction) == repr(whole.friction)
    assert part.cycles.as_dataset().identical(whole.cycles)


@pytest.fixture(scope="module")
def fast():
    """A vibration at thirty times the paper's velocity."""
    slider = PAPER.replace(drive=st.ConstantVelocity("30 mm/s"))
    return st.analyse(st.simulate(slider, duration=1.0, sample_rate=10e3))


def test_the_energies_shown_of_each_cycle_add_up_to_its_work(fast):
    (shown,) = [part for part in fast.tables() if part.title == "Energy"]
    names = [heading.split(" (")[0].replace(" ", "_") for heading in shown.table.headings[2:]]
    left = fast.energy["work"] - sum(fast.energy[name] for name in names)
    left_out = 8 - len(names)
    assert np.abs(left).max() <= left_out * 1e-3 * np.abs(fast.energy["work"]).min()


def test_the_first_peak_of_a_vibration_is_not_taken_for_static_friction(fast):
    assert fast.regime.kind == "harmonic vibration"
    assert fast.friction.break_away.coefficient > 1.05 * PAPER.law.coefficient(0.0)
    assert "the mass moves before it, so that static friction is less" in " ".join(
        str(fast).split()
    )


def load_cell(noise, hum=0.0, wave="saw"):
    """A sawtooth, or a level, with what a record may have besides."""
    time = np.arange(0.0, 20.0, 1e-3)
    slips = np.interp(time % 2.0, [0.0, 1.95, 2.0], [0.0, 0.39, 0.0])
    force = 1.0 + (slips if wave == "saw" else 0.0 * time)
    force += hum * np.sin(2.0 * np.pi * 50.0 * time)
    return time, force + noise * np.random.default_rng(3).standard_normal(len(time))


KNOWN = {"stiffness": 200.0, "drive_velocity": 1e-3, "mass": 0.05}
LOADED = {**KNOWN, "normal_load": 10.0}
NO_MORE = 240  # letters of a line of the brief: three lines of a terminal


@pytest.mark.parametrize(
    ("data", "known", "lines"),
    [
        (load_cell(1e-3), LOADED, (
            "Stick-slip (confidence 1.00), at rest or in creep for",
            "The mass sticks and slips 8 times, every 2.000 s; the force drops by 391.2 mN ",
            "Friction coefficient: static 0.1391, kinetic 0.1195 ± 0.0001.",
            "Not determined, for the reasons below: ",
        )),
        (load_cell(1e-3, hum=0.02), KNOWN, (
            "Stick-slip", "The mass", "Friction force: static 1.391 ± 0.002 N",
            "1 warning: a line at 50 Hz", "Not determined",
        )),
        (load_cell(1e-3, wave="level"), LOADED, (
            "Steady sliding", "The mass slides steadily, at a force of 1.0",
            "Friction coefficient: kinetic 0.1; static not determined (this is steady sliding).",
        )),
        (([0.0, 1.0], [1.0, 1.0]), {}, ("Undetermined", "This", "Friction: not determined (of")),
    ],
)  # fmt: skip
def test_a_report_begins_with_its_answer_and_says_nothing_twice(data, known, lines):
    time, force = data
    found = st.analyse(st.Record(time=time, force=force, **known))
    brief, *others = found.tables()
    assert brief.title == "In short"
    assert str(found).startswith("In short\n")
    assert all(map(str.startswith, brief.sentences, lines)), brief.sentences
    assert len(brief.sentences) == len(lines)
    assert max(map(len, brief.sentences)) < NO_MORE
    said = [each for part in (brief, *others) for line in part.sentences
            for each in re.split(r"(?<=\.) ", line)]  # fmt: skip
    assert max(Counter(said).values()) == 1
    assert all(f"{first_clause(each)}." != each for each in found.warnings)


@pytest.mark.parametrize("drift", [-3e-3, 3e-3])
def test_the_rate_of_loading_has_the_error_of_a_drift(drift):
    """Rates that scatter by 0.1 % were printed in four digits while a drift shifted all by 2 %."""
    time, force = load_cell(1e-3)
    found = st.analyse(st.Record(time=time, force=force + drift * time, **LOADED))
    (part,) = [each for each in found.tables() if each.title == "Cycles"]
    shown = dict(row[:2] for row in part.table.rows)
    names = "rate of loading before it bends", "apparent stiffness, rate of loading over drive"
    for name, unit in zip(names, ("mN/s", "N/m"), strict=True):  # 200 of each
        (cell,) = [value for key, value in shown.items() if key.startswith(name)]
        mean, error = map(float, cell.removesuffix(f" {unit}").split(" ± "))
        assert abs(drift) * 1e3 <= error < 2.0 * abs(drift) * 1e3
        assert mean == pytest.approx(200.0, abs=2.0 * error)


@pytest.mark.parametrize(("speed", "verb"), [(0.8, "moves"), (0.2, "creeps")])
def test_a_mass_nearly_as_fast_as_the_drive_does_not_creep(speed, verb):
    """A brake pad at 1 m/s was said to creep at 911 mm/s."""
    last = {"velocity": np.float64(speed), "velocity_error": np.float64(0.0)}
    assert creep._creeping(last, 1.0, 1.0, creep.RESTING).startswith(f"it {verb} at ")


def test_a_single_cycle_has_no_spread():
    time = np.arange(0.0, 2.8, 1e-3)
    found = st.analyse(st.Record(time=time, force=1.0 + (time + 0.4) % 1.2))
    assert found.cycles.sizes["cycle"] == 1
    assert "periods differ" not in str(found)


def test_a_loading_without_a_slip_has_no_stick_phase_that_ends(run):
    early = run.data["time"].values < 1.9
    given = {"time": run.data["time"].values[early], "force": run.data["spring_x"].values[early]}
    found = st.analyse(st.Record(**given, stiffness=1e3, drive_velocity=1e-3))
    assert found.missing["creep"] == "no whole stick phase ends in a slip"


def test_a_part_of_a_run_is_analysed_with_all_that_the_run_knows(run, found):
    """As a record of the cut arrays it lost the misalignment."""
    first, last = run.samples["time"][[0, -1]]
    assert str(st.analyse(run, window=(first, last))) == str(found)
    part = st.analyse(run, window=("1 s", f"{last} s"))
    assert part.cycles["start"].values.min() >= 1.0
    assert 0 < part.cycles.sizes["cycle"] < found.cycles.sizes["cycle"] + 1
    off = abs(part.misalignment.phi - found.misalignment.phi)
    assert off < part.misalignment.phi_error + found.misalignment.phi_error


def test_a_part_of_a_record_is_analysed_with_its_apparatus():
    time = np.arange(0.0, 60.0, 0.01)
    record = st.Record(time=time, force=1.0 + time % 2.0, stiffness="1 kN/m", drive_velocity=1e-3)
    part = st.analyse(record, window=("10 s", "40 s"))
    assert (part.record.time[0], part.record.time[-1]) == (10.0, 40.0)
    assert part.record.stiffness == 1000.0
    assert part.cycles.sizes["cycle"] < st.analyse(record).cycles.sizes["cycle"]
    for window, words in (
        ((40, 70), "40 s to 70 s is not a part of the record, 0 s to 59.99 s"),
        ((3, 1), "must end after it starts"),
        ((1.001, 1.002), "has 0 samples of the record"),
    ):
        with pytest.raises(st.ResultError, match=words):
            st.analyse(record, window=window)


def test_times_before_a_trigger_are_a_window_too():
    time = np.linspace(-20.0, 10.0, 3001)
    record = st.Record(time=time, force=1.0 + time % 2.0)
    whole = st.analyse(record, window=(time[0], time[-1]))
    assert len(whole.source) == len(record)
    part = st.analyse(record, window=("-15 s", "-2 s")).source
    assert (part.time[0], part.time[-1]) == (time[500], time[1800])


def test_a_dataset_is_told_the_ways_to_a_record(run):
    for table in (run.data, run.to_dataframe()):
        told = r"neither a run nor a record.*st\.Record\(time=.*st\.read_record.*window=\(1, 2\)"
        with pytest.raises(st.ResultError, match=told):
            st.analyse(table)


def test_without_misalignment_the_last_motion_is_the_slip():
    found = st.analyse(st.simulate(PAPER.replace(phi="0 deg"), duration=4.0, sample_rate=5e3))
    assert "A motion in the last moments is the slip itself" in " ".join(str(found).split())


def test_bare_arrays_say_what_they_can(run):
    record = st.Record(time=run.data["time"].values, force=run.data["spring_x"].values)
    found = st.analyse(record)
    assert found.cycles.sizes["cycle"] == 3
    assert "stiffness and drive velocity" in found.missing["creep"]
    assert found.energy is None
    assert all(part.sentences for part in found.tables())


def test_creep_of_a_measured_record_is_counted_from_its_own_loading(run):
    data = {"time": run.data["time"].values, "force": run.data["spring_x"].values}
    stated = st.Record(**data, stiffness=900.0, drive_velocity=1e-3)
    found = st.analyse(stated)
    shown = calibrate(stated, found.cycles).stiffness
    assert shown == pytest.approx(982.0, abs=1.0)  # k_x less what creeps already
    late = found.creep.isel(bin=slice(1, 10))
    true = st.analyse(run).creep
    at = np.interp(late["begin"], true["begin"], true["velocity"])
    assert late["velocity"].values == pytest.approx(at, abs=0.03e-3)  # the share of V that is lost


def test_a_run_without_a_sample_rate_is_sampled_well_enough():
    found = st.analyse(st.simulate(PAPER, duration=5.0))
    assert found.regime.kind == "stick-slip"
    assert found.cycles.sizes["cycle"] == 3


@pytest.mark.parametrize("count", [0, 1, 2, 10, 1000])
def test_short_and_constant_records_are_no_error(count):
    record = st.Record(time=np.arange(count) * 1e-3, force=np.ones(count))
    found = st.analyse(record)
    assert found.cycles.sizes["cycle"] == 0
    assert [part.title for part in found.tables()] == [
        "In short", "Motion", "Friction", "Cycles", "Creep", "Oscillation", "Energy",
    ]  # fmt: skip


def test_a_run_without_samples_or_misalignment_is_no_error():
    for run in (
        st.simulate(PAPER, duration=0.5),
        st.simulate(PAPER.replace(phi="0 deg"), duration=0.5, sample_rate=1e3),
        st.simulate(PAPER.replace(drive=st.ConstantVelocity(0.0)), duration=0.1, sample_rate=1e3),
    ):
        assert all(part.sentences for part in st.analyse(run).tables())


@pytest.mark.parametrize(("wave", "named"), [("level", set()), ("saw", {"cycles", "summary"})])
def test_a_table_without_rows_has_no_file(wave, named, tmp_path):
    """Steady sliding wrote a table of cycles, and of creep, of a heading alone."""
    time, force = load_cell(1e-3, wave=wave)
    found = st.analyse(st.Record(time=time, force=force, **LOADED))
    write(found, tmp_path)
    tables = [*tmp_path.glob("*.csv")]
    assert {path.stem for path in tables} & {"cycles", "summary"} == named
    assert all(len(path.read_text().splitlines()) > 1 for path in tables)


def test_tables_and_numbers_as_files(found, tmp_path):
    names = [path.name for path in write(found, tmp_path)]
    assert names == [
        "analysis.json", "friction.csv", "cycles.csv", "summary.csv", "creep.csv",
        "creep-phases.csv", "oscillation.csv", "oscillation-phases.csv", "energy.csv",
    ]  # fmt: skip
    with (tmp_path / "cycles.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["peak [N]"]) == pytest.approx(float(found.cycles["peak"][0]), rel=1e-11)
    numbers = json.loads((tmp_path / "analysis.json").read_text())
    assert numbers["regime"]["kind"] == "stick-slip"
    assert numbers["cycles"]["period"]["unit"] == "s"
    assert numbers["misalignment"]["phi"] == found.misalignment.phi
    for name, units in (
        ("misalignment", {"phi": "rad", "phi_error": "rad", "F_0": "N", "weakening": "1"}),
        ("divergence", {"exponent": "1", "amplitude_error": "m/s", "loading_time": "s"}),
        ("friction", {"force": "N", "coefficient_error": "1"}),
    ):
        assert units.items() <= numbers[name]["units"].items()


def test_the_command_writes_tables_and_figures(run, tmp_path, capsys):
    result = run.save(tmp_path / "my.nc")
    with pytest.raises(SystemExit) as ended:
        main(["analyse", str(result)])
    assert ended.value.code == 0
    assert "It diverges towards slip with the exponent" in " ".join(capsys.readouterr().out.split())
    written = sorted(path.name for path in (tmp_path / "my-analysis").iterdir())
    assert {"cycles.png", "creep.png", "oscillation.png", "energy.png", "cycles.csv"} < set(written)


def test_the_command_refuses_a_file_for_a_folder(run, tmp_path, capsys):
    result = run.save(tmp_path / "my.nc")
    (tmp_path / "my-analysis").write_text("")
    with pytest.raises(SystemExit) as ended:
        main(["analyse", str(result)])
    assert ended.value.code == 2
    assert "is not a folder" in capsys.readouterr().err


def test_an_even_rise_creeps_by_no_more_than_rounding() -> None:
    time = np.arange(20_000) * 1e-3
    known = {"stiffness": 0.1, "drive_velocity": 1.0}
    found = st.analyse(st.Record(time=time, force=0.1 * (time % 2.0) + 1.0, **known))
    assert found.creep is not None
    # all but the bin at slip, into which the fall of one sample reaches
    still = np.abs(found.creep["velocity"].values) <= 2.0 * found.creep["velocity_error"].values
    assert still[1:].all()
    assert (found.creep["velocity_error"].values > 0.0).all()


def test_few_samples_show_no_creep(slider: st.Slider) -> None:
    for rate in (0, 1.0, 10.0):
        found = st.analyse(st.simulate(slider, 5.0, sample_rate=rate))
        assert found.misalignment is None
        if rate == 0:
            assert "enough samples" in found.missing["creep"]


def test_a_fitted_friction_below_the_largest_force_is_doubted(found) -> None:
    said = "\n".join(creep.section(found).sentences)
    assert " ± " in said.partition("F_0 = ")[2]
    assert "too small" not in said
    small = replace(found, misalignment=found.misalignment._replace(F_0=1.9))
    assert "too small: the force itself reaches 1.99" in "\n".join(creep.section(small).sentences)


def test_no_sentence_counts_with_a_wild_sample(found) -> None:
    wild = found.record.model_copy(update={"force": found.record.force.copy()})
    wild.force[30_000] = 99.9
    small = replace(found, record=wild, misalignment=found.misalignment._replace(F_0=1.9))
    assert "too small: the force itself reaches 1.99" in "\n".join(creep.section(small).sentences)
    time = np.arange(0.0, 20.0, 1e-3)
    spiked = 0.4 + 0.1 * (time % 2.0)
    spiked[7000] = 99.9
    shown = st.analyse(st.Record(time=time, force=spiked)).parts["metadata"]
    assert "zero" not in [each.quantity for each in shown]  # it begins at two thirds of its force


def test_an_aligned_run_implies_no_misalignment(slider: st.Slider) -> None:
    found = st.analyse(st.simulate(slider.replace(phi="0 deg"), 5.0, sample_rate=10e3))
    assert (found.divergence, found.misalignment) == (None, None)
    assert "there is no misalignment" in found.missing["oscillation"]
    assert set(figures(found)) == {
        "cycles",
        "creep",
        "energy",
    }  # none of silence


def test_old_names_go_on_working_with_a_warning(run, found) -> None:
    with pytest.warns(DeprecationWarning, match="transverse_oscillation"):
        assert st.hear_song is st.analysis.transverse_oscillation
    with pytest.warns(DeprecationWarning, match="oscillation_by_phase"):
        assert st.song_by_phase is st.analysis.oscillation_by_phase
    with pytest.warns(DeprecationWarning, match="oscillation"):
        assert found.song is found.oscillation
    assert "song" not in dir(found)
    assert {"oscillation", "energy", "plot"} <= {*dir(found)}


RIG = st.Slider(
    mass="80 g", k_x="2.3 kN/m", k_y="0.9 MN/m", phi="8 deg", normal_load="4 N",
    friction=st.ExponentialWeakening(mu_0=0.6, mu_inf=0.45, v_f="10 mm/s"),
    drive=st.ConstantVelocity("0.5 mm/s"),
)  # fmt: skip


def test_a_vibration_that_sticks_is_not_said_not_to() -> None:
    run = st.simulate(RIG, "8 s", sample_rate="10 kHz")
    text = str(st.analyse(run))
    late = run.statistics.time_stuck / 8.0
    assert 0.3 < late < 0.5
    assert "and sticks for 4" in text
    assert "without sticking" not in text
    assert "quicker than the 37.06 ms in which it swings on the spring along x alone" in text
    assert "they are defined for stick-slip, and this is transverse oscillation" in text
    measured = st.Record(time=run.data["time"].values, force=run.data["spring_x"].values)
    assert "stick" not in str(st.analyse(measured)).partition("Friction")[0]


def test_a_confidence_of_one_leaves_no_other_kind() -> None:
    assert "else" not in str(st.analysis.Regime("stick-slip", 0.996, {}, "harmonic vibration"))
    assert "(confidence 0.99; else" in str(
        st.analysis.Regime("stick-slip", 0.99, {}, "harmonic vibration")
    )


def test_a_mass_that_never_slips_does_not_creep_before_slip() -> None:
    run = st.simulate(
        RIG.replace(friction=st.Coulomb(mu_0=0.6), phi="0 deg"), "1 s", sample_rate="1 kHz"
    )
    text = str(st.analyse(run))
    assert "rests from beginning to end" in text
    assert "before" not in text.partition("Creep")[2].partition("Oscillation")[0]


def test_a_force_between_two_levels_has_no_kinetic_friction_in_any_table() -> None:
    time = np.arange(5000) * 2e-3
    record = st.Record(time=time, force=np.tanh(8.0 * np.sin(4.4 * time)), normal_load=9.0)
    found = st.analyse(record)
    assert found.friction.kinetic is None
    assert found.cycles.sizes["cycle"] > 3
    assert np.isnan(found.cycles["mu_kinetic"]).all()
    assert found.missing["mu_kinetic"].startswith("the force goes back and forth")
    assert "µ kinetic" not in str(found)


def test_a_single_break_away_is_named() -> None:
    time = np.arange(3000) * 4e-3
    force = np.where(time < 3.4, 0.9 * time, 2.6 + 0.46 * np.exp(-(time - 3.4) / 0.05))
    text = str(st.analyse(st.Record(time=time, force=force, normal_load=8.0)))
    assert "The mass breaks away once, and comes to slide steadily, at a force of 2.600 N." in text


def test_a_mass_that_rests_throughout_has_no_figure_of_creep() -> None:
    run = st.simulate(RIG.replace(friction=st.Coulomb(mu_0=0.9)), "20 ms", sample_rate="10 kHz")
    assert run.sticks.sizes["stick"] == 1
    assert "creep" not in figures(st.analyse(run))


NOISY = inside(24, (3e3, 2e4), (12.0, 60.0), (0.5, 4.0), (0.0, 0.4))


@pytest.mark.parametrize(("samples", "period", "noise", "loads"), NOISY)
def test_the_motion_agrees_with_the_oscillation_in_noise(samples, period, noise, loads):
    """A vibration that begins with sliding, in noise of half its amplitude to four times that."""
    number = np.arange(int(samples))
    force = 10.0 * np.minimum(number / (loads * samples + 1.0), 1.0)
    swings = np.sin(2.0 * np.pi * number / period) * (force == 10.0)
    scatter = noise * np.random.default_rng(1).standard_normal(len(number))
    found = st.analyse(st.Record(time=1e-3 * number, force=force + swings + scatter))
    said = found.parts["motion"]
    seen = found.oscillation["frequency"].values
    if np.isfinite(seen).mean() > 0.5 and abs(1e3 / period / 50.0 % 1.0) > 0.01:
        assert "swings" in said or "vibrates" in said or found.cycles.sizes["cycle"]
    if "hidden" in found.regime.evidence:
        assert 1e-3 * period * found.regime.evidence["hidden"] == pytest.approx(1.0, rel=0.01)
        assert found.regime.evidence["hidden_height"] == pytest.approx(2.0, rel=0.4)


def test_an_analysis_equals_its_copy(slider):
    found = st.analyse(st.simulate(slider, "1 s", sample_rate="1 kHz"))
    assert found == pickle.loads(pickle.dumps(found))
    assert found != st.analyse(st.simulate(slider, "1.1 s", sample_rate="1 kHz"))


@pytest.mark.parametrize(
    ("preset", "title"),
    [
        ("velocity_step_ageing", "Velocity steps"),
        ("slide_hold_slide", "Healing"),
        ("lugre_pre_sliding", "Hysteresis"),
        ("earthquake_cycle", ""),
    ],
)
def test_a_run_of_a_test_with_a_name_is_told_as_such(preset, title):
    """A run of velocity steps was a "vibration", with a table of its cycles."""
    found = st.analyse(st.run(getattr(st.presets, preset)()))
    titles = [section.title for section in found.tables()]
    assert titles[1] == (title or "Motion")  # no warning says which analysis suits the test
    its = found.parts["procedure"]
    assert str(its or "") == str(found.tables()[1] if title else "")


def test_a_test_and_its_report_have_one_friction_coefficient():
    """At 20 deg one report had "steady before 0.6046" and "first break-away 0.5681"."""
    law = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.25, v_f="1 mm/s")
    test = st.protocols.velocity_steps(["1 mm/s", "3 mm/s"], distance="6 mm")
    rig = {"mass": 0.25, "k_x": 1e3, "k_y": 1e5, "c_x": 30.0, "normal_load": 10.0}
    for angles, share in (
        ({"phi": "0 deg"}, 1.0),
        ({"phi": "10 deg"}, np.cos(np.radians(10.0))),
        ({"phi": "10 deg", "cell_angle": "0 deg"}, 1.0),
    ):
        slider = st.Slider(**rig, **angles, friction=law, drive=test)
        run = st.simulate(slider, sample_rate="200 Hz")
        found = st.analyse(run)
        assert "Velocity steps" in str(found)
        (step,) = found.parts["procedure"].steps
        late = run.samples["mu"][run.samples["time"] > run.samples["time"][-1] - 0.4]
        assert step.steady_after == pytest.approx(float(late.mean()), rel=1e-6)
        # where the rig is turned, friction turns on with the way: over 6 mm to some 1e-3
        assert step.steady_after == pytest.approx(share * law.coefficient(3e-3), rel=3e-3)


def test_a_run_that_is_too_short_for_a_slip_is_told_how_long_would_do() -> None:
    law = st.laws.RateStateAgeing(mu_star=0.6, a=0.009, b=0.013, D_c="5 um", V_star="1 um/s")
    rig = st.Slider(
        mass="2 kg", k_x="0.5 N/um", k_y="50 N/um", phi="2 deg", normal_load="1 kN", friction=law,
        drive=st.ConstantVelocity("5 um/s"),
    )  # fmt: skip
    said = str(st.analyse(st.simulate(rig, "120 s", sample_rate="20 Hz")))
    assert (
        "it rests or creeps: the force only rises; it takes about 240 s to load a spring to" in said
    )
    assert "the 593.6 N that friction can hold; set a longer duration." in said


def test_a_mean_has_the_digits_of_its_standard_error() -> None:
    """Which is the standard deviation, 0.5 s, over the root of the number of cycles."""
    for count, words in ((100, "2.04 s"), (1, "2.0 s"), (10_000, "2.035 s")):
        row = {"mean": 2.0351, "standard_deviation": 0.5, "number": count, "unit": "s"}
        columns = {name: ("quantity", [value]) for name, value in row.items()}
        assert mean_in_words(xr.Dataset(columns, {"quantity": ["period"]}), "period") == words


def test_the_figure_of_creep_names_its_end_as_the_text_does() -> None:
    """Of a mass that comes to slide without a slip it showed the "time to slip"."""
    slider = st.presets.nakano_popov_2020()
    steady = slider.replace(friction=st.ExponentialWeakening(0.15, 0.20, "10 mm/s"), phi="2 deg")
    for rig, text, label in (
        (steady, "before the spring is loaded it", "time until the spring is loaded (s)"),
        (slider, "before slip it", "time to slip (s)"),
    ):
        found = st.analyse(st.simulate(rig, "5 s", sample_rate="1 kHz"))
        assert text in " ".join(str(found).split())
        assert figures(found)["creep"].axes[0].get_xlabel() == label


def test_an_analysis_says_that_its_run_ended_early():
    """The loading seemed stuck for sure, and nothing said that the run had stopped half-way."""
    short = st.simulate(st.presets.nakano_popov_2020(), "5 s", max_steps=2000)
    whole = st.simulate(short.slider, float(short.final.time))
    part, all_of_it = st.analyse(short), st.analyse(whole)
    assert part.warnings[0].startswith(
        "The run ended early, at 1.859 s of 5 s: the run used up its"
    )
    assert not all_of_it.warnings
    assert part.regime.kind == all_of_it.regime.kind == "stuck"
    share = float(short.final.time) / 5.0
    assert part.regime.confidence == pytest.approx(share * all_of_it.regime.confidence, rel=1e-3)
    assert "the run ended early, at 1.859 s" in str(part.regime)
    assert st.analysis.classify(short) == part.regime


def test_cycles_before_an_early_end_are_what_they_are():
    run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="1 kHz")
    cut = replace(run, status=st.Status.TOO_MANY_STEPS)
    assert st.analyse(cut).regime == st.analyse(run).regime
    assert len(st.analyse(cut).warnings) == len(st.analyse(run).warnings) + 1


def brief_of(record: st.Record) -> str:
    """Return the answer in short as one text, as the command line writes it."""
    with suggest(as_option):
        return " ".join(" ".join(st.analyse(record).tables()[0].sentences).split())


def test_the_brief_says_how_a_force_with_the_other_sign_is_read(tmp_path):
    """The remedy stood under Motion alone, beside "the mass may not slide"."""
    time = np.arange(0.0, 20.0, 0.01)
    force = -1.0 - 0.4 * (time % 0.93) + 1e-3 * np.random.default_rng(1).standard_normal(len(time))
    path = tmp_path / "negative.csv"
    rows = "".join(f"{t:.2f},{f:.5f}\n" for t, f in zip(time, force, strict=True))
    path.write_text(f"time [s],Fx [N]\n{rows}")
    said = brief_of(st.read_record(path))
    assert "Analyse the file with --force '2=-1 N'" in said
    assert "Friction: not determined (the force seems to have the other sign)" in said


def test_the_brief_names_the_column_by_which_strokes_are_read(tmp_path):
    """The column was named in the last part alone."""
    time = np.arange(0.0, 20.0, 0.01)
    place = 2.0 - np.abs(2.0 - time % 4.0)
    force = np.where(time % 4.0 < 2.0, 1.0, -1.0) * np.minimum(4.0 * (time % 2.0), 1.0)
    path = tmp_path / "strokes.csv"
    rows = (f"{t:.2f},{x:.4f},{f:.5f}\n" for t, x, f in zip(time, place, force, strict=True))
    path.write_text("time [s],x [mm],Fx [N]\n" + "".join(rows))
    said = brief_of(st.read_record(path))
    assert "if column 2 'x [mm]' is the displacement of the drive, say --drive-position 2" in said
    assert "--stroke all" in said
    said = brief_of(st.read_record(path, drive_position="2"))
    assert "--stroke 1 reads the first, and --stroke all each of them" in said
