"""Commands and Python of all pages, run as a reader would, page by page."""

import re
import shlex
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from pkgutil import resolve_name

import pytest

import stiction as st
from stiction.cli import COMMANDS, app, main

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MADE = {"_build", "auto_gallery", "gallery"}  # by the build of the site
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")),
    *(each for each in sorted(DOCS.rglob("*.md")) if not MADE & {*each.relative_to(DOCS).parts}),
]
NOTES = [ROOT / "benchmarks" / name for name in ("README.md", "NOTES.md")]
TESTED = {"README.md", "CONTRIBUTING.md"}  # tests/integration runs their Python
BLOCK = re.compile(r"^( *)(?:<!-- not run: ([^\n]+) -->\n\n *)?```(\w+)\n(.*?)^\1```$", re.M | re.S)
FENCED = re.compile(r"^( *)```.*?^\1```$", re.M | re.S)
SPANS = re.compile(r"`(?:uv run (?:--extra explorer )?)?(stiction [a-z][^`]*)`")
READER_S = {"study.toml": ROOT / "examples" / "study.toml"}  # files that a page asks for
PREFIX = re.compile(r"^uv run( --(group|extra) \S+)* ")
INSTALLERS = ("pip", "pytest", "pre-commit", "uv")


def words(text: str) -> str:
    """Return a text without line breaks and spaces that only lay it out."""
    return " ".join(text.split())


def name_of(page: Path) -> str:
    """Return the place of a page."""
    return page.relative_to(ROOT).as_posix()


def blocks_of(page: Path) -> list[tuple[str, str, str]]:
    """Return why it is not run, language and text of each block of a page."""
    return [(why, kind, text) for _, why, kind, text in BLOCK.findall(page.read_text("utf-8"))]


def commands_in(text: str) -> list[list[str]]:
    """Return the words of each command of a block, without how its program is started."""
    lines = [part.strip() for line in text.splitlines() for part in line.split("&&")]
    return [found for line in lines if (found := shlex.split(PREFIX.sub("", line), comments=True))]


def run(text: str, capsys: pytest.CaptureFixture[str]) -> str:
    """Run the commands of a block; return what they print."""
    said = ""
    for program, *arguments in commands_in(text):
        assert program == "stiction", f"{program}: mark the block '<!-- not run: REASON -->'"
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        output = capsys.readouterr()
        assert ended.value.code == 0, output.err
        said += words(output.out)
    return said


def whole(text: str) -> str:
    """Return a description of a page; a table of friction alone takes its place in the paper's."""
    paper = st.presets.nakano_popov_2020().to_toml()
    return text if "[slider]" in text else re.sub(r"\[friction\]\n(.+\n)*", text, paper)


def fewer(count: re.Match[str]) -> str:
    """Return a quarter of the number of values on an axis."""
    return f"count = {int(count[1]) // 4}"


def refuse_unknown(text: str) -> None:
    """Refuse commands that cannot be meant: an unknown option, a module or a file not there."""
    for program, *arguments in commands_in(text):
        if program == "stiction":
            app.parse_args(arguments, print_error=False, exit_on_error=False)
        elif program == "python":
            assert find_spec(arguments[arguments.index("-m") + 1]), arguments
        elif program not in INSTALLERS:
            assert (ROOT / program).exists(), program


WITH_BLOCKS = [page for page in PAGES if blocks_of(page)]


