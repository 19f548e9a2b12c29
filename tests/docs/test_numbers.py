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


def test_the_page_on_the_physics_says_how_far_the_mass_creeps_and_when_it_rests(paper_run):
    page, data = page_in_words("explanation/physics"), paper_run.samples
    at = np.searchsorted(data["time"], 2.0)
    along, across = (1e6 * data[name][at] for name in ("X", "Y"))
    assert f"{along:.0f} µm along the drive and {across:.0f} µm across it in the first 2 s" in page
    ends = paper_run.stick_intervals[:, 1]
    slip = data["time"][data["spring_x"][: np.searchsorted(data["time"], 2.05)].argmax()]
    assert f"until {slip - ends[ends < slip].max():.2f} s before the slip" in page


def test_the_first_half_hour_says_what_the_force_across_does_after_a_slip(paper_run):
    time, force = paper_run.samples["time"], paper_run.samples["spring_y"]
    after = force[(time > 2.05) & (time < 2.2)].max()
    assert after / force[time < 0.1].max() == pytest.approx(4 / 5, abs=0.05)
    assert "after each slip to four fifths of it" in page_in_words("tutorials/first-half-hour")


def test_the_lecture_asks_for_the_right_angles(slider):
    damped, stable = angles_of(slider)
    told = f"They differ: {damped:.1f}, 8.2 and {stable:.1f} degrees"
    assert told in page_in_words("tutorials/lecture")


def test_the_lecture_answers_its_questions(slider):
    page = page_in_words("tutorials/lecture")
    critical = st.linear_stability.critical(slider, "drive.velocity").values[0]
    assert f"`st.stability(slider)` says {1e3 * critical:.1f} mm/s" in page
    swings = []
    for velocity in (93e-3, 100e-3, 150e-3, 300e-3):
        run = st.simulate(
            slider.replace(drive=st.ConstantVelocity(velocity)), 51.0, sample_rate=2e3
        )
        swings.append(np.ptp(run.samples["spring_x"][run.samples["time"] > 50.0]))
    told = "{:.1f}, {:.1f}, {:.1f} and {:.1f} N after 50 s".format(*swings)
    assert f"still swings by {told}" in page
    told = []
    for each in (slider.replace(mass=2.0 * slider.mass), slider, slider.replace(phi="2 deg")):
        cycles = st.analysis.find_cycles(st.simulate(each, 20.0, sample_rate=5e3))
        told += [float(cycles[name].mean()) for name in ("mu_static", "mu_kinetic")]
    pair = "{:.4f} and {:.4f}"
    words = f"{pair} in place of {pair}. Twice the misalignment gives {pair}"
    assert words.format(*told) in page


def test_the_lecture_says_what_coulomb_friction_leaves(slider):
    """One rise, which exceeds 2 N, and settles where friction points along the drive."""
    run = st.simulate(slider.replace(friction=st.Coulomb(mu_0=0.2)), 10.0, sample_rate=5e3)
    force, page = run.samples["spring_x"], page_in_words("tutorials/lecture")
    assert f"exceeds 2 N by {100.0 * (force.max() / 2.0 - 1.0):.1f} %" in page
    assert force[-1] == pytest.approx(2.0 * np.cos(slider.phi), rel=1e-5)
    [(_, end)] = run.stick_intervals
    assert f"rests for the first {1e3 * end:.0f} ms and never again" in page


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


@pytest.fixture
def rock():
    """The rig of the page on tests."""
    return st.Slider(
        mass="1 g",
        k_x="1 MN/m",
        k_y="100 MN/m",
        phi="0 deg",
        normal_load="10 N",
        friction=st.laws.RateStateAgeing(0.010, 0.015, "10 um", 0.6, "1 um/s"),
        drive=st.ConstantVelocity("10 um/s"),
    )


def after_holds(rig, holds, slide, phi):
    test = st.protocols.slide_hold_slide("10 um/s", holds, slide=slide)
    return st.simulate(rig.replace(phi=phi, drive=test), sample_rate="20 Hz")


