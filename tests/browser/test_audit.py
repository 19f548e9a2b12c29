"""The page of an audit on paper, as a browser lays it out."""

import pytest

import stiction as st
from stiction.auditing.page import write

A4, LETTER = (718, 1047), (739, 979)  # pixels within Chromium's margins of 1 cm
FIGURES = "[...document.querySelectorAll('figure')].map((each) => each.getBoundingClientRect())"


@pytest.fixture(scope="module")
def printed(browser, tmp_path_factory):
    path = tmp_path_factory.mktemp("audit") / "my.html"
    write(st.audit(st.presets.nakano_popov_2020()), path, "the paper's case")
    tab = browser.new_page()
    tab.goto(path.as_uri())
    tab.emulate_media(media="print")
    yield tab
    tab.close()


@pytest.mark.parametrize("paper", [A4, LETTER])
def test_on_paper_figures_of_a_column_stand_side_by_side(printed, paper):
    """The letters of the screen left them no room: each took half of a page, empty at its right."""
    width, height = paper
    printed.set_viewport_size({"width": width, "height": height})
    assert printed.evaluate("document.documentElement.scrollWidth") == width
    figures = printed.evaluate(FIGURES)
    creep, damping, *_ = (each for each in figures if each["width"] < 0.6 * width)
    assert creep["top"] == damping["top"]


@pytest.mark.parametrize("paper", ["A4", "Letter"])
def test_on_paper_two_rows_of_figures_may_part(printed, paper):
    """They went to the next page together, and left half of one empty: five pages."""
    margin = dict.fromkeys(("top", "bottom", "left", "right"), "1cm")
    assert printed.pdf(format=paper, margin=margin).count(b"/Type /Page\n") <= 4
