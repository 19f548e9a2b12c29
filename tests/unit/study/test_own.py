"""Measures of the user's own: kept like built-in ones, run only where they may be."""

import copy
import json
import os
import pickle
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import wraps
from pathlib import Path
from types import SimpleNamespace
from typing import Annotated

import numpy as np
import pytest
from tests.waiting import PATIENCE

import stiction as st
from stiction.cli import main
from stiction.own_code.source import missing_names
from stiction.study.execution.cores import Cores
from stiction.study.execution.engines import Threads
from stiction.study.execution.repair import restore
from stiction.study.store.store import ERROR
from stiction.study.variables import own
from stiction.study.variables.own import OwnMeasure, measures_of_results, own_measure

BASE = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="50 ms"))
PHI = {"phi": st.Grid("1 deg", "3 deg", 3)}
TEXT = '''
from pathlib import Path
from typing import Annotated

Path("ran").touch()


def stuck(run) -> Annotated[float, "ms"]:
    """Time at rest."""
    return 1e3 * float(run.sticks["stick_duration"].sum())


def never(run):
    return None
'''
FILE = """
[study]
measures = ["time_stuck", "mine.py:stuck"]
[axes.phi]
values = ["1 deg", "3 deg"]
"""
KEPT = []


def longest(run: st.Trajectory) -> Annotated[float, "s"]:
    """Duration of the longest stick.

    More is in the second paragraph.
    """
    return run.sticks["stick_duration"].max()


def highest(run):
    return run.samples["spring_x"].max()


def moody(run) -> float:
    if run.slider.phi > 0.03:
        raise RuntimeError("no such angle")
    return 1.0


def keep(run):
    KEPT.append(run)
    return 0.0


def by_helper(run):
    return moody(run)


def as_text(run):
    return "1.0"


def interrupt(run):
    raise KeyboardInterrupt


def share(run) -> Annotated[float, "1"]:
    return 0.5


def angle_in_wrong_unit(run) -> Annotated[float, "degg"]: ...
def of_two(run, other): ...
def period(run): ...
def phi(run): ...
def force_trace(run): ...
def song(run): ...


def twice(measure):
    @wraps(measure)
    def double(run):
        return 2.0 * measure(run)

    return double


@twice
@np.errstate(divide="ignore")
def stick_density(run) -> Annotated[float, "mN"]:
    """Decorated number."""
    return run.statistics.stick_count / run.slider.mass


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(TEXT)
    (tmp_path / "study.toml").write_text(FILE + BASE.to_toml())
    yield tmp_path
    forget()


def forget():
    for name in [each for each in sys.modules if each.startswith("stiction_law_mine")]:
        del sys.modules[name]
    own._GIVEN.clear()


def command(*words):
    with pytest.raises(SystemExit) as left:
        main([*words])
    return left.value.code


def of(*measures, axes=PHI):
    return st.Study(base=BASE, axes=axes, measures=measures)


def test_it_is_what_the_function_returns_for_the_run(tmp_path):
    study = of(longest, highest, "peak_force")
    st.sweep(study, tmp_path / "a.zarr", engine=Threads(1))
    with st.open_study(tmp_path / "a.zarr") as data:
        for place, angle in enumerate(data["phi"].values):
            run = st.run(study.description({"phi": f"{angle} deg"}))
            np.testing.assert_allclose(data["longest"][place], longest(run), rtol=1e-12)
        # a built-in peak lies between samples; 32 in a period miss it by 0.5 % of an oscillation
        np.testing.assert_allclose(data["highest"], data["peak_force"], rtol=5e-3)
        assert data["longest"].attrs == {"units": "s", "long_name": "Duration of the longest stick"}
        assert data["highest"].attrs == {"long_name": "highest"}


