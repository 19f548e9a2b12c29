"""The pages of the reference: every public name once, each with an example that runs."""

import inspect
import re
from pathlib import Path
from pkgutil import resolve_name
from types import ModuleType

import pytest

import stiction as st
from stiction.names import public_names
from stiction.presets import PRESETS
from stiction.study.store.store import ENDS, OF_ANY_RUN

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted((DOCS / "reference" / "python").glob("*.md"))
GALLERY = " ".join(path.read_text("utf-8") for path in (DOCS / "gallery").rglob("plot_*.py"))
STUBS = ("analysis", "linear_stability", "plotting", "protocols", "results")
MADE_BY = {  # results of what takes a minute, or writes: the example is that of the function
    "Advice": "design",
    "Film": "animate",
    "Fit": "fit",
    "Odds": "mechanism",
    "Reproduction": "paper",
    "Sound": "listen",
    "Summary": "sweep",
}
SERVER = "explore"  # serves until its page is closed: tests/browser


def names_on(page: Path) -> list[str]:
    """Return the full names that a page lists."""
    text = page.read_text("utf-8")
    room = re.search(r"currentmodule:: (\S+)", text)
    names = re.findall(r"^   ([\w.]+)$", text, re.M)
    return [f"{room[1]}.{name}" if room else name for name in names]


LISTED = [name for page in PAGES if page.stem != "parts" for name in names_on(page)]
FOUND = {name: resolve_name(f"stiction:{name.removeprefix('stiction.')}") for name in LISTED}


def public_objects() -> dict[int, str]:
    """Return what a session and its rooms offer, by identity."""
    rooms = {room: getattr(st, room) for room in st.__all__}
    rooms = {room: each for room, each in rooms.items() if isinstance(each, ModuleType)}
    found = {name: getattr(st, name) for name in st.__all__ if name not in rooms}
    for room, module in rooms.items():
        names = public_names(module.__name__) if room in STUBS else vars(module)
        for name in names:
            each = getattr(module, name)
            if room in STUBS or getattr(each, "__module__", "").startswith(module.__name__):
                found |= {f"{room}.{name}": each} if name[0] != "_" else {}
    return {id(each): name for name, each in found.items() if callable(each)}


def page_of(name: str) -> str:
    """Return a public name, and the page that should list it."""
    room, _, short = name.rpartition(".")
    return f"docs/reference/python/{room or 'index'}.md {short}"


def test_the_reference_lists_each_public_name_once():
    names = public_objects()
    assert len(names) > 200
    there = {id(each) for each in FOUND.values()}
    lacking = sorted(name for key, name in names.items() if key not in there)
    assert not lacking, f"these pages lack a line: {', '.join(map(page_of, lacking))}"
    assert len({id(each) for each in FOUND.values()}) == len(LISTED)
    assert sorted(name for name, each in FOUND.items() if id(each) not in names) == []


def test_parts_of_results_are_where_their_page_says():
    page = DOCS / "reference" / "python" / "parts.md"
    assert all(isinstance(resolve_name(name), type) for name in names_on(page))


@pytest.mark.parametrize("name", [name for name, each in FOUND.items() if inspect.isfunction(each)])
def test_defaults_of_arguments_fit_a_line_or_so(name):
    """`check_law` had all of its speeds in its signature."""
    arguments = inspect.signature(FOUND[name]).parameters.values()
    assert [each.name for each in arguments if len(repr(each.default)) > 130] == []


@pytest.mark.parametrize("name", LISTED)
def test_each_name_has_an_example(name):
    """In its docstring, which doctest runs, or in a script of the gallery, which the build runs."""
    short = name.rpartition(".")[2]
    if short.replace("_", "-") in PRESETS or short in ("nakano_popov_2020", SERVER):
        return  # every preset is run by tests/unit/presets, and is used alike
    maker = MADE_BY.get(short)
    known = FOUND[f"stiction.{maker}"] if maker else FOUND[name]
    shown = ">>> " in (inspect.getdoc(known) or "") or f".{maker or short}(" in GALLERY
    assert shown, f"{name} lacks an example in its docstring, or in a script of docs/gallery"


def test_the_page_on_ends_has_each_status_with_its_message():
    """The table of runs quotes the messages; that of studies has the further statuses."""
    text = (DOCS / "reference" / "status.md").read_text("utf-8")
    rows = re.findall(r"^\| `(\w+)` \| (.+) \| .+ \|$", text, re.M)
    assert dict(rows[: len(st.Status)]) == {each.name: each.value for each in st.Status}
    assert {name for name, _ in rows[len(st.Status) :]} == {*ENDS} - {*OF_ANY_RUN}
