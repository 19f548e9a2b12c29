"""The tree: rooms stay small, and what benchmarks import is there."""

import ast
import os
import re
import tomllib
from collections import Counter
from importlib.util import find_spec
from pathlib import Path

import pytest
from benchmarks.__main__ import PARTS

ROOT = Path(__file__).parents[2]
DOZEN = 12
TREES = ("src/stiction", "tests", "benchmarks")
PARTICIPLE = re.compile(
    "[a-z]+(ed|en)|(k|cr|sw|sl)ept|known|shown|drawn|grown|torn|told|held|sold|made|done|said|gone"
    "|found|wound|lent|bent|left|lost|meant|paid|sought|thought|spent|stuck|sung|swung|risen"
)
NO_PARTICIPLES = {"between", "len", "listen", "reopen", "speed", "seed"}
# phrases that CONTRIBUTING (English) replaces: "by default", and "is not a"
REPLACED = re.compile(
    r"when left out|(?<!there )(?<!There )\b(is|are) no "
    "(?!longer|more|less|larger|smaller|closer|better|faster|slower|such)"
)
# words of first sentences that mostly hide the noun: "what is left" is the remainder
HIDING = re.compile(r"\b([Ww]hat|told|kept|that which|as of)\b")
HIDDEN = {  # which need no other: this list may only become shorter
    "arguments.py: read_whole",
    "arguments.py: refuse_last",
    "cli/commands/analyse.py: import_",
    "cli/commands/inference/design.py: design",
    "study/execution/cores.py: ask",
    "study/execution/engines.py: refuse_other",
    "study/execution/engines.py: results",
    "study/execution/sweep.py: Pace",
    "study/execution/sweep.py: StoredOutcome",
    "study/execution/sweep.py: values_of",
    "study/store/kept.py: names_kept",
}
# decorators describe the function below them; laws of users, stored in results, have `settled`
CONTRACTS = {"compiled", "inlined", "settled", "disturbed"}
STRAY = re.compile(r".+(\.(orig|rej|bak|swp|swo|tmp)|~)")  # what patches and editors leave
ROOMS = (*TREES, "docs", "examples", "packaging", "paper", ".github")
BUILT = {"__pycache__", "_build", "auto_gallery", "generated", "backreferences", "libraries"}
EMPTY = {"__init__.py", "py.typed"}
BENCHMARKS = sorted((ROOT / "benchmarks").rglob("*.py"))


def test_no_room_has_more_than_a_dozen_files():
    rooms = {path.parent for tree in TREES for path in (ROOT / tree).rglob("*.py")}
    sizes = {room: len({*room.glob("*.py")} - {room / "__init__.py"}) for room in rooms}
    full = [f"{room.relative_to(ROOT)} has {size}" for room, size in sizes.items() if size > DOZEN]
    assert not full, f"more files than a dozen: {', '.join(full)}; divide the room, or use another"


