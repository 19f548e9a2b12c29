"""Commands and Python of the how-to pages, run as a reader would, page by page."""

import re
import shlex
from pathlib import Path

import pytest

from stiction.cli import main

ROOT = Path(__file__).parents[2]
PAGES = sorted(page for room in ("for", "how-to") for page in (ROOT / "docs" / room).glob("*.md"))
BLOCK = re.compile(r"^```(sh|python|text)\n(.*?)^```$", re.M | re.S)


def words(text: str) -> str:
    """Return a text without line breaks and spaces that only lay it out."""
    return " ".join(text.split())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_says_works(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    names: dict[str, object] = {}
    said = ""
    for kind, text in BLOCK.findall(page.read_text("utf-8")):
        if kind == "python":
            exec(compile(text, page.name, "exec"), names)
            continue
        if kind == "text":
            shown = "" if "stiction " in text else text  # commands on files of the reader's
            assert [line for line in shown.splitlines() if words(line) not in said] == []
            continue
        for line in text.splitlines():
            program, *arguments = shlex.split(line, comments=True)
            assert program == "stiction"
            with pytest.raises(SystemExit) as ended:
                main(arguments)
            output = capsys.readouterr()
            assert ended.value.code == 0, output.err
            said += words(output.out)


def test_pages_have_something_to_run():
    assert sum(len(BLOCK.findall(page.read_text("utf-8"))) for page in PAGES) > 10


def test_scripts_of_the_gallery_are_short():
    scripts = sorted((ROOT / "docs" / "gallery").rglob("plot_*.py"))
    assert len(scripts) >= 20
    assert [p.name for p in scripts if len(p.read_text("utf-8").splitlines()) > 40] == []


def test_each_tutorial_can_be_downloaded_as_a_notebook():
    pages = [page for page in (ROOT / "docs" / "tutorials").glob("*.md") if page.stem != "index"]
    assert len(pages) >= 4
    for page in pages:
        assert f"{{nb-download}}`{page.stem}.ipynb`" in page.read_text("utf-8")
