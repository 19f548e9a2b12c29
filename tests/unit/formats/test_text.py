"""Files of text with the quirks of instruments: one small file for each."""

import codecs
import gzip
import re
import zipfile

import numpy as np
import pytest

import stiction as st
from stiction.formats.text.cell_units import without_units
from stiction.formats.units import size_of

COUNT = 8
TIME = 0.5 * np.arange(COUNT)
FORCE = 1.0 + 0.1 * np.arange(COUNT)


def lines(separator=",", decimal=".", end="\n", columns=(TIME, FORCE), digits=3):
    """The lines of some columns."""
    rows = zip(*columns, strict=True)
    return "".join(
        separator.join(f"{x:.{digits}f}".replace(".", decimal) for x in row) + end for row in rows
    )


@pytest.fixture
def write(tmp_path):
    """Write a file, and return its path."""

    def put(content, name="data.csv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return put


def notes(record):
    return " | ".join(record.origin.notes)


# --- layout ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("separator", ["\t", ";", ",", "|", " ", ";\t "])
def test_any_separator(write, separator):
    path = write(f"time [ms]{separator}force [mN]\n{lines(separator)}")
    record = st.read_record(path)
    assert np.allclose(record.time, 1e-3 * TIME, rtol=1e-15)
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-15)


def test_a_column_by_its_number(write):
    path = write(f"t [ms],a [mN],b [N]\n{lines(columns=(TIME, FORCE, 2.0 * FORCE))}")
    assert np.allclose(st.read_record(path, force=3, load="2").force, 2.0 * FORCE, rtol=1e-15)
    with pytest.raises(st.DescriptionError, match=r"load: 2\.5 is not a column") as error:
        st.read_record(path, force=True, load=2.5)
    assert "force: True is not a column" in str(error.value)


@pytest.mark.parametrize("separator", ["\t", ";", " "])
def test_a_decimal_comma(write, separator):
    path = write(f"Zeit{separator}Kraft\nms{separator}mN\n{lines(separator, ',')}")
    record = st.read_record(path)
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-15)
    assert "decimal comma" in notes(record)


@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("day", ["2026-03-12", "12.03.2026", "3/12/26"])
@pytest.mark.parametrize(
    ("separator", "counted"),
    [
        ("\t", False),
        ("\t", True),
        (";", False),
        (";", True),
        ("|", False),
        ("|", True),
        ("  ", False),
    ],
)
def test_a_date_and_a_clock_in_one_column(write, separator, day, decimal, counted):
    header = ["#"] * counted + ["Time", "Fx [mN]", "Fn [N]"]
    rows = (
        ([f"{at + 1}"] * counted)
        + [f"{day} 10:15:{x:06.3f}".replace(".000", ".0"), f"{y:.3f}", f"{4 * y:.3f}"]
        for at, (x, y) in enumerate(zip(TIME, FORCE, strict=True))
    )
    first, *others = (separator.join(row) for row in [header, *rows])
    texts = [first, *(x.replace(day, "*").replace(".", decimal).replace("*", day) for x in others)]
    record = st.read_record(write("\n".join(texts)))
    assert np.allclose(record.time, TIME, atol=1e-9)
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-15)
    assert np.allclose(record.load, 4.0 * FORCE, rtol=1e-15)


def test_commas_between_numbers_with_points_separate(write):
    """A comment of one cell is no headings of columns of half numbers."""
    record = st.read_record(write(f"# a stage\n{lines()}"), time="1=s", force="2=N")
    assert np.allclose(record.force, FORCE, rtol=1e-15)


def test_commas_that_separate_and_are_decimal_signs_are_refused(write):
    path = write(f"time [s],force [N]\n{lines(',', ',')}")
    with pytest.raises(st.ResultError, match="if not, write the file with semicolons"):
        st.read_record(path)


@pytest.mark.parametrize(
    ("separator", "one", "many"),
    [
        (";", "1500.5", "1,500.5"),
        ("\t", "1500.5", "1'500.5"),
        (";", "1500,5", "1.500,5"),
        ("\t", "1500,5", "1\u202f500,5"),
        (",", "1500.5", '"1,500.5"'),
        (";", "1234567", "1,234,567"),
    ],
)
def test_thousands_in_groups(write, separator, one, many):
    """They are told as such where nothing else can be meant; small numbers have none."""
    small = "999.25" if "." in one else "999,25" if "," in one else "999"
    rows = [(f"{i}", small if i % 2 else many) for i in range(40)]
    path = write(
        f"time [s]{separator}force [mN]\n" + "".join(f"{a}{separator}{b}\n" for a, b in rows)
    )
    record = st.read_record(path)
    values = [1e-3 * float(x.replace(",", ".")) for x in (one, small)]
    assert record.force[:2].tolist() == pytest.approx(values, rel=1e-15)
    assert "thousands in groups" in notes(record)
    assert st.read_record(write(path.read_text().replace(many, one))).force == pytest.approx(
        record.force, rel=1e-15
    )


def test_no_group_is_seen_in_columns(write):
    """Three digits after a comma may be a column of its own."""
    path = write("t [ms],a,b\n" + "".join(f"{i},{100 + i},200.5\n" for i in range(50)))
    record = st.read_record(path, force="3=N")
    assert record.force.tolist() == [200.5] * 50
    assert "thousands" not in notes(record)


def test_a_comma_that_may_group_thousands_is_refused(write):
    path = write("time [s];force [N]\n1,000;1,500\n1,100;1,600\n1,200;1,700\n")
    with pytest.raises(st.ResultError, match="or groups thousands; say decimal='comma'"):
        st.read_record(path)
    assert st.read_record(path, decimal="comma").force.tolist() == [1.5, 1.6, 1.7]


def test_trailing_commas(write):
    path = write(f"time [s],force [N],,\n{lines(end=',,' + chr(10))}")
    record = st.read_record(path)
    assert np.allclose(record.force, FORCE, rtol=1e-15)
    assert len(record.origin.uses) == 2


def test_line_ends_of_all_kinds(write):
    text = f"time [s],force [N]\r{lines(end=chr(13) + chr(10))}4.0,2.0\r4.5,2.1\n5.0,2.2"
    record = st.read_record(write(text))
    assert len(record) == COUNT + 3
    assert record.force[-3:].tolist() == [2.0, 2.1, 2.2]


@pytest.mark.parametrize(
    "encode",
    [
        lambda text: codecs.BOM_UTF8 + text.encode(),
        lambda text: text.encode("utf-16"),
        lambda text: codecs.BOM_UTF16_BE + text.encode("utf-16-be"),
        lambda text: text.encode("cp1252"),
        lambda text: gzip.compress(text.encode()),
    ],
    ids=["utf-8 with mark", "utf-16", "utf-16 be", "cp1252", "gzip"],
)
def test_encodings(write, encode):
    record = st.read_record(write(encode(f"time [s],force [µN]\n{lines()}")))
    assert np.allclose(record.force, 1e-6 * FORCE, rtol=1e-14)