@pytest.mark.parametrize("path", BENCHMARKS, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_a_benchmark_imports_of_ours_is_there(path):
    tree = ast.walk(ast.parse(path.read_text("utf-8")))
    froms = [node for node in tree if isinstance(node, ast.ImportFrom) and node.module]
    ours = [each for each in froms if each.module.split(".")[0] in ("stiction", "benchmarks")]
    missing = [each.module for each in ours if find_spec(each.module) is None]
    for each in ours:
        room = ROOT / each.module.replace(".", "/")
        if room.is_dir() and not (room / "__init__.py").read_text().count("import"):
            files = {path.stem for path in room.iterdir()}
            missing += [name.name for name in each.names if name.name not in files]
    assert missing == []


def modules_in(text):
    """Modules that a text imports, by their dotted names, and words that may name one."""
    dotted = re.findall(r"\bstiction(?:\.\w+)+", text)
    lists = re.findall(r"from (stiction[\w.]*) import (.+)", text)
    dotted += [f"{room}.{name}" for room, names in lists for name in re.findall(r"\w+", names)]
    words = re.findall(r'"([\w-]+)"', text) + re.findall(r"from \.(?:\w+\.)*(\w+) import", text)
    return {*dotted, *(word.replace("-", "_") for word in words)}


def test_a_file_is_used_by_another():
    """A law, a command or a figure without its line in a registry would be nobody's."""
    room = ROOT / "src"
    files = [*room.rglob("*.py"), *room.rglob("*.pyi")]
    said = {path: modules_in(path.read_text("utf-8")) for path in files}
    times = Counter(name for names in said.values() for name in names)
    for path, names in said.items():
        if path.stem in ("__init__", "__main__"):
            continue
        name = ".".join(path.relative_to(room).with_suffix("").parts)
        own = sum(each in names for each in (name, path.stem))
        line = f"{path.relative_to(ROOT)} is used by no file; register it in a line."
        assert times[name] + times[path.stem] > own, f"{line} See CONTRIBUTING, Adding things"


def test_a_constant_has_one_value_in_its_file():
    """Of two, whoever reads the first is wrong."""
    twice = []
    for path in [*(ROOT / "src").rglob("*.py"), *(ROOT / "benchmarks").rglob("*.py")]:
        body = ast.parse(path.read_text("utf-8")).body
        targets = [each for node in body for each in getattr(node, "targets", ())]
        stored = [each for top in targets for each in ast.walk(top) if isinstance(each, ast.Name)]
        times = Counter(each.id for each in stored if isinstance(each.ctx, ast.Store))
        twice += [f"{path.relative_to(ROOT)}: {name}" for name in times if times[name] > 1]
    assert twice == []


def test_contributing_names_the_rooms_from_the_bottom_up():
    """As the contract on imports has them."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8").partition("from the bottom up: ")[2]
    rooms = {path.parent.name for path in (ROOT / TREES[0]).glob("*/__init__.py")} - {"units"}
    named = re.findall(r"`(\w+)`", text.partition("`arrays`")[0])
    assert sorted(named) == sorted(rooms)
    assert named == sorted(named, key=floors().__getitem__)


def test_ways_up_that_the_contract_does_not_see_are_these():
    """Public names in stubs, and modules that are named in a text."""
    room, floor, up = ROOT / TREES[0], floors(), set()
    for path in [*room.rglob("*.py"), *room.glob("*/**/*.pyi")]:
        own = path.relative_to(room).with_suffix("").parts
        opening = r"from " if path.suffix == ".pyi" else r'import_module\(f?"'
        for other in re.findall(opening + r"stiction\.(\w+)", path.read_text("utf-8")):
            if floor.get(other, 0) > floor.get(own[0], 0):
                up.add((".".join(own), other))
    assert up == {
        ("names", "plotting"),  # results draw themselves
        ("plotting.__init__", "study"),  # the figure of a study
        ("drive.protocols", "study"),  # a friction test that is a study stands beside the others
    }


def floors():
    """Return the height of each room in the contract on imports."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    layers = project["tool"]["importlinter"]["contracts"][0]["layers"]
    return {name: -i for i, layer in enumerate(layers) for name in re.findall(r"\.(\w+)", layer)}


def test_each_part_of_the_benchmark_is_there():
    assert [part for part in PARTS.values() if find_spec(f"benchmarks.{part}") is None] == []


def test_a_class_name_means_one_thing():
    """Two rooms may have a `Table`: the friction law of a user, and the rows of a report."""
    trees = (ast.parse(path.read_text("utf-8")) for path in (ROOT / TREES[0]).rglob("*.py"))
    names = Counter(node.name for tree in trees for node in tree.body if type(node) is ast.ClassDef)
    assert {name for name, count in names.items() if count > 1} == {"Table"}


def functions_of(tree):
    """Yield the functions and methods of a module; properties and fixtures describe a thing."""
    owners = [tree, *(node for node in tree.body if isinstance(node, ast.ClassDef))]
    for node in (node for owner in owners for node in owner.body):
        marks = " ".join(map(ast.unparse, getattr(node, "decorator_list", [])))
        if isinstance(node, ast.FunctionDef) and not re.search("property|fixture", marks):
            yield node.name.strip("_")


def test_functions_are_nouns_or_imperatives():
    """No name is a lone participle (CONTRIBUTING, English)."""
    wrong = set()
    for path in (path for tree in TREES for path in (ROOT / tree).rglob("*.py")):
        for name in functions_of(ast.parse(path.read_text("utf-8"))):
            if PARTICIPLE.fullmatch(name) and name not in NO_PARTICIPLES | CONTRACTS:
                wrong.add(f"{path.relative_to(ROOT)}: {name}")
    assert sorted(wrong) == []


def test_phrases_that_are_read_twice_are_replaced():
    pages = [path for path in (ROOT / "docs").rglob("*.md") if "_build" not in path.parts]
    wrong = [
        f"{path.relative_to(ROOT)}: {found[0]}..."
        for path in (ROOT / "README.md", *pages, *(ROOT / "src").rglob("*.py"))
        for found in REPLACED.finditer(path.read_text("utf-8"))
    ]
    assert wrong == []


def first_sentences(path):
    """Yield name and first paragraph of each docstring of a file."""
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, kinds) and (text := ast.get_docstring(node)):
            yield getattr(node, "name", "module"), text.partition("\n\n")[0]


def test_first_sentences_name_what_they_are_about():
    """As CONTRIBUTING (English) asks: "the remaining samples", not "what is left of them"."""
    room = ROOT / TREES[0]
    found = {
        f"{path.relative_to(room).as_posix()}: {name}"
        for path in room.rglob("*.py")
        for name, text in first_sentences(path)
        if HIDING.search(text)
    }
    assert sorted(found - HIDDEN) == [], "name the thing: CONTRIBUTING, English"
    assert sorted(HIDDEN - found) == [], "take these out of HIDDEN: they are mended"


def test_a_mutant_that_is_known_to_be_equivalent_is_one_of_a_line_that_is_there():
    known = tomllib.loads((ROOT / "benchmarks/mutation/equivalent.toml").read_text("utf-8"))
    texts = {row["file"]: (ROOT / row["file"]).read_text("utf-8") for row in known["mutant"]}
    assert [row for row in known["mutant"] if row["before"] not in texts[row["file"]]] == []


def files():
    """Yield all files but those that are built, whether or not they are under version control."""
    yield from (path for path in ROOT.iterdir() if path.is_file())
    for tree in ROOMS:
        for room, within, names in os.walk(ROOT / tree):
            within[:] = set(within) - BUILT
            yield from (Path(room, name) for name in names)


def is_stray(path):
    """Return whether a patch or an editor left a file, or one that was to be written is empty."""
    return bool(STRAY.fullmatch(path.name)) or not (path.stat().st_size or path.name in EMPTY)


def test_no_stray_file_is_left():
    """A copy that a patch had left beside a module was committed."""
    assert [str(path.relative_to(ROOT)) for path in files() if is_stray(path)] == []


@pytest.mark.parametrize("name", ["a.py.orig", "a.py.rej", "a.bak", "a.md~", ".a.py.swp", "a.py"])
def test_a_stray_file_is_found(name, tmp_path):
    path = tmp_path / name
    path.write_text("x = 1\n" * (name != "a.py"))
    assert is_stray(path)
    assert not is_stray(Path(__file__))
