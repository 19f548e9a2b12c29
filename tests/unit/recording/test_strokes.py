import re

import numpy as np
import pytest

import stiction as st
from stiction.analysis.export import full_report
from stiction.analysis.measurement.reading import read_source
from stiction.cli import main
from stiction.recording.strokes import strokes

REACH, PERIOD = 4.0, 8.0  # mm, s
TIME = np.arange(0.0, 20.0, 0.01)


def to_and_fro(time: np.ndarray, dwell: float = 0.0) -> np.ndarray:
    """Return a displacement between 0 and 4 mm at 1 mm/s, which turns at 0, 4, 8, ... s."""
    there = PERIOD / 2.0 + dwell
    at = time % (2.0 * there)
    way = np.clip(at, 0.0, REACH) - np.clip(at - there, 0.0, REACH)
    return np.asarray(way)


@pytest.fixture
def path(tmp_path):
    """A force that follows the direction of the drive, 0.2 N to 0.25 N."""
    stage = to_and_fro(TIME)
    force = np.sign(np.gradient(stage)) * (0.2 + 0.05 * (TIME % 1.0))
    rows = "".join(f"{t:.2f},{x:.4f},{f:.5f}\n" for t, x, f in zip(TIME, stage, force, strict=True))
    target = tmp_path / "to-and-fro.csv"
    target.write_text(f"time [s],stage [mm],Fx [N]\n{rows}")
    return target


@pytest.mark.parametrize(("dwell", "noise"), [(0.0, 0.0), (0.0, 0.01), (1.0, 0.01)])
def test_a_stroke_is_what_lies_between_two_turns(dwell, noise):
    scatter = noise * np.random.default_rng(3).standard_normal(len(TIME))
    found = strokes(to_and_fro(TIME, dwell) + scatter)
    assert [each.way for each in found] == ([1.0, -1.0] * 3)[: len(found)]
    assert len(found) == (5 if dwell == 0.0 else 4)
    # 2 % of the reach is 0.08 mm: the middle of what lies so near an end is the turn
    turns = [float(TIME[each.samples][-1]) for each in found[:-1]]
    expected = [4.0, 8.0, 12.0, 16.0] if dwell == 0.0 else [4.5, 9.5, 14.5]
    assert turns == pytest.approx(expected, abs=0.08)


def test_a_stroke_that_is_cut_by_the_beginning_counts_from_half_of_its_length_on():
    later = TIME + 1.5  # 2.5 mm of 4 are left of it
    assert len(strokes(to_and_fro(later))) == 5
    latest = TIME + 2.5
    first = strokes(to_and_fro(latest))[0]
    assert first.way == -1.0
    assert TIME[first.samples][0] == pytest.approx(1.5, abs=0.08)


@pytest.mark.parametrize("dwell", [0.0, 0.5])
@pytest.mark.parametrize("count", [1, 2, 4])
def test_strokes_from_the_first_sample_to_the_last_leave_none_out(count, dwell):
    """1 % of the way, and the unloaded spring with it, was cut off at both ends of a record."""
    time = np.arange(0.0, count * (PERIOD / 2.0 + dwell) + 0.005, 0.01)
    scatter = 0.01 * np.random.default_rng(5).standard_normal(len(time))
    for noise in (0.0, scatter):
        for position in (to_and_fro(time, dwell), REACH - to_and_fro(time, dwell)):
            found = strokes(position + noise)
            assert len(found) == count
            assert (found[0].samples.start, found[-1].samples.stop) == (0, len(time))


def test_a_drive_that_does_not_turn_makes_one_stroke():
    assert len(strokes(TIME)) == 1
    assert len(strokes(np.zeros(10))) == 1


def test_a_way_back_is_read_as_a_way_there(path):
    there, back = (st.read_record(path, stroke=number) for number in (1, 2))
    for record in (there, back):
        assert record.force[50:-50].min() >= 0.2
        assert np.diff(record.drive_position[50:-50]).min() > 0.0
    assert there.time[-1] == pytest.approx(4.0, abs=0.08)
    assert back.time[0] == there.time[-1]
    assert "Stroke 2 of 5" in str(back.origin)
    assert "turned round" in str(back.origin)
    assert "turned round" not in str(there.origin)
    uses = {use.channel: use for use in back.origin.uses}
    assert uses["drive_position"].largest == pytest.approx(0.0, abs=1e-4)
    assert uses["force"].least == back.force.min()