def test_it_may_be_decorated(tmp_path):
    st.sweep(of(stick_density), tmp_path / "a.zarr", engine=Threads(1))
    with st.open_study(tmp_path / "a.zarr") as data:
        assert data["stick_density"].attrs == {"units": "mN", "long_name": "Decorated number"}
        run = st.run(of(stick_density).description((1,)))
        assert data["stick_density"].values[1] == 2.0 * run.statistics.stick_count / run.slider.mass


def test_a_file_names_it_by_file_and_function(folder):
    assert command("sweep", "study.toml", "-o", "a.zarr", "--quiet") == 0
    with st.open_study("a.zarr") as data:
        np.testing.assert_allclose(data["stuck"], 1e3 * data["time_stuck"], rtol=1e-12)
        assert data["stuck"].attrs["units"] == "ms"
    assert command("map", "a.zarr", "--of", "stuck") == 0
    assert Path("a.png").exists()


def test_what_it_raises_leaves_the_other_measures(tmp_path):
    done = st.sweep(of("time_stuck", moody, highest), tmp_path / "a.zarr", engine=Threads(1))
    assert done.failed == {"error": 2}
    with st.open_study(tmp_path / "a.zarr") as data:
        assert data["status"].values.tolist() == [0, ERROR, ERROR]
        assert np.isfinite(data["time_stuck"]).all()
        assert np.isfinite(data["highest"]).all()
        np.testing.assert_array_equal(data["moody"], [1.0, np.nan, np.nan])
        line = moody.__code__.co_firstlineno + 2
        assert data["message"].values[1] == (
            f"moody: test_own.py, line {line}: RuntimeError: no such angle"
        )


def test_all_that_raise_are_told_with_the_last_line_of_their_file(tmp_path):
    st.sweep(of(moody, by_helper, as_text), tmp_path / "a.zarr", engine=Threads(1))
    with st.open_study(tmp_path / "a.zarr") as data:
        line = moody.__code__.co_firstlineno + 2
        assert data["message"].values[1].split("; ")[:3] == [
            f"moody: test_own.py, line {line}: RuntimeError: no such angle",
            f"by_helper: test_own.py, line {line}: RuntimeError: no such angle",
            "as_text returned '1.0'",
        ]


def test_a_run_with_too_few_samples_has_no_such_number():
    assert np.isnan(own_measure(moody).value(SimpleNamespace(resolved=False)))


def test_an_interrupt_passes_through():
    with pytest.raises(KeyboardInterrupt):
        own_measure(interrupt).value(SimpleNamespace(resolved=True, trajectory=None))


def test_a_share_has_the_unit_1():
    assert own_measure(share).unit == "1"


def test_two_of_one_name_are_refused():
    with pytest.raises(st.DescriptionError, match="2 measures are called share"):
        of(share, OwnMeasure("other.py:share", "", share))


def test_the_name_of_a_dimension_is_refused():
    axes = {"phi": st.Values(["1 deg", "2 deg"], along="share")}
    with pytest.raises(st.DescriptionError, match="share is the name of an axis, too"):
        of(share, axes=axes)


def test_a_text_in_a_study_s_file_is_not_run_without_trust(folder):
    table = f"{{function = 'mine.py:stuck', source = {json.dumps(TEXT)}}}"
    text = FILE.replace('"mine.py:stuck"', table)
    (folder / "study.toml").write_text(text + BASE.to_toml())
    study = st.Study.from_toml("study.toml")
    with pytest.raises(st.DescriptionError, match="not run without permission"):
        st.sweep(study, "a.zarr")
    assert not (folder / "ran").exists()
    st.Study.from_toml("study.toml", trust=True)
    assert (folder / "ran").exists()


def test_a_measure_must_return_one_number(folder):
    text = FILE.replace('stuck"]', 'never"]') + BASE.to_toml()
    (folder / "study.toml").write_text(text)
    done = st.sweep(st.Study.from_toml("study.toml"), "a.zarr", engine=Threads(1))
    assert "never returned None; it must be one number" in done.first.message