def test_a_script_has_no_force(write):
    """A blank line between two of text has no columns whose names they might be."""
    with pytest.raises(st.ResultError, match="no column is the force along the drive"):
        st.read_record(write("exit 1\nfi\n\nif [ -n x ]; then\n"))


def test_lines_before_the_header_are_told(write):
    record = st.read_record(write(f"Test of 3 May\nOperator: X\n\ntime [s],force [N]\n{lines()}"))
    assert "2 lines above the samples beside names and units, first 'Test of 3 May'" in notes(
        record
    )


def test_a_recipe_line_with_as_many_commas_as_the_samples(write):
    text = "Recipe: hold, 5 N, 10 mm/s\ntime [s],force [N],load [N]\nRecipe: slide, 5, 10\n"
    columns = (TIME, FORCE, 5.0 + 0.0 * TIME)
    record = st.read_record(write(text + lines(columns=columns) + "Recipe: hold, 5, 10\n9,9,9\n"))
    assert np.allclose(record.force, [*FORCE, 9.0], rtol=1e-15)
    assert record.load.tolist() == [5.0] * COUNT + [9.0]
    assert "line 12 skipped: 'Recipe: hold, 5, 10'" in notes(record)


def test_a_units_row_shorter_than_the_header(write):
    text = "Zeit;Kraft;drive position;Kommentar\ns;mN;mm\n"
    rows = "".join(
        f"{t:.1f};{f:.1f};{i};7\n" for i, (t, f) in enumerate(zip(TIME, FORCE, strict=True))
    )
    record = st.read_record(write(text + rows))
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-15)
    assert np.allclose(record.drive_position, 1e-3 * np.arange(COUNT), rtol=1e-15)
    assert [use.unit for use in record.origin.uses] == ["s", "mN", "mm", ""]


def test_a_units_row_in_another_size_than_the_heading_is_refused(write):
    """Its unit was taken, and forces were a thousand times too large."""
    path = write(f"time [s],force [mN]\ns,N\n{lines()}")
    with pytest.raises(st.ResultError, match=r"column 2: its heading is 'force \[mN\]', the line"):
        st.read_record(path)
    same = write(f"time_s,Ch_A [V]\ns,V\n{lines()}", "same.csv")
    assert np.allclose(st.read_record(same, force="2=2 N/V").force, 2.0 * FORCE, rtol=1e-15)
    remark = write(f"# time [ms],force [N]\n# a\n{lines()}", "remark.csv")  # a is a year, too
    assert np.allclose(st.read_record(remark).force, FORCE, rtol=1e-15)


def test_a_rate_below_the_samples_is_that_of_a_file_without_times(write):
    path = write(
        "force [N]\n" + "".join(f"{value:.2f}\n" for value in FORCE) + "sample rate: 50 Hz\n"
    )
    shown = write("force [N]\n" + "".join(f"{value:.2f}\n" for value in FORCE), "bare.csv")
    with pytest.raises(st.ResultError, match="interval"):
        st.read_record(shown)
    assert st.read_record(path).sample_rate == pytest.approx(50.0)


def test_a_record_begins_at_its_first_clock_not_at_that_of_a_skipped_line(write):
    rows = [f"10:00:0{at}.5,{value:.2f}\n" for at, value in enumerate(FORCE)]
    rows[4] = "10:00:04.5,over range\n"
    path = write(f"clock,force [N]\n{''.join(rows)}saved at 10:31:00\n")
    assert st.read_record(path).origin.start == "10:00:00.5"


def test_a_header_repeated_mid_file_is_skipped(write):
    half = COUNT // 2
    first = lines(columns=(TIME[:half], FORCE[:half]))
    second = lines(columns=(TIME[half:], FORCE[half:]))
    header = "time;force\ns;N\n".replace(";", ",")
    record = st.read_record(write(header + first + header + second))
    assert np.allclose(record.time, TIME, rtol=1e-15)
    assert "line 7 skipped: a repeated header and 1 more line" in notes(record)


def test_a_few_of_many_skipped_lines_are_listed(write):
    """A cell out of its range beside a clock had a note for each sample."""
    rows = [f"10:15:{at:05.2f};{'over range' if at % 5 == 4 else 2.5}\n" for at in range(50)]
    found = st.read_record(write("Time;Force [N]\n" + "".join(rows))).origin.notes
    assert sum("skipped" in note for note in found) == 5
    assert "and 5 more skips" in found


def test_columns_of_the_same_name_are_refused_and_chosen_by_number(write):
    path = write(f"time [s],force [N],force [N]\n{lines(columns=(TIME, FORCE, 2.0 * FORCE))}")
    with pytest.raises(st.ResultError, match=r"2 'force \[N\]', 3 'force \[N\]'; say which"):
        st.read_record(path)
    assert np.allclose(st.read_record(path, force="3").force, 2.0 * FORCE, rtol=1e-15)


# --- units ----------------------------------------------------------------------------------------


def test_a_column_without_a_unit_is_refused(write):
    path = write(f"time,force\n{lines()}")
    with pytest.raises(st.ResultError, match="column 2 'force' states no unit of the force"):
        st.read_record(path)
    with pytest.raises(
        st.ResultError, match="column 1 'time' states no unit of time; say its unit"
    ):
        st.read_record(path, force="mN")
    with pytest.raises(st.ResultError, match=r"force='2=mN' of .*\n.*='1=ms' of"):
        st.analyse(path)
    record = st.read_record(path, time="ms", force="mN")
    assert record.time[1] == 0.5e-3
    assert record.force[0] == 1e-3


@pytest.mark.parametrize("header", ["a,b", "ch1,ch2", "A0,B1", "s,N"])
def test_names_that_are_units_too(write, header):
    """`a` is a year and `b` a bit; without names above them they are names."""
    names = header.split(",")
    record = st.read_record(
        write(f"recipe 5\n{header}\n{lines()}"), time=f"{names[0]}=ms", force=f"{names[1]}=N"
    )
    assert [use.heading for use in record.origin.uses] == names
    assert record.time[1] == 0.5e-3


def test_columns_without_names(write):
    path = write(lines())
    with pytest.raises(st.ResultError, match="columns: 1 'column 1', 2 'column 2'; say for"):
        st.read_record(path)
    assert st.read_record(path, time="ms", force="N").time[1] == 0.5e-3
    assert st.read_record(path, time="2=ms", force="1=N").force[1] == 0.5


@pytest.mark.parametrize(
    ("unit", "size"),
    [
        ("g", 9.80665e-3),
        ("kgf", 9.80665),
        ("gf", 9.80665e-3),
        ("cN", 0.01),
        ("lbf", 4.4482216152605),
    ],
)
def test_grams_of_force(write, unit, size):
    record = st.read_record(write(f"time [s],force [{unit}]\n{lines()}"))
    assert np.allclose(record.force, size * FORCE, rtol=1e-12)
    assert ("read as gram-force" in notes(record)) == (unit == "g")