def test_a_stored_record_and_the_toml_beside_a_file_have_strokes_too(path, tmp_path):
    st.read_record(path).save(tmp_path / "whole.nc")
    stored = st.read_record(tmp_path / "whole.nc", stroke=2)
    path.with_suffix(".toml").write_text("[reading]\nstroke = 2\n")
    assert np.array_equal(st.read_record(path).force, stored.force)


def test_strokes_that_are_not_there_are_refused_with_a_remedy(path, tmp_path, capsys):
    with pytest.raises(st.ResultError, match="has 5 strokes; there is no stroke 6"):
        st.read_record(path, stroke=6)
    with pytest.raises(st.DescriptionError, match="stroke: must not be below 1, is 0"):
        st.read_record(path, stroke=0)
    alone = tmp_path / "force.csv"
    alone.write_text("time [s],Fx [N]\n" + "".join(f"{t},0.2\n" for t in range(9)))
    with pytest.raises(st.ResultError, match=r"of the drive; say .* as drive_position='stage=mm'"):
        st.read_record(alone, stroke=1)
    with pytest.raises(SystemExit) as ended:
        main(["analyse", str(path), "--block", "2"])
    assert ended.value.code == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "has 1 block; there is no block 2. A block begins where the times of the file" in said
    assert "is read by --stroke 2" in said


def test_an_analysis_of_a_record_to_and_fro_says_how_to_read_a_stroke(path):
    whole = str(st.analyse(st.read_record(path)))
    assert "stroke=1 of st.read_record reads the first" in " ".join(whole.split())
    found = st.analyse(st.read_record(path, stroke=2))
    assert "back and forth" not in str(found)


def test_all_strokes_are_read_at_once_and_have_a_row_each_and_their_mean(path, tmp_path, capsys):
    """Each needed a command: "unable to convert "all" into int"."""
    found = st.read_records(path, stroke="all")
    each = [st.read_record(path, stroke=number) for number in range(1, 6)]
    assert [x.force.tolist() for x in found] == [x.force.tolist() for x in each]
    with pytest.raises(st.ResultError, match=r"has 5 strokes.*stroke=1 for one of them"):
        st.read_record(path, stroke="all")
    folder = tmp_path / "o"
    asked = ["--stroke", "all", "--normal-load", "1N", "-o", str(folder)]
    with pytest.raises(SystemExit) as ended:
        main(["analyse", str(path), *asked])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert all(f"to-and-fro.csv, stroke {number}" in " ".join(said.split()) for number in (1, 5))
    assert "Mean of the strokes" in said
    assert "Mean of the strokes" in (folder / "report.txt").read_text("utf-8")


def test_the_mean_of_strokes_has_the_error_of_their_scatter():
    """A zero that is off by 0.1 N shifts the ways forth and back apart; their mean stays."""
    time, inside = np.arange(0.0, 12.0, 5e-3), 0
    for number in range(20):
        random = np.random.default_rng([31, number])
        found = {}
        for stroke in range(6):
            level = 2.0 + 0.1 * (-1.0) ** stroke + 0.02 * random.normal()
            force = level + 0.5 * (time % 1.0) + 1e-3 * random.normal(size=len(time))
            found[f"stroke {stroke}"] = st.analyse(
                st.Record(time=time, force=force, normal_load=5.0)
            )
        (row,) = [row for row in st.analysis.mean_over(found).table.rows if row[0] == "static"]
        mean, error = map(float, row[2].split(" ± "))
        assert row[1] == "6"
        inside += abs(mean - 0.5) < 2.0 * error
    assert inside >= 18


def test_swings_of_a_drive_that_turns_are_not_cycles_of_slips():
    """ "2 cycles ... force at the trough after slip -500 mN" stood below "Undetermined"."""
    seen = 0
    for number in range(12):
        random = np.random.default_rng([32, number])
        time = np.arange(0.0, 40.0, 0.01)
        turn = np.clip(8.0 * np.sin(2.0 * np.pi * time / random.uniform(4.0, 9.0)), -1.0, 1.0)
        force = 0.5 * turn + 10 ** random.uniform(-3.0, -2.0) * random.normal(size=len(time))
        found = st.analyse(st.Record(time=time, force=force, normal_load=1.0))
        parts = {part.title: part for part in full_report(found)}
        assert found.regime.kind == "undetermined"
        seen += found.cycles.sizes["cycle"] > 0
        assert parts["Cycles"].table is None
        assert "Cycle by cycle" not in parts
    assert seen > 6