def test_a_run_that_it_keeps_stays_as_it_was(tmp_path):
    """Memory of samples is used again for the next run."""
    KEPT.clear()
    st.sweep(of(keep), tmp_path / "a.zarr", engine=Threads(1))
    found = [run.samples["spring_x"].max() for run in KEPT]
    fresh = [
        st.simulate(run.slider, times=run.samples["time"]).samples["spring_x"].max() for run in KEPT
    ]
    np.testing.assert_allclose(found, fresh, rtol=1e-4)  # inside steps: the steps' tolerance
    assert len({*found}) == 3


def test_another_process_reads_its_numbers_and_runs_nothing(folder):
    study = st.Study.from_toml("study.toml")
    st.sweep(study, "a.zarr", engine=Threads(1))
    (folder / "ran").unlink()
    (folder / "elsewhere").mkdir()
    again = """
import stiction as st
from pathlib import Path

print(st.map('../a.zarr', 'stuck').data['stuck'].size)
data = st.open_study('../a.zarr')
for trust in (False, True):
    try:
        study = st.Study.from_json(data.attrs['description'], trust=trust)
        print(st.sweep(study, 'b.zarr').failed)
    except st.DescriptionError as error:
        print(error)
        print(*Path.cwd().iterdir())
"""
    size, *refused, files, done = python(again, folder / "elsewhere").split("\n")
    assert (size, files, done) == ("2", "", "{}")  # nothing was run before, nor was a store made
    assert "study.measures: 'mine.py:stuck' is a user's measure" in "".join(refused)
    assert "trust=True" in "".join(refused)
    assert (folder / "elsewhere" / "ran").exists()


def study_of_others(folder):
    """Return a study of a store as another process reads it: its measure is not run."""
    text = st.Study.from_toml("study.toml").to_json()
    (folder / "ran").unlink()
    forget()
    return st.Study.from_json(text)


def test_no_copy_of_a_study_runs_what_it_may_not(folder):
    study = study_of_others(folder)
    again = [pickle.loads(pickle.dumps(study)), copy.deepcopy(study), study.replace(seed=1)]
    assert not (folder / "ran").exists()
    for each in again:
        assert each.measures == study.measures
        with pytest.raises(st.DescriptionError, match="not run without permission"):
            st.sweep(each, "a.zarr")


def test_what_a_trusted_text_lacks_is_told(folder):
    text = study_of_others(folder).to_json().replace("mine.py:stuck", "mine.py:stick")
    with pytest.raises(st.DescriptionError, match="unknown function 'stick'"):
        st.Study.from_json(text, trust=True)


def test_a_stored_measure_has_a_text(folder):
    tables = study_of_others(folder).to_dict()
    tables["study"]["measures"][1]["source"] = None
    with pytest.raises(st.DescriptionError, match="neither a measure's name nor a function"):
        st.Study.from_json(json.dumps(tables))


def test_threads_that_read_it_at_once_get_the_whole_file(folder):
    """Else one would find the module that another one has begun to run."""
    text = f"import time\ntime.sleep(0.2)\n{TEXT}"
    find = measures_of_results(trust=True)

    def read(number):
        time.sleep(0.05 * number)
        return find("mine.py:stuck", text).function

    with ThreadPoolExecutor(3) as pool:
        found = [*pool.map(read, range(3))]
    assert callable(found[0])
    assert found == [found[0]] * 3


def test_damage_is_computed_again_with_trust(folder):
    st.sweep(st.Study.from_toml("study.toml"), "a.zarr", engine=Threads(1))
    before = st.open_study("a.zarr").load()
    chunk = next((folder / "a.zarr" / "stuck" / "c").glob("*"))
    chunk.write_bytes(bytes(len(chunk.read_bytes())))
    forget()
    with pytest.raises(st.DescriptionError, match="not run without permission"):
        restore(folder / "a.zarr")
    assert restore(folder / "a.zarr", trust=True)
    assert before.equals(st.open_study("a.zarr").load())


