"""The package as a whole: light imports, public names, compiled cache, examples."""

import ast
import os
import re
import runpy
import shutil
import subprocess
import sys
from inspect import isfunction, ismodule
from pathlib import Path
from pkgutil import resolve_name

import pytest
from tests.waiting import PATIENCE

import stiction as st
from stiction.analysis.motion.regime import kinds

ROOT = Path(__file__).parents[2]
SHORT = '\n[run]\nduration = "0.1 s"\n'
HEAVY = {"numba", "scipy", "xarray", "matplotlib", "pint", "pandas"}


def run_python(code: str, **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning:stiction", "-c", code],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        env=os.environ | environment,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("module", ["stiction", "stiction.cli"])
def test_imports_stay_light(module):
    loaded = run_python(f"import {module}, sys; print(*sys.modules)").split()
    assert HEAVY.isdisjoint(loaded)


@pytest.mark.parametrize("command", [["run", "-o", "my.nc"], ["audit"]], ids=lambda c: c[0])
def test_commands_that_print_numbers_load_no_library_of_labelled_arrays(command, tmp_path):
    """xarray, and the libraries that it looks for, take longer to import than a run to simulate."""
    name, *options = command
    (tmp_path / "my.toml").write_text(st.presets.nakano_popov_2020().to_toml() + SHORT)
    code = f"""
import os, sys
from stiction.cli import main
os.chdir({str(tmp_path)!r})
try:
    main({[name, "my.toml", *options]})
except SystemExit as ended:
    print("status", ended.code)
print(*sys.modules)
"""
    printed = run_python(code).split()
    assert printed[printed.index("status") + 1] == "0"
    assert {"xarray", "matplotlib", "pint", "pandas", "dask"}.isdisjoint(printed)


def test_the_analysis_of_a_record_loads_neither_solver_nor_filters():
    """It simulates nothing; each takes longer to import than such a record to analyse."""
    code = """
import sys
import numpy as np, stiction as st
time = np.arange(2000) * 1e-2
known = {"normal_load": 5.0, "mass": 0.1, "stiffness": 2.0, "drive_velocity": 0.5}
found = st.analyse(st.Record(time=time, force=1.0 + time % 0.5, **known))
print(found.cycles["peak_slip_speed"].notnull().all().item(), *sys.modules)
"""
    measured, *loaded = run_python(code).split()
    assert measured == "True"
    left_out = {"numba", "llvmlite", "stiction.solver.exact", "scipy.signal", "scipy.stats"}
    assert left_out.isdisjoint(loaded)


def test_a_command_does_not_search_for_garbage_while_it_loads_nor_when_it_ends():
    """Python would search all modules several times, for a fifth of the time of a short command."""
    code = """
import atexit, gc, sys
import stiction.__main__ as process
sys.argv = ["stiction", "--version"]
gc.collect()
before = sum(each["collections"] for each in gc.get_stats())
try:
    process.main()
finally:
    print(sum(each["collections"] for each in gc.get_stats()) - before)
    atexit._run_exitfuncs()
    print(len(gc.get_objects()) < 100 < gc.get_freeze_count())
"""
    assert run_python(code).split()[-2:] == ["0", "True"]


@pytest.mark.parametrize(("given", "taken"), [({}, "1"), ({"OPENBLAS_NUM_THREADS": "2"}, "2")])
def test_a_command_starts_no_threads_for_large_matrices_unless_told(given, taken, monkeypatch):
    """They wait busily when they start, for a tenth of the processor time of an audit."""
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    code = """
import os, sys
import stiction.__main__ as process
assert "numpy" not in sys.modules  # which reads how many
sys.argv = ["stiction", "--version"]
try:
    process.main()
finally:
    print(os.environ["OPENBLAS_NUM_THREADS"])
"""
    assert run_python(code, **given).split()[-1] == taken


def test_processes_of_tests_leave_bytecode_to_each_other():
    """Otherwise each of them spends seconds on compiling what it imports."""
    run_python("import stiction.errors")
    place = run_python("import stiction.errors; print(stiction.errors.__cached__)").strip()
    assert Path(place).exists()


def test_public_names():
    for name in st.__all__:
        assert getattr(st, name) is not None
        assert name in dir(st)
    assert callable(st.simulate)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        st.nonsense  # noqa: B018


def test_the_class_of_what_a_verb_returns_is_public():
    """For annotations: ``st.results.Odds`` and four others were missing."""
    verbs = [each for name in st.__all__ if isfunction(each := getattr(st, name))]
    words = {word for verb in verbs for word in re.findall(r"\w+", verb.__annotations__["return"])}
    ours = {word for word in words if word[0].isupper()} - {"Any", "Dataset", "None", "Path"}
    assert {"Odds", "Trajectory"} <= ours <= {*dir(st), *dir(st.results)}


GLOSSARY = (ROOT / "docs/glossary.md").read_text("utf-8")
IN_CODE = set(re.findall(r"\w+", " ".join(re.findall("`([^`]*)`", GLOSSARY))))


def test_the_glossary_explains_every_public_class_part_of_an_analysis_and_kind_of_motion():
    rooms = (st, st.analysis, st.laws, st.linear_stability, st.protocols, st.results)
    public = {each: getattr(room, each) for room in rooms for each in dir(room)}
    classes = {each for each, value in public.items() if isinstance(value, type)}
    lacking = sorted((classes | {*st.analysis.__all__}) - IN_CODE)
    assert not lacking, f"docs/glossary.md lacks {', '.join(lacking)}"
    names = {value for name, value in vars(kinds).items() if name.isupper() and type(value) is str}
    lacking = sorted(each for each in names if f"\n| {each} |" not in GLOSSARY)
    assert not lacking, f"docs/glossary.md lacks rows of {', '.join(lacking)}"


def test_names_in_the_glossary_are_names_in_the_code():
    texts = (path.read_text("utf-8") for path in (ROOT / "src").rglob("*.py"))
    assert sorted(IN_CODE.difference(*(re.findall(r"\w+", text) for text in texts))) == []


def members():
    """Return the names that each module and each class of the package defines."""
    found = {"st": {*dir(st)}}
    for path in (ROOT / "src").rglob("*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        for owner in (tree, *(each for each in tree.body if isinstance(each, ast.ClassDef))):
            own = found.setdefault(getattr(owner, "name", path.stem), set())
            own.update(each.name for each in owner.body if hasattr(each, "name"))
            fields = (each.target for each in owner.body if isinstance(each, ast.AnnAssign))
            own.update(ast.unparse(each) for each in fields)
    return found


def test_members_in_the_glossary_are_there():
    """`Workspace.share` had been moved into a function."""
    known = members()
    named = re.findall(r"`(\w+)\.(\w+)`", GLOSSARY)
    assert len(named) > 15
    wrong = [f"{owner}.{name}" for owner, name in named if name not in known.get(owner, ())]
    assert wrong == []


def test_names_survive_their_modules():
    """A submodule's name must not hide a public function of the same name."""
    code = "import stiction as st; st.simulate; st.simulate; import stiction.trajectory; st.load"
    assert run_python(f"{code}; print(callable(st.simulate), callable(st.load))") == "True True\n"


def callees(function: ast.FunctionDef) -> set[str]:
    """Return the names of what a function calls; an assertion is like one of NumPy's."""
    nodes = list(ast.walk(function))
    calls = [n.func for n in nodes if type(n) is ast.Call]
    own = {"assert_" for n in nodes if type(n) is ast.Assert}
    return own | {getattr(each, "id", getattr(each, "attr", "")) for each in calls}


def test_every_test_asserts_something():
    """Or calls one of its own helpers that does; a test that only runs code holds nothing."""
    trees = [ast.parse(path.read_text("utf-8")) for path in (ROOT / "tests").rglob("*.py")]
    functions = [n for tree in trees for n in ast.walk(tree) if type(n) is ast.FunctionDef]
    found = [(each.name, callees(each)) for each in functions]
    helpers = {"raises", "warns", "check_law"}
    helpers |= {name for _, names in found for name in names if name.startswith("assert_")}
    for _ in range(3):  # helpers of helpers
        helpers |= {name for name, names in found if names & helpers}
    silent = {name for name, _ in found if name.startswith("test_")} - helpers
    assert not silent, silent


def test_readme_example_runs(tmp_path, monkeypatch, capsys):
    """The README's Python block is what a reader will type."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    code = text.split("```python\n")[1].split("```")[0]
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "README.md", "exec"), {})
    assert (tmp_path / "run.nc").exists()
    peak, sticks = map(float, capsys.readouterr().out.split())
    assert f": {peak:.4f} N\n" in code
    assert f": {sticks:.0f} in 5 s\n" in code


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda p: p.stem)
def test_examples_run(path, tmp_path, monkeypatch):
    """As scripts, in this process: all they import is here."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(path.parent)
    assert runpy.run_path(str(path), run_name="__main__")["__name__"] == "__main__"
    sys.modules.pop("mylaw", None)  # lies beside one of them


LAW = """
from typing import NamedTuple
import stiction as st

class Mine(NamedTuple):
    mu: float
    def coefficient(law, v):
        return law.mu * {factor}
    def slope(law, v):
        return 0.0
"""

USE = """
import stiction as st, mylaw
slider = st.presets.nakano_popov_2020().replace(friction=mylaw.Mine(0.2))
print(st.simulate(slider, 0.1).stick_intervals[0, 1])
"""


USE_FILE = """
import re
import stiction as st
text = st.Description.of(st.presets.nakano_popov_2020(), 0.1).to_toml()
mine = '[friction]\\nlaw = "{law}:Mine"\\nmu = 0.2\\n'
text = re.sub(r"\\[friction\\][^[]*", lambda _: mine, text)
print(st.run(st.Description.from_toml(text, trust=True)).stick_intervals[0, 1])
"""


def test_a_user_s_law_is_compiled_cached_and_seen_when_edited(tmp_path, code_cache):
    cache = {"NUMBA_CACHE_DIR": str(code_cache), "PYTHONPATH": str(tmp_path)}
    law = tmp_path / "mylaw.py"
    law.write_text(LAW.format(factor="1.0"))
    one = float(run_python(USE_FILE.format(law=str(law)), **cache))
    assert float(run_python(USE, **cache)) == one  # of another module, by the same machine code
    law.write_text(LAW.format(factor="2.0"))
    assert float(run_python(USE, **cache)) == pytest.approx(2 * one, rel=1e-9)
    # a process that does not know the law is not disturbed by it
    law.unlink()
    code = "import stiction as st; print(st.simulate(st.presets.nakano_popov_2020(), 0.02).status)"
    assert "COMPLETED" in run_python(code, NUMBA_CACHE_DIR=cache["NUMBA_CACHE_DIR"])


WITH_HELPER = """
from typing import NamedTuple
from numba import njit
factor = 1.0
{helper}
class Mine(NamedTuple):
    mu: float
    def coefficient(law, v):
        return law.mu * loss(1.0, 3)
    def slope(law, v):
        return 0.0
"""
STATED = """
@njit("float64(float64, int64)")
def loss(x, n):
    return factor * x
"""
IN_TURN = """
@njit
def loss(x, n):
    return factor * x if n == 0 else other(x, n - 1)
@njit
def other(x, n):
    return factor * x if n == 0 else loss(x, n - 1)
"""


@pytest.mark.parametrize("helper", [STATED, IN_TURN])
def test_a_second_process_runs_a_law_with_any_helper(helper, tmp_path, code_cache):
    """Stored code of such a law ended the process that loaded it."""
    (tmp_path / "mylaw.py").write_text(WITH_HELPER.format(helper=helper))
    cache = {"NUMBA_CACHE_DIR": str(code_cache), "PYTHONPATH": str(tmp_path)}
    twice = USE + "print(st.simulate(slider, 0.1).stick_intervals[0, 1])\n"
    assert run_python(twice, **cache) == run_python(twice, **cache)


def test_old_names_go_on_working_with_a_warning():
    from stiction import _RENAMED
    from stiction.names import old_names

    for old, new in _RENAMED.items():
        with pytest.warns(
            DeprecationWarning, match=re.escape(f"stiction.{old} is now called {new};")
        ) as warned:
            found = getattr(st, old)
        assert [each.filename for each in warned] == [__file__]
        assert found is resolve_name(new)
        assert old not in dir(st)
    find = old_names("stiction", {"old_load": "load", "older": "stiction.errors.Status"})
    with pytest.warns(DeprecationWarning, match=r"stiction.old_load is now called stiction.load"):
        assert find("old_load") is st.load
    with pytest.warns(DeprecationWarning, match=r"older is now called stiction.errors.Status"):
        assert find("older") is st.Status
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        find("nonsense")


def test_a_law_that_imports_units_from_their_place_in_0_4_is_read(tmp_path):
    """So is a result with its text: neither could be read."""
    text = (ROOT / "examples" / "mylaw.py").read_text("utf-8")
    law = text.replace("stiction.text.units", "stiction.units")
    assert law != text
    (tmp_path / "mylaw.py").write_text(law, encoding="utf-8")
    shutil.copy(ROOT / "examples" / "own_law.toml", tmp_path)
    renamed = r"stiction\.units\.(\w+) is now called stiction\.text\.units\.\1;"
    with pytest.warns(DeprecationWarning, match=renamed) as warned:
        found = st.Description.from_toml(tmp_path / "own_law.toml").slider.law
    assert {Path(each.filename).name for each in warned} == {"mylaw.py"}
    assert found.v_c == 1e-4


SLIDER = st.presets.nakano_popov_2020()
STUDY = {
    "base": st.Description(SLIDER, st.Initial(), st.Settings(duration=0.01)),
    "axes": {"phi": st.Values(["1 deg"])},
}


@pytest.mark.parametrize(
    ("name", "use"),
    [
        ("disturbed", lambda: st.linear_stability.steady_sliding(SLIDER).disturbed()),
        ("Slider.shaken", lambda: SLIDER.shaken),
        ("the measure 'song'", lambda: st.Study(**STUDY, measures=["song"])),
        ("stiction.stability.growth_rate", lambda: st.stability.growth_rate(SLIDER)),
    ],
)
def test_an_old_name_warns_once_at_the_line_that_holds_it(name, use):
    with pytest.warns(DeprecationWarning, match=re.escape(name)) as warned:
        use()
    assert [each.filename for each in warned] == [__file__]


def test_what_a_module_held_answers_where_a_function_took_its_place() -> None:
    slider = st.presets.nakano_popov_2020()
    with pytest.warns(DeprecationWarning, match=r"st\w+.stability.growth_rate is now called"):
        assert st.stability.growth_rate(slider) == st.linear_stability.growth_rate(slider)
    sliding = st.linear_stability.steady_sliding(slider)
    former, renamed = st.stability.Linearisation, r"stiction.stability.Linearisation is now called"
    with pytest.warns(DeprecationWarning, match=renamed) as warned:
        assert isinstance(sliding, former)
    assert warned[0].filename == __file__
    with pytest.warns(DeprecationWarning, match=renamed):
        assert not isinstance(slider, former)
    with pytest.warns(DeprecationWarning, match=renamed):
        assert issubclass(type(sliding), former)
    with pytest.warns(DeprecationWarning, match=renamed):
        assert former.verdict is type(sliding).verdict
    with pytest.warns(DeprecationWarning, match=r"stiction.audit.Audit is now called"):
        assert not isinstance(slider, st.audit.Audit)


def test_presets_are_listed_without_the_files_in_which_they_are():
    """For completion: every preset is there, and no module."""
    listed = {name for name in dir(st.presets) if not name.startswith("_")}
    assert {"PRESETS", "Number", "Preset", "find", "leine_belt", "nakano_popov_2020"} <= listed
    assert {each for each in listed if ismodule(getattr(st.presets, each))} == set()
    assert "annotations" not in listed
    assert all(name.replace("-", "_") in listed for name in st.presets.PRESETS)