@pytest.mark.parametrize("said", [{}, {"force": "MPa"}])
def test_a_stress_is_a_force_by_the_area_it_acts_on(write, said):
    path = write("time [s],shear stress [MPa]\n" + lines(columns=(TIME, FORCE[::-1])))
    with pytest.raises(
        st.ResultError,
        match=r"force='2=\? mm\^2\*MPa', with its number in place of \?; a stress times the area",
    ):
        st.read_record(path, **said)
    record = st.read_record(path, force="2=25 mm^2*MPa")
    assert record.force == pytest.approx(25.0 * FORCE[::-1])


@pytest.mark.parametrize("said", [{}, {"force": "MN"}])
def test_meganewtons_are_named_in_words(write, said):
    record = st.read_record(write("time [s],force [MN]\n" + lines()), **said)
    assert "MN is read as meganewtons, a million newtons each; millinewtons are mN" in notes(record)
    for unit in ("mN", "kN", "N", "GN", "Mdyn"):
        record = st.read_record(write(f"time [s],force [{unit}]\n" + lines()))
        assert "meganewtons" not in notes(record)


def test_a_unit_that_is_a_time_is_none_of_a_force(write):
    path = write(f"time [s],force [s]\n{lines()}")
    with pytest.raises(st.ResultError, match="no column is the force along the drive"):
        st.read_record(path)
    with pytest.raises(st.ResultError, match="'bar' is neither a column nor a unit such as mN"):
        st.read_record(path, force="bar")


def test_a_negative_normal_load_is_turned_and_told(write):
    record = st.read_record(
        write(f"time [s],Fx [N],Fz [N]\n{lines(columns=(TIME, FORCE, -FORCE))}")
    )
    assert np.allclose(record.load, FORCE, rtol=1e-15)
    assert record.normal_load == pytest.approx(FORCE.mean(), rel=1e-15)
    assert "the normal load is negative" in notes(record)


def test_volts_whose_scale_stands_elsewhere(write):
    path = write(f"CH1 scale 2.5 N/V\ntime [s],CH1 [mV]\n{lines()}")
    with pytest.raises(st.ResultError) as error:
        st.read_record(path)
    assert "column 2 'CH1 [mV]' is in mV, and its scale is needed; say force='2=? N/mV'" in str(
        error.value
    )
    assert "line 1 says 'CH1 scale 2.5 N/V'" in str(error.value)
    record = st.read_record(path, force="CH1=-2.5 N/V")
    assert np.allclose(record.force, -2.5e-3 * FORCE, rtol=1e-15)


def test_a_word_that_is_a_column_and_a_unit_is_refused(write):
    path = write(f"t [s],N [N],F [N]\n{lines(columns=(TIME, FORCE, FORCE))}")
    with pytest.raises(st.ResultError, match="'N' is a column and a unit; say force='N='"):
        st.read_record(path, force="N")
    assert np.allclose(st.read_record(path, force="N=").force, FORCE, rtol=1e-15)


def test_a_load_alone_may_be_either_force(write):
    path = write(f"time [s],load [N]\n{lines()}")
    with pytest.raises(st.ResultError, match="say force=2 or load=2"):
        st.read_record(path)
    assert st.read_record(path, force="load").load is None


@pytest.mark.parametrize(
    ("header", "size"),
    [("t/ms,F/mN", 1e-3), ("t / ms,F / mN", 1e-3), ("t (s),F (N)", 1.0), ("t in s,F in N", 1.0)],
)
def test_symbols_with_their_units_are_names(write, header, size):
    # units of both columns as well: t/s is a tonne a second, F/N a farad a newton
    record = st.read_record(write(f"{header}\n{lines()}"))
    assert np.allclose(record.time, size * TIME, rtol=1e-15)
    assert np.allclose(record.force, size * FORCE, rtol=1e-15)


def test_a_friction_coefficient_needs_the_normal_load(write):
    path = write(f"time [s],F/mg [-]\n{lines()}")
    with pytest.raises(st.ResultError, match="is a friction coefficient"):
        st.read_record(path)
    assert np.allclose(st.read_record(path, normal_load="2 N").force, 2.0 * FORCE, rtol=1e-15)


def test_a_displacement_of_the_mass_or_of_the_drive_is_asked_for(write):
    path = write(f"time [s],force [N],displacement [mm]\n{lines(columns=(TIME, FORCE, TIME))}")
    plain = st.read_record(path)
    assert plain.position is plain.drive_position is None
    assert "of the mass (position=3) or of the drive (drive_position=3)?" in notes(plain)
    assert np.allclose(st.read_record(path, position="3").position, 1e-3 * TIME, rtol=1e-15)


# --- times ----------------------------------------------------------------------------------------


def test_blocks_that_restart_with_the_wall_clock_in_the_header_only(write):
    header = "# started 2024-05-03 12:0{}:07\ntime [s],force [N]\n"
    text = "".join(
        header.format(block) + lines(columns=(TIME, block + FORCE)) for block in range(3)
    )
    path = write(text)
    records = st.read_records(path)
    assert [record.origin.start for record in records] == [
        f"2024-05-03 12:0{block}:07" for block in range(3)
    ]
    for block, record in enumerate(records):
        assert np.allclose(record.force, block + FORCE, rtol=1e-15)
        assert record.time[0] == 0.0
    with pytest.raises(st.ResultError, match="holds 3 blocks: 1 at 2024-05-03 12:00:07, 8 samples"):
        st.read_record(path)
    assert st.read_record(path, block=2).origin.start == "2024-05-03 12:01:07"
    with pytest.raises(st.ResultError, match="has 3 blocks; there is no block 4"):
        st.read_record(path, block=4)
    (second,) = st.read_records(path, block=2)
    path.with_suffix(".toml").write_text("[reading]\nblock = 2\n")
    for record in (second, st.read_record(path), *st.read_records(path)):
        assert record.origin.start == "2024-05-03 12:01:07"
        assert (record.origin.block, record.origin.blocks) == (2, 3)


def test_a_block_of_one_sample_is_left_out(write):
    """As a logger leaves one that is stopped at once."""
    short = lines(columns=(TIME[-1:], FORCE[:1]))
    path = write("time [s],force [N]\n" + short + lines() + lines())
    records = st.read_records(path)
    assert [len(record) for record in records] == [len(TIME), len(TIME)]


def test_blocks_of_other_columns(write):
    text = f"time [s],force [N]\n{lines()}\nTime [ms],load [N],Force [mN]\n"
    first, second = st.read_records(write(text + lines(columns=(TIME, 5.0 + TIME, FORCE))))
    assert np.allclose(first.force, FORCE, rtol=1e-15)
    assert np.allclose(second.force, 1e-3 * FORCE, rtol=1e-15)
    assert np.allclose(second.time, 1e-3 * TIME, rtol=1e-15)
    assert first.load is None
    assert np.allclose(second.load, 5.0 + TIME, rtol=1e-15)