def test_a_changed_function_is_another_study(folder):
    st.sweep(st.Study.from_toml("study.toml"), "a.zarr", engine=Threads(1))
    (folder / "mine.py").write_text(TEXT.replace("1e3", "1e6"))
    with pytest.raises(st.ResultError, match=r"holds another study: study\.measures\.2\.source"):
        st.sweep(st.Study.from_toml("study.toml"), "a.zarr")


def test_it_is_not_run_beside_a_fault(folder):
    text = (folder / "study.toml").read_text()
    (folder / "study.toml").write_text(text.replace('mass = "', 'mass = "-'))
    with pytest.raises(st.DescriptionError, match=r"slider\.mass"):
        st.Study.from_toml("study.toml")
    assert not (folder / "ran").exists()


def test_its_file_lies_in_the_folder_of_the_study_or_is_trusted(folder):
    (folder / "inner").mkdir()
    (folder / "study.toml").rename(folder / "inner" / "study.toml")
    text = (folder / "inner" / "study.toml").read_text().replace("mine.py", "../mine.py")
    (folder / "inner" / "study.toml").write_text(text)
    with pytest.raises(st.DescriptionError, match="lies outside the folder"):
        st.Study.from_toml("inner/study.toml")
    assert not (folder / "ran").exists()
    assert str(st.Study.from_toml("inner/study.toml", trust=True).measures[1]) == "stuck"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mine.py:stick", "unknown function 'stick'"),
        ("mine.py:Path", "unknown function 'Path'"),
        ("mine.py:", "must name a file and a function"),
        ("nobody.py:stuck", "no file 'nobody.py'"),
        ("broken.py:stuck", "SyntaxError"),
        ("raising.py:stuck", "ZeroDivisionError"),
    ],
)
def test_a_file_s_faults_are_told(folder, name, said):
    (folder / "broken.py").write_text("def stuck(run:\n")
    (folder / "raising.py").write_text("1/0\n")
    text = (folder / "study.toml").read_text().replace("mine.py:stuck", name)
    (folder / "study.toml").write_text(text)
    with pytest.raises(st.DescriptionError) as caught:
        st.Study.from_toml("study.toml")
    (fault,) = caught.value.faults
    assert fault.path == "study.measures"
    assert said in fault.message


def local_function():
    def inner(run): ...

    return inner


@pytest.mark.parametrize(
    ("measure", "said"),
    [
        (lambda run: 1.0, "has no name that a store could keep"),
        (local_function(), "has no name that a store could keep"),
        (len, "neither a measure's name nor a function"),
        (None, "neither a measure's name nor a function"),
        (of_two, "must take one argument"),
        (angle_in_wrong_unit, "the unit of angle_in_wrong_unit: 'degg' is not a known unit"),
        (period, "period has a meaning in every store"),
        (force_trace, "force_trace has a meaning in every store"),
        (song, "song has a meaning in every store"),
        (phi, "phi is the name of an axis, too"),
    ],
)
def test_what_is_no_measure_is_refused(measure, said):
    with pytest.raises(st.DescriptionError) as caught:
        of(measure)
    assert caught.value.faults[0].path == "Study.measures"
    assert said in str(caught.value)


def test_all_faults_are_told_at_once():
    with pytest.raises(st.DescriptionError) as caught:
        of("nothing", of_two, axes={"phi": st.Grid("1 deg", "3 deg", 3), "colour": st.Values([1])})
    assert "unknown measure 'nothing'" in str(caught.value)
    assert "must take one argument" in str(caught.value)


