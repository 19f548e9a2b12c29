"""``stiction fit``, on a run that is taken as a record."""

import re
import shutil
from pathlib import Path

import pytest
import xarray as xr
from tests.uncertain import CYCLES, SIMULATIONS, TEXT, copy_blocks

import stiction as st
from stiction.analysis.motion.regime.classify import classify_record
from stiction.auditing import tolerance
from stiction.auditing.page import DRAWN
from stiction.auditing.words.verdict import RECORD
from stiction.cli import main
from stiction.cli.commands.inference.fit import origins
from stiction.errors import ResultError
from stiction.inference.next_test import further


def inside(*arguments):
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


def test_a_record_from_its_file_to_a_verdict(record_file, libraries, tmp_path, capsys, monkeypatch):
    """Text without units is refused, then fitted; an audit finds the fit's simulations again."""
    monkeypatch.setattr(
        tolerance, "DRAWS", 8
    )  # few tests of the rig, whose number is not the matter
    rig, data, folder = tmp_path / "rig.toml", record_file, tmp_path / "libraries"
    rig.write_text(TEXT)
    shutil.copytree(libraries, folder)
    blocks = sorted(folder.glob("*/*.npz"))
    for block in blocks[:: len(blocks) // 2]:
        block.unlink()  # made again by the fit
    library = ("-n", SIMULATIONS, "--library", folder)

    output, figures = tmp_path / "fit.nc", tmp_path / "figures"
    assert inside("fit", data, "--rig", rig, "-o", tmp_path / "fit.png") == 2
    assert "name it fit.nc" in capsys.readouterr().err  # what is written is NetCDF
    assert inside("design", rig, "-o", tmp_path / "design.nc") == 2  # before it simulates
    assert "use .png, .pdf, .svg" in capsys.readouterr().err
    command = ("fit", data, "--rig", rig, "-o", output, "--figures", figures, *library)
    assert inside(*command, "--mechanism") == 2  # nothing ambiguous passes silently
    assert "states no unit" in capsys.readouterr().err
    assert not output.exists()

    units = ("--time", "t=ms", "--force", "F=mN")
    assert inside(*command, *units, "--mechanism") == 0
    said = capsys.readouterr().out
    assert "mN" in said  # the guess of the file is shown
    assert len(re.findall(r"^ phi +\S+ deg +\S+ to ", said, re.M)) == 1
    assert len(re.findall(r"^ mu_inf ", said, re.M)) == 1
    parts = (
        "In short",
        "Fit",
        "Notes on the fit",
        "Mechanism",
        f"Warnings about {data}",
        "Read as",
    )
    found = [re.search(rf"^{re.escape(part)}$", said, re.M).start() for part in parts]
    assert found == sorted(found)  # the answer first, how the file was read last
    assert "Experimental" in said
    assert "Compared with" in said
    assert "called 1, 2" in said.lower()
    assert f"Warnings about {data}" in said
    assert "Sample at" in " ".join(said.split())  # slips of four samples
    names = {"posterior.png", "corner.png", "mechanism.png"}
    assert {path.name for path in figures.iterdir()} == names
    odds = xr.open_dataset(output, group="mechanism")
    assert float(odds["probability"].sum()) == pytest.approx(1.0)
    assert {"phi", "k_x", "k_y", "mu_0", "mu_inf", "jitter"} == set(xr.open_dataset(output))

    made = {path: path.stat().st_mtime_ns for path in folder.glob("*/*.npz")}
    assert [*sorted(made)] == blocks
    its = {title: drawn[:1] for title, drawn in DRAWN.items() if title == RECORD}
    monkeypatch.setattr("stiction.auditing.page.DRAWN", its)  # test_measured draws all of them
    page = tmp_path / "rig.html"
    assert inside("audit", rig, "--record", data, *units, *library, "-o", page) == 0
    assert {path: path.stat().st_mtime_ns for path in folder.glob("*/*.npz")} == made
    out = capsys.readouterr().out
    titles = ("What the record says", "Warnings about the record", "The rig as it is described")
    places = [out.index(title) for title in titles]
    assert places == sorted(places)
    assert "What would change it" in out
    assert "simulated with the fitted" in page.read_text()


@pytest.mark.parametrize(
    ("words", "remedy"),
    [
        ("audit my.toml", "--record"),
        ("design my.toml", "--record"),
        ("explore my.toml", "its file"),
    ],
)
def test_options_of_a_record_are_refused_where_there_is_none(
    words, remedy, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.toml").write_text(st.presets.nakano_popov_2020().to_toml())
    assert inside(*words.split(), "--time", "ms", "--normal-load", "1 N") == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "--time, --normal-load: there is no record to which this could apply" in said
    assert remedy in said


def test_of_several_records_each_is_named_where_the_report_says_how_it_was_read(record_file):
    record = st.read_record(record_file, time="t=ms", force="F=mN")
    (alone,) = origins([record_file], [record])
    assert alone.title == "Read as"
    named = origins([record_file, Path("b.csv")], [record, record])
    assert [part.title for part in named] == [f"{record_file}: read as", "b.csv: read as"]


def test_a_wrong_prior_is_one_message(tmp_path, capsys):
    rig = tmp_path / "rig.toml"
    rig.write_text(TEXT.replace('high = "5 deg"', 'high = "0.1 deg"'))
    assert inside("fit", tmp_path / "no.nc", "--rig", rig, "-o", tmp_path / "fit.nc") == 2
    assert "phi: low must be below high" in capsys.readouterr().err


def test_an_audit_of_a_record_without_priors_is_refused(tmp_path, capsys):
    rig, data = tmp_path / "rig.toml", tmp_path / "data.csv"
    rig.write_text(st.presets.nakano_popov_2020().to_toml())
    data.write_text("t,F\n" + "".join(f"{t},{t % 7}\n" for t in range(200)))
    command = ("audit", rig, "--record", data, "--time", "t=ms", "--force", "F=mN")
    assert inside(*command) == 2
    assert "nothing is uncertain" in capsys.readouterr().err


def test_odds_that_cannot_be_given_are_refused_before_the_fit(
    record_file, libraries, tmp_path, capsys, monkeypatch
):
    """They were refused after all simulations, and the fit was lost with them."""
    (tmp_path / "rig.toml").write_text(TEXT)
    units = ("--time", "t=ms", "--force", "F=mN")
    output, library = tmp_path / "fit.nc", ("--library", libraries)
    command = ("fit", record_file, *units, "--rig", tmp_path / "rig.toml", "-o", output, *library)
    with monkeypatch.context() as patch:
        patch.setattr("stiction.inference.fit.fit_observed", None)
        assert inside(*command, "--mechanism", "-n", 300) == 2
        said = " ".join(capsys.readouterr().err.split())
        assert "must be at least 100, is 75; write -n 400 or more" in said
        assert inside(*command, "--mechanism", "--set", "phi=0deg", "-n", 400) == 2
        assert "nothing rotates" in capsys.readouterr().err

    def refuse(*_, **__):
        raise ResultError("only by one")

    monkeypatch.setattr("stiction.inference.mechanism.comparison.odds_of_observed", refuse)
    seen = []

    def classify(record):
        seen.append(record)
        return classify_record(record)

    monkeypatch.setattr("stiction.inference.observation.classify_record", classify)
    assert inside(*command, "--mechanism", "-n", SIMULATIONS) == 0
    assert len(seen) == 1  # observed once, for what is refused, for the fit and for the odds
    assert "Not compared: only by one." in capsys.readouterr().out
    assert set(xr.open_dataset(output)) == {"phi", "k_x", "k_y", "mu_0", "mu_inf", "jitter"}


@pytest.mark.parametrize("command", ["audit", "design"])
def test_what_takes_one_record_says_which_command_takes_all_strokes(tmp_path, capsys, command):
    """Its remedy was a function of Python."""
    data, rig = tmp_path / "data.csv", tmp_path / "rig.toml"
    way = [*range(20), *range(20, 0, -1)]
    rows = (f"{number},{1 if number < 20 else -1},{place}" for number, place in enumerate(way))
    data.write_text("\n".join(["t (s),F (N),stage (mm)", *rows]))
    rig.write_text(TEXT)
    said = ("--record", data, "--drive-position", "stage", "--stroke", "all")
    assert inside(command, rig, *said) == 2
    wrong = " ".join(capsys.readouterr().err.split())
    assert "say --stroke 1 for one of them; `stiction fit --stroke all`" in wrong
    assert "st.read_records" not in wrong


def test_a_design_says_what_to_measure_next(designed, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(further, "CYCLES", CYCLES)
    copy_blocks(designed, tmp_path)
    rig = tmp_path / "rig.toml"
    rig.write_text(TEXT)
    options = ["--angles", "3 deg", "--velocities", "1 m/s", "--loads", "1 kN", "-n", 200]
    files = ["--library", tmp_path, "-o", tmp_path / "design.png"]
    assert inside("design", rig, *options, *files) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "What to measure next" in said
    assert "turned by 3 deg" in said
    assert (tmp_path / "design.png").stat().st_size > 10_000
    assert inside("design", rig, "--of", "mass", "--angles", "3 mm") == 2
    refused = capsys.readouterr().err
    assert "is not uncertain" in refused
    assert "angles.1: '3 mm' is in mm" in refused