def test_a_spring_that_is_loaded_backwards_after_a_turn_is_no_zero_that_is_off():
    """From -0.2 N up at 0.1 N/s, then stick-slip."""
    time = np.arange(0.0, 30.0, 0.01)
    force = np.where(time < 4.0, -0.2 + 0.1 * time, 0.2 - 0.05 * ((time - 4.0) % 1.0 > 0.5))
    noise = 1e-4 * np.random.default_rng(2).standard_normal(len(time))
    said = " ".join(st.analyse(st.Record(time=time, force=force + noise)).warnings)
    assert "The spring was loaded already, as after a turn of the drive, or the zero is off" in said
    assert "give zero='" not in said


def stick_slip_to_and_fro(tmp_path, off=0.0, seed=7):
    """Write stick-slip between 0.9 N and 1 N whose spring is loaded over 1 mm after each turn."""
    time = np.arange(0.0, 24.0, 0.01)
    stage, way = to_and_fro(time), np.where(time % PERIOD < PERIOD / 2.0, 1.0, -1.0)
    since = time % (PERIOD / 2.0)
    begins = np.where(time < PERIOD / 2.0, 0.0, -1.0)
    loading = begins + (1.0 - begins) * since
    force = way * np.where(since < 1.0, loading, 1.0 - 0.1 * (1.0 - (since - 1.0) / 0.3 % 1.0))
    force += off + 2e-3 * np.random.default_rng(seed).standard_normal(len(time))
    rows = "".join(f"{t:.2f},{x:.4f},{f:.5f}\n" for t, x, f in zip(time, stage, force, strict=True))
    target = tmp_path / "strokes.csv"
    target.write_text(f"time [s],stage [mm],Fx [N]\n{rows}")
    return target


def test_a_stroke_after_a_turn_of_the_drive_need_not_show_the_unloaded_spring(tmp_path):
    """Each of five strokes warned, and its zero would have shifted friction."""
    for record in st.read_records(stick_slip_to_and_fro(tmp_path), stroke="all"):
        found = st.analyse(record)
        assert not any("zero" in each for each in found.warnings)
        assert found.friction.static.force == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("off", [0.05, -0.15])
def test_forces_forth_and_back_show_a_zero_that_is_off(tmp_path, off):
    """One value of the zero serves for all strokes: as the file has its forces."""
    path = stick_slip_to_and_fro(tmp_path, off)
    for record in st.read_records(path, stroke="all"):
        found = st.analyse(record)
        (said,) = (each for each in found.warnings if "zero" in each)
        named = float(said.split("give zero='")[1].split(" N'")[0])
        assert named == pytest.approx(off, abs=0.01)
        static = found.friction.static
        assert abs(static.force - 1.0) < 1.2 * static.error
    for record in st.read_records(path, stroke="all", zero=off):
        found = st.analyse(record)
        assert not any("zero" in each for each in found.warnings)
        assert found.friction.static.force == pytest.approx(1.0, abs=0.01)


def test_a_zero_is_turned_round_on_a_way_back(path, tmp_path):
    """It was subtracted from forces that had been turned round: the error was twice the zero."""
    whole = st.read_record(path)
    whole.save(tmp_path / "whole.nc")
    for source in (path, tmp_path / "whole.nc"):
        plain, zeroed = (st.read_record(source, stroke=2, zero=z) for z in (None, "50 mN"))
        assert zeroed.force == pytest.approx(plain.force + 0.05)


def test_a_stored_stroke_keeps_its_place_among_the_strokes(path, tmp_path):
    stroke = st.read_record(path, stroke=2)
    assert (stroke.origin.stroke.way, stroke.origin.stroke.after_turn) == (-1.0, True)
    stored = st.read_record(stroke.save(tmp_path / "second.nc"))
    assert stored.origin.stroke == stroke.origin.stroke


def test_the_zero_of_a_later_stroke_is_less_certain_if_it_drifts(path):
    path.with_suffix(".toml").write_text(
        '[sensors.force]\nzero_uncertainty = "30 mN"\nzero_drift = "0 +- 10 mN/s"\n'
    )
    first, second = (st.read_record(path, stroke=number).sensors["force"] for number in (1, 2))
    assert first.zero_uncertainty == pytest.approx(0.03, rel=0.001)
    # the stage turns at 4 s, which is known to 2 % of the stroke
    assert second.zero_uncertainty == pytest.approx(0.05, rel=0.02)
    assert first.zero_drift_uncertainty == second.zero_drift_uncertainty == 0.01