def test_a_study_in_another_process_has_it(tmp_path):
    study = of(longest)
    (tmp_path / "study").write_bytes(pickle.dumps(study))
    code = (
        "import pickle, pathlib, stiction as st\n"
        "study = pickle.loads(pathlib.Path('study').read_bytes())\n"
        "print(st.sweep(study, 'there.zarr').failed)"
    )
    assert python(code, tmp_path) == "{}"
    st.sweep(study, tmp_path / "here.zarr", engine=Cores(1))
    with (
        st.open_study(tmp_path / "here.zarr") as here,
        st.open_study(tmp_path / "there.zarr") as there,
    ):
        np.testing.assert_array_equal(here["longest"], there["longest"])


NOTEBOOK = """
import linecache
import stiction as st

factor = 2.0
base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="20 ms"))
for number, cell in enumerate({cells}):
    name = f"cell-{{number}}"
    linecache.cache[name] = (len(cell), None, cell.splitlines(True), name)
    exec(compile(cell, name, "exec"))
    try:
        study = st.Study(base=base, axes={{"phi": st.Values(["1 deg"])}}, measures=[sticks])
        done = st.sweep(study, f"{{number}}.zarr")
        print(float(st.open_study(f"{{number}}.zarr")["sticks"][0]))
    except st.DescriptionError as error:
        print(error)
"""


def test_a_cell_of_a_notebook_defines_it(tmp_path):
    whole = "def count(run): return run.statistics.stick_count\ndef sticks(run): return count(run)"
    part = "def sticks(run): return factor * run.statistics.stick_count"
    found, said = python(NOTEBOOK.format(cells=[whole, part]), tmp_path).split("\n", 1)
    assert float(found) > 0
    assert "sticks uses factor of another cell" in said


def test_names_that_a_text_lacks():
    text = """
import numpy as np
from math import pi as circle
def f(x, *rest, key=1, **more):
    try:
        total = sum(y for y in rest)
    except ValueError as error:
        print(error)
    with open(x) as file, other() as (a, b):
        pass
    for i, (j, k) in enumerate(more):
        del j
    match x:
        case [first, 1, *remaining] | {"k": first, **remaining} if (n := first):
            remaining
        case [_, *further]:
            further
    return [np.mean(z) + circle + a + b + i + k + n + total for z in rest], key, file, lost, g
def g(): return __file__, lambda q: q
"""
    assert missing_names(text) == ["lost", "other"]
    assert not missing_names(f"from math import *\n{text}")


def python(code: str, folder: Path) -> str:
    """Return what a program prints."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])},  # with the tests
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert not done.returncode, done.stderr
    return done.stdout.strip()


def test_the_store_s_description_holds_its_text(folder):
    st.sweep(st.Study.from_toml("study.toml"), "a.zarr", engine=Threads(1))
    with st.open_study("a.zarr") as data:
        kept = json.loads(data.attrs["description"])["study"]["measures"]
    text = {"function": "mine.py:stuck", "source": TEXT, "reads": {}}
    assert kept == ["time_stuck", text]


def write_over(run):
    run.samples["spring_x"][:] = 0.0
    return 0.0


def test_a_measure_does_not_change_what_others_see(tmp_path):
    done = st.sweep(of(write_over, highest), tmp_path / "a.zarr", engine=Threads(1))
    assert "ValueError" in done.first.message
    with st.open_study(tmp_path / "a.zarr") as data:
        assert (data["highest"] > 0.0).all()


def test_a_store_cannot_name_any_function_that_is_loaded(tmp_path):
    """Also one of the standard library takes one argument, and its text is known."""
    import code

    text = Path(code.__file__).read_text("utf-8")
    raw = of("time_stuck").to_dict()
    raw["study"]["measures"].append({"function": "code.py:interact", "source": text})
    study = st.Study.from_json(json.dumps(raw))
    assert study.measures[1].function is None
    with pytest.raises(st.DescriptionError, match="not run without permission"):
        st.sweep(study, tmp_path / "a.zarr")


def test_a_function_that_a_study_was_given_is_known_in_this_process():
    study = of(longest)
    assert st.Study.from_json(study.to_json()).measures[0].function is longest
