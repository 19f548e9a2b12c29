"""Numbers in README and pages that the software itself can tell."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import stiction as st
from stiction.reproduction import reproduce

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
CELL = re.compile(r"^```{code-cell} python\n(?::[^\n]*\n)*(.*?)^```$", re.M | re.S)
README = (ROOT / "README.md").read_text("utf-8")
WORDS = " ".join(README.split())


def test_the_readme_counts_what_the_reproduction_finds(tmp_path, monkeypatch):
    monkeypatch.setattr(reproduce, "save", lambda *_: [])  # no figures
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


def page_in_words(name):
    return " ".join((DOCS / f"{name}.md").read_text("utf-8").split())


def angles_of(slider):
    """Return where zeta at the start of slip is 1, and where steady sliding becomes stable, deg."""

    def above(phi):
        turned = slider.replace(phi=f"{phi!r} rad")
        return st.theory.damping_number_of(turned, slider.motion.velocity) * np.sin(phi) ** 3 - 1.0

    first = brentq(above, 0.01, 0.5)
    return np.degrees([first, st.linear_stability.critical(slider, "phi").values[0]])


def test_the_page_on_the_physics_says_what_is_computed(slider, paper_run):
    page, cycles = page_in_words("explanation/physics"), st.analysis.find_cycles(paper_run)
    assert f"rests until {1e3 * paper_run.stick_intervals[0][1]:.2f} ms" in page
    damped, stable = angles_of(slider)
    assert rf"at which $\zeta(\varphi) = 1$ is {damped:.2f}°" in page
    assert f"{stable:.2f}° here" in page
    static, kinetic = (float(cycles[name].mean()) for name in ("mu_static", "mu_kinetic"))
    assert f"they are {static:.4f} and {kinetic:.4f}" in page


def test_the_lecture_asks_for_the_right_angles(slider):
    damped, stable = angles_of(slider)
    told = f"They differ: {damped:.1f}, 8.2 and {stable:.1f} degrees"
    assert told in page_in_words("tutorials/lecture")


def test_the_rig_sticks_and_slips_up_to_the_angle_that_the_pages_say(slider):
    """Not up to where the slow motion is always overdamped, nor up to stable sliding."""
    assert "still sticks and slips up to 8.16°" in page_in_words("explanation/physics")
    for phi, sticks in (("8.16 deg", True), ("8.17 deg", False)):
        run = st.simulate(slider.replace(phi=phi), "120 s", sample_rate=0)
        assert bool((run.stick_intervals[:, 0] > 100.0).any()) is sticks


def test_the_first_half_hour_repeats_what_the_audit_advises(slider):
    advice = next(each for each in st.audit(slider).advices if each.path == "phi")
    assert advice.works
    told = f"turn the spring by {np.degrees(advice.then):.0f} degrees and the stick-slip is gone"
    assert told in page_in_words("tutorials/first-half-hour")


def test_the_tutorial_on_a_record_tells_what_its_cells_print(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (DOCS / "tutorials" / "record.md").read_text("utf-8")
    before, told = text.split("The coefficient at the peaks, ")
    names = {}
    for cell in CELL.findall(before):
        exec(cell, names)
    static = float(names["found"].cycles["mu_static"].mean())
    assert told.startswith(f"{static:.2f} in the mean")  # the third digit is that of a processor
    assert f"2.5 degrees are {np.radians(2.5):.4f}" in text


def test_the_tutorial_on_a_study_tells_what_its_runs_do(slider):
    """Along the slowest drive of its grid, and at its largest angle."""
    text = page_in_words("tutorials/study")
    assert "from 7 degrees on the rig slides steadily" in text
    assert "For the slowest two velocities of the grid" in text
    assert "others it does not up to 12 degrees" in text
    velocities = np.geomspace(0.6e-3, 20e-3, 6)
    runs = [("6 deg", 0, False), ("7 deg", 0, True), ("12 deg", 1, True)]
    runs += [("12 deg", i, False) for i in range(2, 6)]
    for phi, i, settles in runs:
        turned = slider.replace(phi=phi, drive=st.ConstantVelocity(float(velocities[i])))
        kind = st.analyse(st.simulate(turned, "6 s")).regime.kind
        assert (kind == "settling") == settles, (phi, i, kind)


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
