"""The parts of a release agree: metadata, conda recipe, public CI, the paper about the software."""

import ast
import re
import tomllib
from pathlib import Path

import pytest
import yaml

from stiction.presets import PRESETS

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
CONDA = yaml.safe_load((ROOT / "packaging" / "conda.yaml").read_text("utf-8"))
CI = yaml.safe_load((ROOT / ".github" / "workflows" / "ci.yml").read_text("utf-8"))
_, FRONT, PAPER = (ROOT / "paper" / "paper.md").read_text("utf-8").split("---\n", 2)
# names that differ there: of the core of matplotlib, and of what is an extra here
CONDA_NAMES = {"matplotlib": "matplotlib-base", "h5netcdf[h5py]": "h5netcdf"}
POSIX = {"fcntl", "grp", "pwd", "resource", "termios"}


def test_the_version_is_one():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8")
    newest = re.search(r"^## (\S+)", changes, re.M)
    found = {CONDA["context"]["version"], str(citation["version"]), newest[1]}
    assert found == {PROJECT["version"]}


def test_the_conda_recipe_has_the_dependencies_with_their_floors():
    wanted = {f"python {PROJECT['requires-python']}", "h5py"}
    for each in PROJECT["dependencies"]:
        name, floor = re.fullmatch(r"(\S+?)(>=\S+)", each).groups()
        wanted.add(f"{CONDA_NAMES.get(name, name)} {floor}")
    assert set(CONDA["requirements"]["run"]) == wanted
    entry = PROJECT["scripts"]["stiction"]
    assert CONDA["build"]["python"]["entry_points"] == [f"stiction = {entry}"]
    assert (ROOT / CONDA["about"]["license_file"]).exists()
    assert CONDA["about"]["license"] == PROJECT["license"]


def test_public_ci_runs_what_the_readme_says_on_three_systems():
    matrix = CI["jobs"]["tests"]["strategy"]["matrix"]
    assert {each.split("-")[0] for each in matrix["os"]} == {"ubuntu", "macos", "windows"}
    of = re.compile(r"Programming Language :: Python :: (3\.\d+)")
    tested = {each[1] for text in PROJECT["classifiers"] if (each := of.fullmatch(text))}
    assert tested <= set(matrix["python"])
    assert PROJECT["requires-python"] == f">={min(matrix['python'], key=lambda v: int(v[2:]))}"
    told = (ROOT / "README.md").read_text("utf-8") + (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    steps = [step for job in CI["jobs"].values() for step in job["steps"]]
    for command in (step["run"] for step in steps if "run" in step):
        assert all(part.strip() in told for part in command.split("&&")), command
    assert all(re.fullmatch(r"actions/[\w-]+@v\d+", s["uses"]) for s in steps if "uses" in s)


@pytest.mark.parametrize("folder", ["src", "tests"])
def test_no_module_needs_a_library_that_windows_lacks(folder):
    texts = {path: path.read_text("utf-8") for path in (ROOT / folder).rglob("*.py")}
    assert len(texts) > 100
    trees = {
        path: ast.parse(text) for path, text in texts.items() if any(name in text for name in POSIX)
    }
    found = {
        f"{path}: {alias.name}"
        for path, tree in trees.items()
        for node in tree.body
        if isinstance(node, ast.Import)
        for alias in node.names
    }
    assert sorted(each for each in found if each.rpartition(" ")[2] in POSIX) == []


def test_the_paper_has_what_its_journal_asks_for():
    """The format of JOSS for submissions from 2026 on: 750 to 1750 words in these sections."""
    front = yaml.safe_load(FRONT)
    assert {"title", "tags", "authors", "affiliations", "date", "bibliography"} <= front.keys()
    indices = {each["index"] for each in front["affiliations"]}
    assert all(each["affiliation"] in indices for each in front["authors"])
    assert re.findall(r"^# (.+)$", PAPER, re.M) == [
        "Summary",
        "Statement of need",
        "State of the field",
        "Software design",
        "Research impact statement",
        "AI usage disclosure",
        "Acknowledgements",
        "References",
    ]
    assert 750 <= len(PAPER.split()) <= 1750


def test_references_and_figures_of_the_paper_exist():
    entries = (ROOT / "paper" / yaml.safe_load(FRONT)["bibliography"]).read_text("utf-8")
    known = re.findall(r"^@\w+\{(\w+),", entries, re.M)
    assert set(re.findall(r"@(\w+)", PAPER)) == set(known)
    figures = re.findall(r"!\[.*?\]\((.*?)\)", PAPER)
    assert figures
    assert all((ROOT / "paper" / path).exists() for path in figures)


def test_the_readme_and_the_paper_count_the_published_systems():
    published = sum(each.grade != "scenario" for each in PRESETS.values())
    scenarios = len(PRESETS) - published
    readme = (ROOT / "README.md").read_text("utf-8")
    assert f"{published} published systems and {scenarios} scenarios" in readme
    assert f"{published} published systems" in " ".join(PAPER.split())