def test_one_file_a_stroke_in_the_order_of_their_numbers(tmp_path):
    for number in (10, 13, 4, 7):
        text = f"time [s],force [N]\n{lines(columns=(TIME, number + FORCE))}"
        (tmp_path / f"stroke {number}.csv").write_text(text)
    found = [round(float(each.force[0] - 1.0)) for each in st.read_records(tmp_path)]
    assert found == [4, 7, 10, 13]


def test_labels_of_steps_that_sort_as_texts_keep_the_order_of_the_file(write):
    rows = "".join(f"{step};{t:.1f};{step}\n" for step in (10, 13, 4, 7) for t in TIME)
    records = st.read_records(write(f"step;time [s];force [N]\n{rows}"))
    assert [each.origin.label for each in records] == ["step 10", "step 13", "step 4", "step 7"]
    assert [each.force[0] for each in records] == [10.0, 13.0, 4.0, 7.0]


def test_labels_that_are_words(write):
    rows = "".join(
        f"{step};{t:.1f};2,5\n".replace(".", ",") for step in ("load", "hold") for t in TIME
    )
    records = st.read_records(write(f"phase;time [s];force [N]\n{rows}"))
    assert [each.origin.label for each in records] == ["phase load", "phase hold"]


def test_a_first_interval_unlike_the_others(write):
    time = np.concatenate([[0.0], 13.0 + 10.0 * np.arange(COUNT - 1)])
    record = st.read_record(write(f"time [ms],force [N]\n{lines(columns=(time, FORCE))}"))
    assert np.allclose(record.time, 1e-3 * time, rtol=1e-15)
    assert "the first interval is 13 ms, the others 10 ms" in notes(record)


@pytest.mark.parametrize(("interval", "told"), [(0.666666, False), (0.7, True)])
def test_a_stated_interval_is_rounded(write, interval, told):
    time = interval * np.arange(COUNT)
    text = lines(columns=(time, FORCE), digits=6)
    header = "Sampling interval: 0.667 ms\ntime [ms],force [N]\n"
    record = st.read_record(write(header + text))
    assert record.time[-1] == pytest.approx(1e-3 * time[-1], rel=1e-6)
    assert ("the file states an interval of 0.667 ms" in notes(record)) == told


@pytest.mark.parametrize(
    ("line", "interval"),
    [
        ("Sampling interval: 0.667 ms", 0.667e-3),
        ("Sample rate [Hz]: 1500", 1.0 / 1500.0),
        ("Abtastzeit = 0,5 ms", 0.5e-3),
        ("dt;0.002;s", 0.002),
    ],
)
def test_a_stated_interval_in_place_of_times(write, line, interval):
    record = st.read_record(write(f"{line}\nforce [N]\n{lines(columns=(FORCE,))}"))
    assert np.allclose(record.time, interval * np.arange(COUNT), rtol=1e-12)
    assert "times are the number of the sample times" in notes(record)


def test_no_times_and_no_interval_is_refused(write):
    path = write(f"force [N]\n{lines(columns=(FORCE,))}")
    with pytest.raises(st.ResultError, match=r"no column is the time.*or give interval"):
        st.read_record(path)
    assert st.read_record(path, interval="2 ms").time[1] == 2e-3


def test_a_time_column_that_holds_a_changing_sample_period(write):
    period = np.array([1.0, 1.2, 1.1, 0.9, 1.0, 1.3, 1.0, 1.0])
    record = st.read_record(write(f"time [ms],force [N]\n{lines(columns=(period, FORCE))}"))
    assert np.allclose(record.time, 1e-3 * (np.cumsum(period) - 1.0), rtol=1e-12)
    assert "holds the interval before each sample" in notes(record)


def test_a_column_that_may_be_a_clock_or_a_period_is_refused(write):
    values = np.repeat([1.0, 2.0], 100)
    path = write(f"time [ms],force [N]\n{lines(columns=(values, np.arange(200.0)))}")
    with pytest.raises(st.ResultError, match="say times='clock' or times='intervals'"):
        st.read_record(path)
    assert st.read_record(path, times="clock").duration < 3e-3
    assert st.read_record(path, times="intervals").duration == pytest.approx(0.299, rel=1e-12)


def test_time_repeated_for_each_channel(write):
    header = "time [s],force [N],time [s],drive position [mm]\n"
    same = st.read_record(write(header + lines(columns=(TIME, FORCE, TIME, 2.0 * TIME))))
    assert np.allclose(same.drive_position, 2e-3 * TIME, rtol=1e-15)
    shifted = (TIME, FORCE, TIME + 0.25, 2.0 * (TIME + 0.25))
    record = st.read_record(write(header + lines(columns=shifted)))
    inside = TIME >= 0.25
    assert np.allclose(record.drive_position[inside], 2e-3 * TIME[inside], rtol=1e-12)
    assert "is interpolated to the times of the force" in notes(record)
    assert "1 sample outside its times" in notes(record)


@pytest.mark.parametrize(
    "form",
    [
        "2026-03-01T23:59:{s:06.3f}+01:00",
        "2026-03-01 23:59:{s:06.3f}-0530",
        "2026-03-01T23:59:{s:06.3f}Z",
        "3/1/2026 11:59:{s:06.3f} PM",
        "01-Mar-2026 23:59:{s:06.3f}",
        "1 mars 2026 23:59:{s:06.3f}",
    ],
)
def test_dates_of_all_sorts_are_times(write, form):
    """Offsets from universal time, halves of the day and names of months were refused."""
    rows = [f"{form.format(s=50.0 + t)};{f:.3f}" for t, f in zip(TIME, FORCE, strict=True)]
    record = st.read_record(write("Time;Force [N]\n" + "\n".join(rows)))
    assert record.time == pytest.approx(TIME)
    assert record.origin.start.startswith(form[:4])


def test_noon_and_midnight_of_half_days(write):
    rows = [f"{hour}:00:00 {half},1.0" for hour, half in ((11, "AM"), (12, "PM"), (1, "PM"))]
    rows += [f"{hour}:00:00 {half},1.5" for hour, half in ((11, "PM"), (12, "AM"), (1, "AM"))]
    record = st.read_record(write("Time,Force [N]\n" + "\n".join(rows)))
    assert record.time / 3600.0 == pytest.approx([0, 1, 2, 12, 13, 14])


def test_what_an_instrument_writes_beyond_its_range_is_missing(write):
    """Each had to be taken out of the file by hand."""
    rows = lines().splitlines()
    for at, word in ((2, "OVERLOAD"), (4, "#DIV/0!"), (6, "OL")):
        rows[at] = f"{TIME[at]},{word}"
    record = st.read_record(write("Time [s],Force [N]\n" + "\n".join(rows)))
    assert len(record) == COUNT - 3
    assert "3 samples without a force left out, the first at line 4" in notes(record)