def test_a_part_between_two_times_is_read(path, tmp_path, capsys):
    """Messages advised "a part without gaps", "cycles after running in"; no command took one."""
    whole = st.read_record(path)
    part = st.read_record(path, begin="6 s", end=10.0)
    inside = (whole.time >= 6.0) & (whole.time <= 10.0)
    assert part.time == pytest.approx(whole.time[inside])
    assert part.force == pytest.approx(whole.force[inside])
    assert "a part, from 6 s to 10 s" in part.origin.notes
    whole.save(tmp_path / "whole.nc")
    stored = st.read_record(tmp_path / "whole.nc", begin="6 s", end="10 s")
    assert stored.force == pytest.approx(part.force)
    path.with_suffix(".toml").write_text('[reading]\nbegin = "6.5 s"\n')
    assert st.read_record(path).time[0] == pytest.approx(6.5)
    assert st.read_record(path, stroke=1).time[0] == pytest.approx(8.0)  # the first whole one
    with pytest.raises(st.ResultError, match=r"0 samples between.* its times go from 0 s to 19.99"):
        st.read_record(path, begin="30 s")
    with pytest.raises(st.DescriptionError, match="begin: '3 N' is in N"):
        st.read_record(path, begin="3 N")
    with pytest.raises(SystemExit) as ended:
        main(["import", str(path), "--begin", "6s", "--end", "10 s"])
    assert ended.value.code == 0
    assert "A part, from 6 s to 10 s." in capsys.readouterr().out


def test_a_fit_takes_all_strokes_together(tmp_path, monkeypatch, capsys):
    """It was advised, and refused."""
    fitted = []

    def observe(records, _):
        fitted.extend(records)
        raise st.ResultError("enough")

    monkeypatch.setattr("stiction.inference.measured.observed_rig.observe_rig", observe)
    path = stick_slip_to_and_fro(tmp_path)
    rig = tmp_path / "rig.toml"
    rig.write_text(st.presets.nakano_popov_2020().to_toml())
    output = ["-o", str(tmp_path / "fit.nc"), "--library", str(tmp_path / "library")]
    output += ["--stroke", "all"]
    with pytest.raises(SystemExit):
        main(["fit", str(path), "--rig", str(rig), "--set", "phi=2 +- 1 deg", *output])
    assert "enough" in capsys.readouterr().err
    assert [each.force.tolist() for each in fitted] == [
        each.force.tolist() for each in st.read_records(path, stroke="all")
    ]


def test_an_audit_of_all_strokes_names_one_and_what_takes_all(tmp_path, capsys):
    """In a terminal it named a function of Python."""
    path, rig = stick_slip_to_and_fro(tmp_path), tmp_path / "rig.toml"
    rig.write_text(st.presets.nakano_popov_2020().to_toml())
    with pytest.raises(SystemExit):
        main(["audit", str(rig), "--record", str(path), "--stroke", "all"])
    said = " ".join(capsys.readouterr().err.split())
    assert "say --stroke 1 for one of them" in said
    assert "`stiction fit --stroke all` takes them together" in said
    with pytest.raises(st.ResultError, match=r"stroke='all'\) reads all, and st.fit takes them"):
        read_source(path, stroke="all")


@pytest.mark.parametrize("number", [2, 3, 5, 6])
def test_the_zero_of_a_load_cell_cancels_in_the_mean_of_both_ways(number, tmp_path):
    """Each stroke was off by the zero, and the mean as uncertain; of five strokes it was off."""
    within = determined = 0
    for seed in range(6):
        random = np.random.default_rng([33, number, seed])
        time = np.arange(0.0, 12.0 * number, 5e-3)
        position = 12.0 - np.abs((time % 24.0) - 12.0)
        way = np.where(time % 24.0 < 12.0, 1.0, -1.0)
        level = 2.0 + 0.02 * random.normal(size=number)[(time // 12.0).astype(int)]
        force = way * (level + 0.5 * (time % 1.0)) + 0.8 + 1e-3 * random.normal(size=len(time))
        path = tmp_path / f"{seed}.csv"
        lines = [f"{t:.4f},{f:.5f},{x:.4f}" for t, f, x in zip(time, force, position, strict=True)]
        path.write_text("\n".join(["time [s],force [N],stage [mm]", *lines]))
        records = st.read_records(path, stroke="all", normal_load="5 N")
        found = {f"stroke {at}": st.analyse(record) for at, record in enumerate(records)}
        mean = st.analysis.mean_over(found)
        assert re.search("the zero of the force, here [78].* mN, cancels", mean.sentences[0])
        (row,) = [row for row in mean.table.rows if row[0] == "static"]
        value, *error = map(float, row[2].split(" ± "))
        assert value == pytest.approx(0.5, abs=0.02)
        determined += len(error)
        within += not error or abs(value - 0.5) < 2.0 * error[0]
    assert determined == (6 if number > 2 else 0)
    assert within >= 5
