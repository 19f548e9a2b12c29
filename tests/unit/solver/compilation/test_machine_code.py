"""Machine code on disk: named after what it follows from, and never trusted blindly."""

import builtins
import logging
import os
import shutil
import sys
from pathlib import Path

import pytest
from tests.entry import entry

import stiction as st
from stiction.cli import main
from stiction.solver.compilation import jit, machine_code
from stiction.solver.compilation.machine_code import Shelf


def twice(x):
    """Return a number that is compiled quickly."""
    return 2.0 * x


def speed(drive):
    """Return what only a drive has."""
    return drive.velocity


def fresh():
    """Return `twice` as the first process, or a later one, would compile it."""
    return jit._entry(twice, Shelf(twice))


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    machine_code.folder.cache_clear()
    yield tmp_path
    machine_code.folder.cache_clear()


def hits(function):
    return sum(function.stats.cache_hits.values())


def test_a_later_process_loads_it(root):
    first, later = fresh(), fresh()
    assert first(1.5) == 3.0
    assert hits(first) == 0
    assert later(1.5) == 3.0
    assert hits(later) == 1
    assert later(2) == 4.0  # other arguments, other code
    assert hits(later) == 1
    assert len(list(root.glob("*/*.code"))) == 2
    assert Path(later.stats.cache_path).parent == root


@pytest.mark.parametrize("damage", ["cut", "flipped", "emptied"])
def test_damaged_code_is_discarded_and_compiled_anew(root, damage):
    fresh()(1.5)
    (path,) = root.glob("*/*.code")
    whole = path.read_bytes()
    middle = len(whole) // 2
    path.write_bytes(
        {
            "cut": whole[:middle],
            "flipped": whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :],
            "emptied": b"",
        }[damage]
    )
    later = fresh()
    assert later(1.5) == 3.0
    assert hits(later) == 0
    again = fresh()
    assert again(1.5) == 3.0
    assert hits(again) == 1


@pytest.mark.parametrize("mode", [0o777, 0o770])
def test_a_folder_that_others_may_write_to_is_not_used(root, mode):
    place = machine_code.folder()
    fresh()(1.5)
    place.chmod(mode)
    machine_code.folder.cache_clear()
    alone = machine_code.folder()
    assert alone != place
    assert alone.stat().st_mode & 0o777 == 0o700
    function = fresh()
    assert function(1.5) == 3.0
    assert hits(function) == 0


def test_a_folder_of_somebody_else_is_not_used(root, monkeypatch):
    place = machine_code.folder()
    machine_code.folder.cache_clear()
    monkeypatch.setattr(os, "getuid", lambda: place.stat().st_uid + 1)
    assert machine_code.folder() != place


def test_a_link_is_not_followed(root):
    place = machine_code.folder()
    elsewhere = root / "elsewhere"
    place.rename(elsewhere)
    place.symlink_to(elsewhere)
    machine_code.folder.cache_clear()
    assert machine_code.folder().parent != root