def test_a_unit_may_be_spelled_out(write):
    said = "Zeit\tPrüfkraft\nin s\tin kN\n" + lines("\t", ",")
    record = st.read_record(write(said), force=2)
    assert record.force == pytest.approx(1e3 * FORCE)
    record = st.read_record(write("Sekunden;Newton\n" + lines(";", ",")))
    assert (record.time, record.force) == (pytest.approx(TIME), pytest.approx(FORCE))
    with pytest.raises(st.ResultError):  # a moment
        st.read_record(write("Zeit\tKraft\ns\tin lbf\n" + lines("\t", ",")))


def in_groups(values):
    """Whole numbers as a spreadsheet writes them in German: 998, 1.009."""
    return [f"{round(value):,}".replace(",", ".") for value in values]


def test_points_that_group_thousands_are_no_decimal_signs(write):
    """1.009 mN stood among 998 mN, and the record was analysed, at exit status 0."""
    time, force = 0.93 + 0.01 * TIME, 990.0 + 10.0 * np.arange(COUNT)
    text = "Zeit [s];Kraft [mN]\n" + "".join(
        f"{t:.3f}".replace(".", ",") + f";{f}\n"
        for t, f in zip(time, in_groups(force), strict=True)
    )
    record = st.read_record(write(text))
    assert record.force == pytest.approx(1e-3 * force)
    english = text.replace(".", "'").replace(",", ".").replace("'", ",")
    assert st.read_record(write(english)).force == pytest.approx(1e-3 * force)


# three decimals in every cell are English where tabs separate
@pytest.mark.parametrize(("separator", "below"), [(";", 0), (";", 4), ("\t", 4)])
def test_points_that_may_group_thousands_are_asked_for(write, below, separator):
    """Whole numbers of both kinds: nothing in the file tells."""
    time, force = 1500.0 + 10.0 * np.arange(COUNT), 1000.0 - below + np.arange(COUNT)
    rows = zip(in_groups(time), in_groups(force), strict=True)
    path = write(f"Zeit [ms]{separator}Kraft [mN]\n" + "".join(
        f"{t}{separator}{f}\n" for t, f in rows
    ))  # fmt: skip
    with pytest.raises(st.ResultError, match="say decimal='point' or decimal='comma'"):
        st.read_record(path)
    record = st.read_record(path, decimal="comma")
    assert record.force == pytest.approx(1e-3 * force)
    assert record.time == pytest.approx(1e-3 * time)


def test_commas_between_columns_are_no_decimal_signs_after_groups(write):
    """`93.900,0` is a number in German, and two in English: the heading has two names."""
    rows = "".join(f"{t:.3f},{f}\n" for t, f in zip(93.9 + TIME, range(COUNT), strict=True))
    record = st.read_record(write("time [s],force [mN]\n" + rows))
    assert record.time == pytest.approx(93.9 + TIME)


def test_three_decimals_are_decimals_where_one_number_begins_with_zero(write):
    text = "t [s];F [N]\n" + lines(";", columns=(TIME, 1.0 + FORCE))
    assert st.read_record(write(text)).force == pytest.approx(1.0 + FORCE)


def test_a_bridge_has_a_scale_in_newtons_per_millivolt_per_volt(write):
    """2.4 kN was read for 2.4 N."""
    path = write("Time [s],Force [mV/V]\n" + lines(columns=(TIME, FORCE / 5.0), digits=6))
    for scale in ("2=5 N/(mV/V)", "2=5000 N/(V/V)"):
        assert st.read_record(path, force=scale).force == pytest.approx(FORCE)
    with pytest.raises(st.ResultError, match=r"force='2=\? N/\(mV/V\)'"):
        st.read_record(path)


def test_a_unit_that_contradicts_the_heading_is_told(write):
    """24 kN were read for 24 N, without a word."""
    path = write("Time [s],Force [mN]\n" + lines())
    assert "is read in N, as asked, not in what its heading says" in notes(
        st.read_record(path, force="N")
    )
    assert "heading" not in notes(st.read_record(path, force="-1 mN"))


def test_a_remedy_names_a_column_that_may_serve(write):
    """It was always the second one."""
    days = 46082.5 + TIME / 86400.0
    cases = {
        "Date,Force [N]\n" + lines(columns=(days, FORCE), digits=9): "time='1=d'",
        "Force [N],stamp\n" + lines(columns=(FORCE[::-1], TIME)): "time='2=?', with its unit",
        "Time [s],Ch1 [V],Ch2 [V]\n" + lines(columns=(TIME, FORCE[::-1], FORCE)): "2=? N/V",
        ",force\n" + lines(columns=(2.0 * TIME, FORCE[::-1])): "force='2=mN' makes it",
    }
    for text, remedy in cases.items():
        with pytest.raises(st.ResultError, match=re.escape(remedy)):
            st.read_record(write(text))


@pytest.mark.parametrize(
    ("text", "channel"),
    [
        ("time [s],Fx [V]\n" + lines(), "force"),
        ("time [s],Fx [mV/V]\n" + lines(), "force"),
        ("time [s],shear stress [MPa]\n" + lines(), "force"),
        ("stamp,Fx [N]\n" + lines(), "time"),
        ("time [s],mu\n" + lines(), "normal_load"),
    ],
)
def test_a_remedy_with_a_gap_is_not_run_as_it_stands(write, text, channel):
    """ "2=2.5 N/V", an example, was run: forces 5 times as large, without a word."""
    path = write(text)
    with pytest.raises(st.ResultError, match=r"in place of \?") as refused:
        st.read_record(path)
    remedy = re.search(rf"{channel}='([^']*)'", str(refused.value))[1]
    with pytest.raises((st.ResultError, st.DescriptionError)):
        st.read_record(path, **{channel: remedy})


@pytest.mark.parametrize(
    ("heading", "asked", "said"),
    [
        ("t,Fx [N]", {}, ("'1=s' makes it 3.5 s at 2 Hz", "ms at 2 kHz")),
        ("t [s],Fx", {}, ("'2=N' makes it 1 N to", "makes it 1 mN to")),
        ("t [s],Fx [N],w", {"load": "3"}, ("'3=N' makes it", "'3=kN'")),
    ],
)
def test_a_unit_that_is_not_stated_is_asked_for_by_what_it_means(write, heading, asked, said):
    path = write(f"{heading}\n" + lines(columns=(TIME, FORCE, FORCE)[: heading.count(",") + 1]))
    with pytest.raises(st.ResultError, match="states no unit") as refused:
        st.read_record(path, **asked)
    for each in said:
        assert each in str(refused.value)


def test_columns_that_may_be_a_channel_are_all_suggested(write):
    path = write("t [s],Fx [N],force [N]\n" + lines(columns=(TIME, FORCE, FORCE)))
    with pytest.raises(st.ResultError, match="force=2 or force=3"):
        st.read_record(path)


def test_times_of_day_past_midnight(write):
    clock = [f"23:59:5{s}.5" for s in range(6, 10)] + [f"00:00:0{s}.5" for s in range(4)]
    rows = "".join(f"{t},{f:.1f}\n" for t, f in zip(clock, FORCE, strict=True))
    record = st.read_record(write(f"time,force [N]\n{rows}"))
    assert np.allclose(record.time, np.arange(COUNT), atol=1e-9)
    assert record.origin.start == "23:59:56.5"