def test_the_page_on_tests_tells_how_much_healing_a_misalignment_hides(rock):
    def healing(rig, phi):
        holds = ["3 s", "10 s", "30 s", "100 s", "300 s", "1000 s"]
        along = rig.replace(cell_angle="0 deg")  # the drive, as the page has it
        return st.analysis.healing(after_holds(along, holds, "20 s", phi)).per_decade

    text, soft = page_in_words("how-to/protocols"), rock.replace(k_x="20 kN/m", k_y="2 MN/m")
    found = [healing(soft, phi) for phi in ("0 deg", "1 deg", "2 deg", "5 deg")]
    assert "# {:.4f}, {:.4f}, {:.4f} and {:.4f}".format(*found) in text
    missing = 1.0 - healing(rock, "5 deg") / healing(rock, "0 deg")
    assert f"{100.0 * missing:.1f} % of the healing are missing" in text
    assert f"stretched by 30 D_c, {100.0 * (1.0 - found[-1] / found[0]):.0f} % are" in text
    per_degree = 100.0 * (1.0 - found[1] / found[0])
    assert f"less healing, by {per_degree:.0f} % a degree" in page_in_words("for/geophysicists")


def test_friction_turns_in_a_hold_and_back_as_the_page_on_tests_says(rock):
    text, soft = page_in_words("how-to/protocols"), rock.replace(k_x="20 kN/m", k_y="2 MN/m")

    def course(phi):
        """Return the course from the end of a hold to the peak, and the angle before the hold.

        It is the angle of friction (deg), and how far the mass has moved, in D_c.
        """
        data = after_holds(soft, ["1000 s"], "60 s", phi).data
        before, end = np.searchsorted(data["time"], [59.0, 1060.0])
        force = data["spring_x"].values
        angle = np.degrees(np.arctan2(data["spring_y"].values, force))
        to_peak = slice(end, end + np.argmax(force[end:]) + 1)
        return angle[to_peak], data["X"].values[to_peak] / soft.law.D_c, angle[before]

    angle, X, before = course("5 deg")
    assert f"friction stands at {before:.0f} degrees before a hold of 1000 s" in text
    assert f"at {angle[0]:.1f} degrees after it, turns to {angle.max():.0f} degrees" in text
    assert f"back to {angle[-1]:.0f} degrees when the force is largest" in text
    _, aligned, _ = course("0 deg")
    assert f"slips by {np.ptp(X):.1f} D_c, by {np.ptp(aligned):.1f} D_c where" in text


def test_times_in_the_readme_are_those_of_the_page_on_speed():
    page = (ROOT / "docs" / "explanation" / "how-fast.md").read_text("utf-8")
    rows = re.findall(r"^\| .* ms \| .*$", README, re.M)
    assert len(rows) == 4
    assert [row for row in rows if row not in page] == []


def test_pages_count_the_peers_of_the_benchmark():
    sources = (ROOT / "benchmarks" / "precision" / "peers").glob("*.py")
    texts = [each.read_text("utf-8") for each in sources]
    peers = {name for text in texts for name in re.findall(r'rows\("([^"]+)"', text)}
    counts = ("ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen")
    pages = [ROOT / name for name in ("README.md", "paper/paper.md", "benchmarks/README.md")]
    found = re.compile(rf"({'|'.join(counts)}) (?:peers|solvers of others)", re.IGNORECASE)
    said = [found.findall(page.read_text("utf-8")) for page in [*pages, *DOCS.rglob("*.md")]]
    assert sum(map(len, said)) == 7
    assert {each.lower() for words in said for each in words} == {counts[len(peers) - 10]}


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md", "SECURITY.md"])
def test_links_to_files_lead_somewhere(name):
    text = (ROOT / name).read_text("utf-8")
    links = [each.partition("#")[0] for each in re.findall(r"\]\(((?!http)[^)]+)\)", text)]
    assert [each for each in links if not (ROOT / each).exists()] == []


def test_the_page_on_citing_names_this_version():
    assert f"version = {{{st.__version__}}}" in (ROOT / "docs" / "how-to" / "cite.md").read_text()
