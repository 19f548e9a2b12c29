"""Numbers in README and pages that the software itself can tell."""

import re
from pathlib import Path

import pytest

import stiction as st
from stiction.friction import LAWS

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")
WORDS = " ".join(README.split())


def test_the_readme_counts_what_the_reproduction_finds(tmp_path):
    table = st.paper(tmp_path).table
    stated = [each for each in table.numbers if each.where != "reference"]
    findings = sum(each.finding for each in stated)
    agree = sum(each.agrees for each in stated if not each.finding)
    assert f"{agree} of {len(stated)} agree, and {findings} are findings" in WORDS


def test_the_readme_says_what_the_paper_s_case_comes_to(paper_run, sharp_run):
    u_x = 1e3 * float(sharp_run.final["u_x"])
    force, time = paper_run.samples["spring_x"], paper_run.samples["time"]
    first = force[time < 2.05].argmax()
    told = f"u_x(5 s) = {u_x:.8f} mm, {paper_run.statistics.stick_count} stick intervals, "
    assert f"{told}first peak {force[first]:.4f} N at {time[first]:.4f} s" in WORDS
    assert f"several of {len(LAWS)} laws" in WORDS


def test_times_in_the_readme_are_those_of_the_page_on_speed():
    page = (ROOT / "docs" / "explanation" / "how-fast.md").read_text("utf-8")
    rows = re.findall(r"^\| .* ms \| .*$", README, re.M)
    assert len(rows) == 4
    assert [row for row in rows if row not in page] == []


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md", "SECURITY.md"])
def test_links_to_files_lead_somewhere(name):
    text = (ROOT / name).read_text("utf-8")
    links = [each.partition("#")[0] for each in re.findall(r"\]\(((?!http)[^)]+)\)", text)]
    assert [each for each in links if not (ROOT / each).exists()] == []


def test_the_page_on_citing_names_this_version():
    assert f"version = {{{st.__version__}}}" in (ROOT / "docs" / "how-to" / "cite.md").read_text()