def test_time_that_goes_back_is_refused_by_line(write):
    text = "time [s],force [N]\n0,1\n1,2\n2,3\n3,4\n2.5,5\n4,6\n"
    with pytest.raises(st.ResultError, match=r"line 6: the time goes back from 3 s to 2\.5 s"):
        st.read_record(write(text))


# --- displacements --------------------------------------------------------------------------------


def test_a_displacement_that_wraps_is_made_continuous(write):
    time = 0.1 * np.arange(60)
    true = 7.0 * time
    columns = (time, 1.0 + time, true % 10.0)
    path = write(f"time [s],force [N],drive position [mm]\n{lines(columns=columns)}")
    record = st.read_record(path)
    assert np.allclose(record.drive_position, 1e-3 * true, atol=1e-12)
    assert "starts again 4 times, every 10 mm, and was made continuous" in notes(record)
    given = st.read_record(path, wrap="10 mm")
    assert np.allclose(given.drive_position, 1e-3 * true, atol=1e-12)
    left = st.read_record(path, wrap="none")
    assert np.allclose(left.drive_position, 1e-3 * (true % 10.0), atol=1e-12)


def test_a_stage_that_drives_back_and_forth_does_not_wrap(write):
    time = 0.1 * np.arange(60)
    triangle = np.abs((time % 2.0) - 1.0)
    columns = (time, 1.0 + time, triangle)
    record = st.read_record(write(f"time [s],force [N],stage [mm]\n{lines(columns=columns)}"))
    assert np.allclose(record.drive_position, 1e-3 * triangle, atol=1e-12)


# --- what is missing or wrong ---------------------------------------------------------------------


def test_fewer_values_than_the_header_promises(write):
    record = st.read_record(write(f"Samples: 12\ntime [s],force [N]\n{lines()}4.0,1.2e"))
    assert len(record) == COUNT
    assert "the file promises 12 samples and has 8: it is cut off" in notes(record)
    assert "line 11 skipped: '4.0,1.2e'" in notes(record)


def test_missing_values(write):
    text = "time [s],force [N],load [N]\n0,1,5\n1,,5\n2,3,\n3,NaN,7\n4,5,9\n"
    record = st.read_record(write(text))
    assert record.time.tolist() == [0.0, 2.0, 4.0]
    assert record.load.tolist() == [5.0, 6.0, 9.0]  # between 5 N at 1 s and 7 N at 3 s
    assert "2 samples without a force left out, the first at line 3" in notes(record)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("0,1\n1,2\n2,1.x\n3,4\n", "line 4, column 2: '1.x' is not a number"),
        ("0,1\n1,2\n0.0x3,3\n3,4\n", "line 4, column 1: '0.0x3' is not a number"),
        ("0,1\n1,2\n2,1_0\n3,4\n", "line 4, column 2: '1_0' is not a number"),
        (
            "0,1\n" * 1 + "".join(f"{i},2\n" for i in range(1, 20)) + "20,1,5\n21,2\n",
            "line 22, column 3",
        ),
        ('0,1\n1,"2\n2,3\n3,4\n', "line 3"),
    ],
)
def test_a_bad_cell_is_named_by_line_and_column(write, rows, said):
    with pytest.raises(st.ResultError) as error:
        st.read_record(write(f"time [s],force [N]\n{rows}"))
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is empty"),
        (b"\n\n \n", "has only empty lines"),
        (b"hello\nworld\n", "no line has samples; the first is 'hello'"),
        (b"time [s],force [N]\n", "no line has samples"),
        (b"time,force\n1,2\n\0\0\n", "line 3 holds a zero byte"),
        (b"\x1f\x8b\x08\x00junk", "gzip says"),
        (b"%PDF-1.4", "is a PDF"),
        (b"\xd0\xcf\x11\xe0", "Excel"),
        (b"PK\x03\x04" + bytes(60), "is a damaged zip archive, or a part of one; copy it again"),
    ],
)
def test_files_that_are_none(write, content, said):
    with pytest.raises(st.ResultError, match=said):
        st.read_record(write(content))


@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize(
    ("names", "said"),
    [
        (
            ["[Content_Types].xml", "_rels/.rels", "xl/workbook.xml"],
            "an Excel workbook; save it as",
        ),
        (["docProps/app.xml", "xl/worksheets/sheet1.xml"], "an Excel workbook; save it as CSV"),
        (["mimetype", "content.xml"], "an OpenDocument file, as of LibreOffice; save it as CSV"),
        (["Index/Document.iwa"], "an Apple Numbers file; export it as CSV"),
        (["[Content_Types].xml", "word/document.xml"], "a Word document"),
    ],
)
def test_a_spreadsheet_is_named_with_its_remedy_whole_or_damaged(tmp_path, names, said, cut):
    """It was "a zip archive without NumPy arrays; unpack it first"."""
    path = tmp_path / "test.xlsx"
    with zipfile.ZipFile(path, "w") as archive:
        for name in names:
            archive.writestr(name, "<x/>")
    if cut:
        path.write_bytes(path.read_bytes()[:-30])  # what an archive ends with
    with pytest.raises(st.ResultError, match=re.escape(f"is {said}")):
        st.read_record(path)


def test_a_zip_of_something_else_is_to_be_unpacked(tmp_path):
    path = tmp_path / "data.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("data.csv", "t,F")
    with pytest.raises(st.ResultError, match="zip archive without NumPy arrays; unpack it first"):
        st.read_record(path)


def test_a_header_that_looks_like_a_description_is_read(write):
    text = f"[drive]\nvelocity = 2\n\ntime [s],force [N]\n{lines()}"
    plain = st.read_record(write(f"time [s],force [N]\n{lines()}"))
    assert st.read_record(write(text)).force.tolist() == plain.force.tolist()


def test_a_missing_file_and_a_folder(tmp_path):
    with pytest.raises(st.ResultError, match="no such file"):
        st.read_record(tmp_path / "a.csv")
    with pytest.raises(st.ResultError, match="is a folder"):
        st.read_record(tmp_path)
    with pytest.raises(st.ResultError, match="holds no files"):
        st.read_records(tmp_path)


def test_a_file_too_large_for_memory_is_refused(write, monkeypatch):
    path = write(f"time [s],force [N]\n{lines()}")
    monkeypatch.setattr("stiction.machine.largest_object", lambda: 1000.0)
    with pytest.raises(st.ResultError, match="of memory, more than the limit of"):
        st.read_record(path)


def test_a_gzip_that_unpacks_to_more_than_memory_is_refused(write, monkeypatch):
    path = write(gzip.compress(b"time [s],force [N]\n" + b"0,1\n" * 1_000_000), "a.csv.gz")
    for place in ("stiction.machine", "stiction.formats.text.lines"):
        monkeypatch.setattr(f"{place}.largest_object", lambda: 1e6)
    with pytest.raises(st.ResultError, match="of memory, more than the limit of"):
        st.read_record(path)