@pytest.mark.parametrize("page", WITH_BLOCKS, ids=name_of)
def test_what_a_page_says_works(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    names: dict[str, object] = {}
    said = ""
    for name, file in READER_S.items():
        if name in page.read_text("utf-8"):  # with 24 runs in place of 384
            (tmp_path / name).write_text(re.sub(r"count = (\d+)", fewer, file.read_text("utf-8")))
    for why, kind, text in blocks_of(page):
        if kind == "python" and page.name not in TESTED:
            code = compile(text, page.name, "exec")
            if not why:
                exec(code, names)
        elif kind == "sh" and not why:
            said += run(text, capsys)
        elif kind == "sh":
            refuse_unknown(text)
        elif kind == "toml":
            assert st.Rig.from_toml(whole(text)).slider
        elif kind == "text":
            assert [line for line in text.splitlines() if words(line) not in said] == []


def test_blocks_have_one_way_to_be_marked():
    kinds = {(kind, page.name) for page in WITH_BLOCKS for _, kind, _ in blocks_of(page)}
    assert {kind for kind, _ in kinds} <= {"sh", "python", "toml", "text", "bibtex", "md"}, kinds
    marks = sum(len(re.findall("^ *<!-- not run", page.read_text("utf-8"), re.M)) for page in PAGES)
    assert marks == sum(bool(why) for page in PAGES for why, _, _ in blocks_of(page))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_commands_in_sentences_are_those_of_the_command_line(page):
    """With options that they have; many are not whole: `stiction fit --mechanism`."""
    for span in SPANS.findall(page.read_text("utf-8")):
        command, *arguments = shlex.split(span)[1:]
        if f'"{command}",' in page.read_text("utf-8"):  # the worked example of CONTRIBUTING
            continue
        assert command in COMMANDS, span
        known = {
            name for each in app[command].assemble_argument_collection() for name in each.names
        }
        assert [each for each in arguments if each[0] == "-" and each not in known] == [], span


@pytest.mark.parametrize("page", [*PAGES, *NOTES], ids=name_of)
def test_what_sentences_name_is_there(page):
    """Names of this package, modules to run and their options, and files."""
    text = page.read_text("utf-8")
    spans = re.findall(r"`([^`\n]+)`", FENCED.sub("", text))
    names = {
        name for span in spans for name in re.findall(r"\bst(?:iction)?\.((?:\w+\.)*\w+)", span)
    }
    assert sorted(name for name in names if not is_name(name)) == []
    modules = {name for span in spans for name in re.findall(r"python -m ([\w.]+)", span)}
    assert sorted(name for name in modules if find_spec(name) is None) == []
    options = {found for span in spans for found in re.findall(r"(?<!\S)--[a-z][\w-]*", span)}
    assert sorted(options - known_options()) == []
    files = {
        span for span in spans if re.fullmatch(r"(\.ci|src|tests|docs|benchmarks)/[\w./]+", span)
    }
    made = {path for path in files if f"In `{path}`:\n" in text}  # by a worked example
    assert sorted(path for path in files - made if not (ROOT / path).exists()) == []


def is_name(path: str) -> bool:
    """Return whether a path leads to something in the package."""
    try:
        resolve_name(f"stiction.{path}")
    except (AttributeError, ImportError):
        return False
    return True


@cache
def known_options() -> set[str]:
    """Return the options of all commands, of the benchmarks, and those of uv and ruff in pages."""
    own = {
        name
        for each in COMMANDS
        for a in app[each].assemble_argument_collection()
        for name in a.names
    }
    sources = [path.read_text("utf-8") for path in (ROOT / "benchmarks").rglob("*.py")]
    theirs = {option for text in sources for option in re.findall(r'"(--[a-z][\w-]*)"', text)}
    return own | theirs | {"--extra", "--fix", "--group", "--help", "--version"}


def test_pages_have_something_to_run():
    assert sum(len(blocks_of(page)) for page in PAGES) > 60


def test_scripts_of_the_gallery_are_short():
    scripts = sorted((ROOT / "docs" / "gallery").rglob("plot_*.py"))
    assert len(scripts) >= 20
    assert [p.name for p in scripts if len(p.read_text("utf-8").splitlines()) > 40] == []


def test_each_tutorial_can_be_downloaded_as_a_notebook():
    pages = [page for page in (ROOT / "docs" / "tutorials").glob("*.md") if page.stem != "index"]
    assert len(pages) >= 4
    for page in pages:
        assert f"{{nb-download}}`{page.stem}.ipynb`" in page.read_text("utf-8")
