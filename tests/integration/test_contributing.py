"""The worked examples of CONTRIBUTING.md, built from its text and used."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# where it goes, "a line in NAME of" before it for a registry; then the text itself
BLOCK = re.compile(
    r"(?:line in (?:`(?P<name>[^`]+)` of )?|In )`(?P<path>(?:src|docs)/[\w/.]+)`:\n\n"
    r"```\w+\n(?P<text>.*?)```",
    re.DOTALL,
)
LISTS = re.compile(r"from stiction|   \w+$")  # lines in the order of the alphabet
# what a newcomer's addition could break elsewhere: names, pages, rooms
HELD = (
    "tests/unit/test_tree.py::test_no_room_has_more_than_a_dozen_files",
    "tests/unit/test_names.py",
    "tests/unit/friction/test_laws.py::test_a_law_is_registered_by_the_line_that_imports_it",
    "tests/unit/friction/test_laws.py::test_a_comparable_law_has_the_friction_at_rest_and_in_fast_slip",
    "tests/unit/analysis/test_report.py::test_short_and_constant_records_are_no_error",
    "tests/docs/test_reference.py",
    "tests/integration/test_package.py::test_public_names",
    "tests/integration/test_package.py::test_the_glossary_explains_every_public_class_part_of_an_"
    "analysis_and_kind_of_motion",
    "tests/integration/test_package.py::test_names_in_the_glossary_are_names_in_the_code",
    "tests/integration/test_verbs.py::test_each_command_is_a_function_with_a_docstring",
    "tests/integration/test_verbs.py::test_options_that_take_a_value_give_an_example",
    "tests/cli/test_cli.py::test_every_command_explains_itself",
)
USES = r"""
import sys
import stiction as st
from stiction.analysis.export import numbers
from stiction.friction import LAWS
from stiction.testing import check_law

paper = st.presets.nakano_popov_2020()
check_law(LAWS["rational-weakening"](0.3, 0.2, "1 mm/s"))
st.init("my.toml")
assert '# law = "rational-weakening"' in open("my.toml").read()
fast = paper.replace(drive=st.ConstantVelocity("20 mm/s"))
run = st.simulate(fast, 0.15, sample_rate="4 kHz")  # to the first slip: all is plain Python
assert len(st.plotting.plot_phase_plane(run).lines) == 1
found = st.analyse(run)
assert "Fall\n  The force falls by up to " in str(found)
assert numbers(found)["fall"] == {"rate": found.parts["fall"], "unit": "N/s"}
assert found.parts["fall"] > 1.0
base = st.Description(paper, st.Initial(), st.Settings(duration=1.0))
study = st.Study(base=base, axes={"V": st.Values(["5 mm/s"])}, measures=["largest_drop"])
st.sweep(study, "my.zarr")
assert float(st.open_study("my.zarr")["largest_drop"].squeeze()) > 0.1
program = st.protocols.soft_start("1 mm/s", ramp="1 s", slide="2 s")
assert float(program.rate(0.5)[0]) == 0.5e-3
run.save("my.nc")
from stiction.cli import main
main(["measure", "my.nc", "--noise", "2 mN", "-o", "record.nc"])
"""


def lay_out(root: Path) -> list[str]:
    """Put what the page tells into a copy of the project; return the files that it adds."""
    page = (root / "CONTRIBUTING.md").read_text("utf-8")
    added = []
    for block in BLOCK.finditer(page):
        path, text = root / block["path"], block["text"]
        if not path.exists():
            path.write_text(text, "utf-8")
            added.append(block["path"])
            continue
        lines = path.read_text("utf-8").splitlines(keepends=True)
        lines.insert(place_of(block, lines), f"\n\n{text}" if text.startswith("def ") else text)
        path.write_text("".join(lines), "utf-8")
    return added


def place_of(block: re.Match[str], lines: list[str]) -> int:
    """Return the number of the line before which a block is inserted."""
    if block["name"] is not None:
        return 1 + next(i for i, line in enumerate(lines) if line.startswith(block["name"]))
    if block["text"].startswith("def "):
        return len(lines)
    alike = [i for i, line in enumerate(lines) if LISTS.match(line)]
    after = [i for i in alike if lines[i] > block["text"]]
    return after[0] if after else 1 + alike[-1]


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    copy = tmp_path_factory.mktemp("project") / "copy"
    unneeded = shutil.ignore_patterns(".*", "_build", "auto_gallery", "generated")
    shutil.copytree(ROOT, copy, ignore=unneeded)  # bytecode too, which is as old as its source
    assert len(lay_out(copy)) == 4
    return copy


def run_in(folder, project, *command):
    """Run a program of the copy in plain Python: compiled, it would leave machine code behind."""
    plain = {"PYTHONPATH": str(project / "src"), "NUMBA_DISABLE_JIT": "1"}
    return subprocess.run(
        [sys.executable, *command],
        cwd=folder,
        env=os.environ | plain,
        capture_output=True,
        text=True,
    )


def test_what_is_added_works(project, tmp_path):
    done = run_in(tmp_path, project, "-c", USES)
    assert (done.returncode, done.stderr) == (0, "")
    assert "wrote record.nc" in done.stdout


@pytest.mark.parametrize("command", ["check", "format --check"])
def test_what_is_added_is_in_the_style_of_the_house(project, command):
    pytest.importorskip("ruff", reason="it is in the group lint")
    done = run_in(project, project, "-m", "ruff", *command.split(), ".")
    assert done.returncode == 0, done.stdout


def test_what_is_added_fails_no_test_of_names_pages_and_rooms(project):
    page = (project / "CONTRIBUTING.md").read_text("utf-8")
    files = {block["path"] for block in BLOCK.finditer(page) if block["path"].endswith(".py")}
    examples = sorted(each for each in files if ">>> " in (project / each).read_text("utf-8"))
    options = ["-n0", "-q", "-p", "no:cacheprovider", "--no-header"]
    done = run_in(project, project, "-m", "pytest", *options, *HELD, *examples)
    assert done.returncode == 0, done.stdout