def test_without_room_nothing_is_kept_and_all_is_computed(root, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    assert fresh()(1.5) == 3.0
    assert not list(root.glob("*/*.code"))  # no half file either


@pytest.fixture
def law(tmp_path, monkeypatch):
    """Return the file of a law in a copy of the package's sources."""
    package, copy = Path(st.__file__).parent, tmp_path / "stiction"
    for room in machine_code.ROOMS:
        shutil.copytree(package / room, copy / room)
    moved = copy / "solver" / "compilation" / "machine_code.py"
    monkeypatch.setattr(machine_code, "__file__", str(moved))
    machine_code.fingerprint.cache_clear()
    yield copy / "friction" / "laws" / "coulomb.py"
    machine_code.fingerprint.cache_clear()


def test_the_folder_is_named_after_the_sources(law):
    """An edit in any compiled file must not meet machine code of the old one."""
    there = machine_code.fingerprint()
    machine_code.fingerprint.cache_clear()
    law.write_text(law.read_text() + "\n# edited\n")
    assert machine_code.fingerprint() != there


def test_the_folder_s_name_does_not_depend_on_where_the_package_lies(monkeypatch, request):
    before = machine_code.fingerprint()
    request.getfixturevalue("law")
    assert machine_code.fingerprint() == before


@pytest.mark.parametrize("when", ["before the first function", "before a later one"])
def test_what_ran_before_an_edit_is_not_kept_as_the_new_version(root, law, monkeypatch, when):
    """The functions in memory are the old ones, and the folder is named after the new files."""
    monkeypatch.setattr(machine_code, "IMPORTED", law.stat().st_ctime + 3600)
    if when == "before a later one":
        fresh()(1.5)
    kept = list(root.glob("*/*.code"))
    os.utime(law, (0, machine_code.IMPORTED + 1))
    assert fresh()(2) == 4.0
    assert list(root.glob("*/*.code")) == kept


def test_an_edit_whose_date_is_set_back_counts(root, law, monkeypatch):
    monkeypatch.setattr(machine_code, "IMPORTED", law.stat().st_ctime - 3600)
    for file in machine_code._sources():  # dated as those of a wheel may be
        os.utime(file, (0, 0))
    assert machine_code._stale()
    assert not machine_code.folder().is_relative_to(root)


def test_a_file_that_is_being_exchanged_counts_as_edited(root, law, monkeypatch):
    monkeypatch.setattr(machine_code, "_sources", lambda: [law.with_name("gone.py")])
    assert fresh()(1.5) == 3.0
    assert not list(root.glob("*/*.code"))


def test_an_edit_in_a_compiled_function_that_is_called_leads_to_new_code():
    """Code of `fill_features` holds that of `find_turns`, which lies in another file."""
    from stiction.analysis.motion.noiseless.features import fill_features
    from stiction.analysis.motion.noiseless.zigzag import find_turns

    function, shelf = jit.python_of(fill_features), find_turns._cache
    before, there = shelf._made_from, Shelf(function)._made_from
    shelf._made_from = "edited"
    try:
        assert Shelf(function)._made_from != there
    finally:
        shelf._made_from = before


def test_the_versions_used_last_stay(root):
    names = [f"compiled-{n}" for n in range(10)]
    for n, name in enumerate(names):
        (root / name).mkdir()
        (root / name / "old.code").touch()
        os.utime(root / name, (n, n))
    place = machine_code.folder()
    left = sorted(each.name for each in root.glob("compiled-*"))
    assert left == sorted([*names[-(machine_code.FOLDERS - 1) :], place.name])


def test_a_part_is_not_called_from_python():
    """Where numba would call code that is not there."""
    part = jit.inlined(twice)
    for _ in range(2):
        with pytest.raises(TypeError, match="twice is called by compiled code only"):
            part(1.5)
        assert entry(part)(1.5) == 3.0


def test_compiling_a_solver_is_said_once(root, caplog):
    drive = st.ConstantVelocity(1.0)
    with caplog.at_level(logging.INFO, logger="stiction"):
        fresh()(1.5)
        for _ in range(2):
            jit._entry(speed, Shelf(speed))(drive)
    said = [each.getMessage() for each in caplog.records]
    assert said == ["compiling the solver for constant velocity, once"]


def test_two_solvers_of_one_drive_are_told_apart(root, caplog, monkeypatch):
    """The line stood twice in one audit, word for word."""
    drive = st.ConstantVelocity(1.0)
    with caplog.at_level(logging.INFO, logger="stiction"):
        for room in ("exact", "multiscale", "smooth"):
            monkeypatch.setattr(speed, "__module__", f"stiction.solver.{room}.loop")
            jit._entry(speed, Shelf(speed))(drive)
    said = [each.getMessage() for each in caplog.records]
    assert len({*said}) == 3
    assert said[1] == "compiling the solver over many periods at once for constant velocity, once"


@pytest.mark.parametrize("place", ["terminal", "notebook", "script", "quiet"])
def test_who_waits_for_the_first_run_is_told_why(root, monkeypatch, caplog, capsys, place):
    """The first run took ten seconds without a word; a script nobody watches prints nothing."""
    caplog.set_level(logging.WARNING if place == "quiet" else logging.NOTSET, logger="stiction")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: place in ("terminal", "quiet"), raising=False)
    if place == "notebook":
        monkeypatch.setattr(builtins, "__IPYTHON__", True, raising=False)
    for _ in range(2):
        jit._entry(speed, Shelf(speed))(st.ConstantVelocity(1.0))
    said = "stiction: compiling the solver for constant velocity, once\n"
    assert capsys.readouterr().err == (said if place in ("terminal", "notebook") else "")


def test_the_command_line_says_it_on_standard_error(capsys):
    with pytest.raises(SystemExit):
        main(["--version"])
    logging.getLogger("stiction.solver").info("compiling [a law]")
    found = capsys.readouterr()
    assert found.err == "compiling [a law]\n"
    assert "compiling" not in found.out