# --- the file beside ------------------------------------------------------------------------------


def test_a_toml_file_beside_the_data_says_what_it_holds(write):
    path = write(f"t,CH1\n{lines()}")
    sidecar = write(
        '[columns]\ntime = "ms"\nforce = "CH1=2 N/V"\n'
        '[record]\nnormal_load = "10 N"\nmass = "30 g"\n'
        '[sensors.force]\ngain = 0.5\nzero = "100 mN"\nnoise = "2 mN"\n',
        "data.toml",
    )
    record = st.read_record(path)
    assert np.allclose(record.force, (2.0 * FORCE - 0.1) / 0.5, rtol=1e-14)
    assert (record.normal_load, record.mass) == (10.0, 0.03)
    assert record.sensors["force"] == st.Sensor(noise=0.004)
    assert st.read_record(path, normal_load="20 N").normal_load == 20.0  # arguments come first
    sidecar.rename(path.with_name("other.toml"))
    with pytest.raises(st.ResultError, match="no column is the force"):
        st.read_record(path)
    assert st.read_record(path, sidecar=path.with_name("other.toml")).mass == 0.03


def test_all_faults_of_the_file_beside_are_told(write):
    path = write(f"t,F\n{lines()}")
    write('[columns]\ntim = "ms"\n[rig]\nmass = 1\n[sensors]\nforce = 3\n', "data.toml")
    with pytest.raises(st.DescriptionError) as error:
        st.read_record(path)
    for said in (
        "columns.tim: unknown key 'tim'; did you mean 'time'?",
        "rig: unknown table",
        "[sens",
    ):
        assert said in str(error.value)


def test_the_description_of_a_rig_beside_the_data_is_left_alone(write):
    path = write(f"t [s],F [N]\n{lines()}")
    write(st.presets.nakano_popov_2020().to_toml(), "data.toml")
    assert len(st.read_record(path)) == COUNT


# --- all faults at once ---------------------------------------------------------------------------


def faults_of(path, **said):
    with pytest.raises(st.StictionError) as error:
        st.read_record(path, **said)
    return [line.removeprefix(f"{path}: ") for line in str(error.value).splitlines()]


def test_all_wrong_cells_of_a_file_are_listed(write):
    rows = [f"{x},{x}.5" for x in range(30)]
    rows[3], rows[7], rows[9] = "3,a", "7,7.5,8", "9,b"
    found = faults_of(write("\n".join(rows)))
    assert [x.split(":")[0] for x in found] == [
        "line 4, column 2",
        "line 10, column 2",
        "line 8, column 3",
    ]
    assert faults_of(write("\n".join(f"{x},a" if x % 2 else f"{x},{x}" for x in range(60))))[
        -1
    ] == ("and 9 more faults")


def test_all_wrong_columns_and_units_are_listed(write):
    path = write("time [s],Fx [N],Fy [N],pos [mm]\n" + lines(columns=(TIME, FORCE, FORCE, FORCE)))
    found = faults_of(path, force="Fq=mN", force_across="Fy=kg/s", position="poss", time="pos=K")
    assert [x.split(";")[0] for x in found] == [
        "no column is called 'Fq', for the force along the drive",
        "'poss' is neither a column nor a unit such as um of the displacement of the mass",
        "column 3 'Fy [N]' is in 'kg/s', not a unit of the force across the drive",
        "column 4 'pos [mm]' is in 'K', not a unit of time",
    ]


def test_all_wrong_arguments_and_keys_are_listed(write):
    path = write(f"time [s],force [N]\n{lines()}")
    beside = write('[record]\nmass = "3 N"\n[sensors.force]\nnoise = "2 s"\n', "data.toml")
    found = faults_of(path, interval="3 N", wrap="-1 mm", normal_load="10 kg", block=0)
    assert sorted(x.removeprefix(f"{beside}: ").split(": ")[0] for x in found) == [
        *("block", "interval", "normal_load", "record.mass", "sensors.force.noise", "wrap")
    ]


def test_all_times_that_go_back_are_listed(write):
    time = np.arange(20.0)
    time[[8, 14]] = 3.0
    found = faults_of(write("time [s],force [N]\n" + lines(columns=(time, time))))
    assert [x.split(":")[0] for x in found] == ["line 10", "line 16"]


def test_all_damaged_files_of_a_folder_are_listed(write):
    write("time [s],force [N]\n0,1\n1,2\n2,3\n", "a.csv")
    for name in ("b.csv", "c.csv"):
        path = write("time [s],force [N]\n0,1\n1,a\n2,3\n", name)
    with pytest.raises(st.ResultError) as error:
        st.read_records(path.parent)
    assert [line.split(": ")[0] for line in str(error.value).splitlines()] == [
        str(path.parent / name) for name in ("b.csv", "c.csv")
    ]


@pytest.mark.parametrize(
    "heading", ["Time (s),Force (mN)", "Time [s],Force [mN]", "Time/s,Force/mN"]
)
def test_a_column_by_its_heading_as_the_file_or_a_message_has_it(write, heading):
    """A heading copied from the file was "neither a column nor a unit"."""
    path = write(f"{heading}\n{lines()}")
    for time, force in (heading.split(","), ("Time [s]", "Force [mN]")):
        record = st.read_record(path, time=time, force=force)
        assert record.force == pytest.approx(1e-3 * FORCE)


def test_units_after_a_blank(write):
    record = st.read_record(write(f"Zeit s;Kraft mN\n{lines(';', ',')}"))
    assert record.force == pytest.approx(1e-3 * FORCE)
    with pytest.raises(st.ResultError, match="states no unit"):  # F N is the normal force
        st.read_record(write(f"Time [s],Force,F N\n{lines(columns=(TIME, FORCE, FORCE))}"))


@pytest.mark.parametrize("form", ["{m:02d}:{s:06.3f}", "{m:d}:{s:05.2f}", "00:{m:02d}:{s:06.3f}"])
def test_minutes_and_seconds_are_times(write, form):
    whole = 118.0 + TIME
    rows = [
        f"{form.format(m=int(t // 60.0), s=t % 60.0)},{f}"
        for t, f in zip(whole, FORCE, strict=True)
    ]
    record = st.read_record(write("time,Force [N]\n" + "\n".join(rows)))
    assert record.time == pytest.approx(TIME)


def test_exponents_of_fortran(write):
    rows = [f"{t:.4E},{f:.6E}".replace("E", "D") for t, f in zip(TIME, FORCE, strict=True)]
    record = st.read_record(write("t [s],F [N]\n" + "\n".join(rows)))
    assert record.force == pytest.approx(FORCE)


def test_a_table_of_results_above_the_samples(write):
    """Of 1 row, as testing machines write it: it hid the samples."""
    times = 0.01 * np.arange(200)
    table = '"Results"\n"","Maximum load [N]","Friction coefficient"\n"1","1.7","0.35"\n\n'
    samples = lines(columns=(times, times, 1.0 + 0.1 * np.sin(times)), digits=6)
    record = st.read_record(
        write(f'{table}"Time","Extension","Load"\n"(s)","(mm)","(N)"\n{samples}'), force="Load"
    )
    assert len(record) == 200
    assert "a table of 1 row left out, the first at line 3" in notes(record)


def test_what_is_stated_of_the_apparatus_is_echoed(write):
    record = st.read_record(write(f"t [s],F [N]\n{lines()}"), mass="250 g", stiffness="1 N/mm")
    assert "stated: stiffness 1 kN/m, mass 250 g" in notes(record)


@pytest.mark.parametrize("seed", range(40))
def test_units_may_stand_behind_each_number(write, seed):
    random = np.random.default_rng(seed)
    mark, sign = random.choice(["\t", ";", ",", "|"]), random.choice([".", ","])
    sign = "." if mark == "," else sign
    gap, quote = random.choice(["", " "]), random.choice(["", '"'])
    [second, t], [newton, f] = (
        {"s": ("s", 1.0), "ms": ("ms", 1e3)}[random.choice(["s", "ms"])],
        {"N": ("N", 1.0), "mN": ("mN", 1e3), "kN": ("kN", 1e-3)}[random.choice(["N", "mN", "kN"])],
    )
    time, force = 0.01 * np.arange(60), 1.0 + 0.001 * random.integers(0, 999, 60)
    rows = [
        mark.join(
            f"{quote}{value:.6g}{gap}{unit}{quote}".replace(".", sign)
            for value, unit in ((x * t, second), (y * f, newton))
        )
        for x, y in zip(time, force, strict=True)
    ]
    head = [f"time{mark}force"] * random.integers(0, 2)
    record = st.read_record(write("\n".join([*head, *rows])))
    assert record.time == pytest.approx(time, abs=1e-12)
    assert record.force == pytest.approx(force, rel=1e-5)


def test_a_column_with_two_units_is_refused(write):
    rows = "\n".join(f"{0.1 * x:.1f} s;{x} {'N' if x > 20 else 'mN'}" for x in range(40))
    with pytest.raises(st.ResultError, match="column 2 is in mN and in N; write it in one unit"):
        st.read_record(write(f"time;force\n{rows}"))


@pytest.mark.parametrize("third", ["45 %", "21.5 °C", "7 °/s", "3 1/min", "2 m/s^2", "run"])
def test_a_column_beside_those_with_units_may_hold_anything(write, third):
    """One such column lost the whole file: "no line has samples"."""
    rows = [f"{x / 100.0} s;{1.0 + x % 7 / 10.0} N;{third}" for x in range(40)]
    record = st.read_record(write("time;force;other\n" + "\n".join(rows)))
    assert record.time == pytest.approx(np.arange(40) / 100.0)
    assert record.force == pytest.approx(1.0 + np.arange(40) % 7 / 10.0)


def test_clocks_and_stresses_stand_beside_units(write):
    rows = [f"12:00:{x:02d};{1.0 + x % 7 / 10.0:.2f} kN/m^2" for x in range(40)]
    record = st.read_record(write("time;stress\n" + "\n".join(rows)), force="2=25 mm^2*kN/m^2")
    assert record.time == pytest.approx(np.arange(40.0))
    assert record.force == pytest.approx(0.025 * (1.0 + np.arange(40) % 7 / 10.0))


@pytest.mark.parametrize("word", ["OVERLOAD", "#DIV/0!", "nan", "--"])
@pytest.mark.parametrize("share", [0.1, 0.7])
def test_overloaded_lines_have_units_too(write, word, share):
    lost = np.arange(100) % 10 < 10 * share
    rows = [f"{x / 100.0} s;{word if lost[x] else f'{x / 10.0} N'}" for x in range(100)]
    record = st.read_record(write("time;force\n" + "\n".join(rows)))
    assert record.time == pytest.approx(np.flatnonzero(~lost) / 100.0)
    assert record.force == pytest.approx(np.flatnonzero(~lost) / 10.0)


@pytest.mark.parametrize(("many", "bare"), [(9, False), (10, False), (11, True)])
def test_units_are_behind_more_than_half_of_the_lines(many, bare):
    rows = [f"0.{x:02d};1.5{' N' if x < many else ''}" for x in range(20)]
    found = without_units(["time;force", *rows])
    assert found == ["time;force", *(x.removesuffix(" N") if bare else x for x in rows)]


@pytest.mark.parametrize(
    ("heading", "cell"),
    [("N", "mN"), ("mN", "N"), ("mN", "g"), ("N", "kg"), ("N", "mm"), ("V", "mV"), ("MPa", "kPa")],
)
def test_a_heading_in_another_unit_than_its_cells_is_refused(write, heading, cell):
    """The heading's was taken without a word: mN were read as N."""
    rows = "\n".join(f"{0.1 * x:.1f} s;{x} {cell}" for x in range(40))
    message = (
        rf"line 2, column 2: has {cell} behind its number, its heading is 'force \[{heading}\]'"
    )
    with pytest.raises(st.ResultError, match=message):
        st.read_record(write(f"time [s];force [{heading}]\n{rows}"), force="2=2 N/V")


@pytest.mark.parametrize("many", [1, 19, 20])
def test_a_unit_behind_few_numbers_of_a_column_is_refused(write, many):
    rows = "\n".join(f"{0.1 * x:.1f} s;{x}{' mN' if x < many else ''}" for x in range(40))
    path = write(f"time;force\n{rows}")
    if many == 20:
        assert st.read_record(path).force[39] == pytest.approx(0.039)
        return
    with pytest.raises(st.ResultError, match=r"line 2, column 2: has mN .* behind all or none"):
        st.read_record(path)


@pytest.mark.parametrize(("heading", "cell"), [("gf", "g"), ("µN", "uN"), ("Newton", "N")])
def test_a_unit_may_stand_in_the_heading_and_behind_the_numbers(write, heading, cell):
    rows = "\n".join(f"{0.1 * x:.1f} sec;{x} {cell};{x} °C" for x in range(40))
    record = st.read_record(write(f"time [s];force [{heading}];room [C]\n{rows}"))
    assert record.force[3] == pytest.approx(3.0 * size_of(cell, "N").value)


@pytest.mark.parametrize(("one", "other"), [("V", "mV"), ("kPa", "MPa"), ("N", "s")])
def test_a_column_of_any_kind_with_two_units_is_refused(write, one, other):
    rows = "\n".join(f"{0.1 * x:.1f} s;{x} {other if x == 9 else one}" for x in range(40))
    with pytest.raises(st.ResultError, match=f"column 2 is in {one} and in {other}; write it in"):
        st.read_record(write(f"time;force\n{rows}"), force="2=2 N/V")


def test_half_days_are_no_units(write):
    rows = "\n".join(f"12:{x:02d} PM;{x}.5" for x in range(40))
    assert st.read_record(write(f"time;force [N]\n{rows}")).time[2] == 120.0
