"""A fit from end to end: records of known rigs, a small library."""

import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.uncertain import SIMULATIONS, TEXT, record_of

import stiction as st
from stiction.analysis.measurement.reading import read_source
from stiction.analysis.signals.robust import block_means
from stiction.errors import DescriptionError, ResultError
from stiction.friction import read_law
from stiction.friction.user.loading import finder_for_descriptions
from stiction.inference.cycles import slip_cycles
from stiction.inference.features import features, of_trend
from stiction.inference.fit import check, plan_for
from stiction.inference.measured.drive_of_records import DriveOfRecords
from stiction.inference.observation import (
    Noise,
    Trend,
    near,
    observe,
    observe_all,
    read_all,
    trend,
)
from stiction.inference.posterior import WITHHELD, middle, row
from stiction.inference.priors import Normal, Uniform
from stiction.inference.rig import Rig, load_of_records
from stiction.inference.simulated.jitter import Jitter, move, stretch
from stiction.inference.simulated.library import build
from stiction.inference.simulated.synthetic import draw, synthesise
from stiction.own_code.source import text_of
from stiction.recording import stored
from stiction.recording.sensor import LowPass, low_pass
from stiction.result import fit_file
from stiction.text.sections import Section

WORN = """
from typing import NamedTuple

class Worn(NamedTuple):
    mu_0: float
    mu_inf: float

    def coefficient(law, v):
        return law.mu_inf + (law.mu_0 - law.mu_inf) / (1.0 + 20.0 * v)

    def slope(law, v):
        return -20.0 * (law.mu_0 - law.mu_inf) / (1.0 + 20.0 * v) ** 2
"""


@pytest.fixture(scope="module")
def found(rig, record, libraries):
    return st.fit(record, rig, simulations=SIMULATIONS, library=libraries)


@pytest.fixture
def copied(libraries, tmp_path):
    """A copy of the simulations, to damage them."""
    return shutil.copytree(libraries, tmp_path / "libraries")


def test_the_figures_say_what_their_lines_and_regions_are(found):
    first, *others = st.plotting.plot_posterior(found)
    assert words_of(first) == ["prior", "posterior", "95 %"]
    assert not any(each.get_legend() for each in others)
    pairs = st.plotting.plot_corner(found)
    assert words_of(pairs[0, 1])[2:] == ["95 %", "95 % of a pair", "50 % of a pair"]


def test_a_fit_has_its_parameters_by_name(found):
    """Of ``"phi" in fit`` it said that no parameter 0 was fitted."""
    names = [*found]
    assert [found[name].name for name in names] == names == [x.name for x in found.estimates]
    assert "phi" in found
    assert "mu_0" in found  # for friction.mu_0
    assert "friction.mu_0" in found
    assert "fi" not in found


def words_of(ax):
    """The entries of a panel's legend."""
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_the_fit_finds_the_parameters_within_their_intervals(found):
    truth = {"phi": np.radians(2.5), "k_x": 2300.0, "mu_0": 0.625, "mu_inf": 0.375}
    # fixed seeds: each interval of 95 % holds the truth
    inside = [name for name, its in truth.items() if found[name].low < its < found[name].high]
    assert inside == [*truth]
    assert found["phi"].identified
    assert found["phi"].narrower < 0.5


def test_the_file_opens_with_xarray(found, tmp_path):
    path = found.save(tmp_path / "fit.nc")
    after, before = xr.open_dataset(path), xr.open_dataset(path, group="prior")
    assert after["phi"].attrs["units"] == "deg"
    median = np.degrees(found["phi"].median)
    assert float(after["phi"].median()) == pytest.approx(median, rel=0.05)
    assert set(after) == set(before) == {"phi", "k_x", "k_y", "mu_0", "mu_inf", "jitter"}


def test_the_file_tells_what_was_fitted_and_what_speaks_against_it(found, tmp_path, monkeypatch):
    doubts = ["The records are none of this rig.", "Two of them contradict each other."]
    monkeypatch.setattr(type(found), "doubts", doubts)
    path = found.save(tmp_path / "fit.nc")
    about = xr.open_dataset(path).attrs
    assert about["stiction_version"] == st.__version__
    assert about["simulations"] == found.simulations
    assert about["doubts"].splitlines() == doubts
    again = st.Rig.from_toml(about["rig"])
    assert again.priors.keys() == found.rig.priors.keys()  # the jitter is no value of the rig
    assert again.slider.mass == found.plan.slider.mass
    assert st.check(path).ok


def test_the_file_holds_the_text_of_a_user_s_law(found, tmp_path, monkeypatch):
    """It held the name alone: of a fit whose law had been edited nobody knew what was fitted."""
    (tmp_path / "worn.py").write_text(WORN)
    table = {"law": "worn.py:Worn", "mu_0": 0.625, "mu_inf": 0.375}
    law = read_law(table, finder_for_descriptions(tmp_path))
    plan = found.plan._replace(slider=found.plan.slider.replace(friction=law))
    text = xr.open_dataset(replace(found, plan=plan).save(tmp_path / "fit.nc")).attrs["rig"]
    assert st.Rig.from_toml(text).slider.law == law  # loaded from the same text
    monkeypatch.delitem(sys.modules, type(law).__module__)
    with pytest.raises(DescriptionError, match="not run without permission"):
        st.Rig.from_toml(text)
    again = st.Rig.from_toml(text, trust=True).slider.law
    assert (text_of(type(again)).text, again) == (WORN, law)


@pytest.mark.parametrize("place", [0.2, 0.5, 0.8, 1.0])
def test_a_damaged_file_of_a_fit_is_found(found, tmp_path, place):
    """Nothing showed it: changed numbers were read as they stood."""
    path = found.save(tmp_path / "fit.nc")
    content = bytearray(path.read_bytes())
    content[int(place * (len(content) - 1))] ^= 1
    path.write_bytes(content)
    with pytest.raises(ResultError, match="fit the records again"):
        st.check(path)
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(ResultError, match=r"fit\.nc"):
        st.check(path)


def test_other_programs_notice_a_changed_number_of_a_fit(found, tmp_path):
    import h5py

    path = found.save(tmp_path / "fit.nc")
    with h5py.File(path) as file:
        chunk = file["phi"].id.get_chunk_info(0)
    content = bytearray(path.read_bytes())
    content[chunk.byte_offset + 3] ^= 1
    path.write_bytes(content)
    with pytest.raises(OSError, match="filter returned failure"):
        xr.load_dataset(path)


def test_the_file_of_a_fit_is_named_where_a_run_or_a_record_is_read(found, tmp_path):
    path = found.save(tmp_path / "fit.nc")
    for read in (st.load, st.read_record, st.analyse):
        with pytest.raises(ResultError, match=r"is the file of a fit; xarray\.open_dataset reads"):
            read(path)


@pytest.mark.parametrize("kind", ["stiction_fit", "stiction_record"])
def test_a_file_of_another_layout_is_refused(found, record, tmp_path, kind, monkeypatch):
    """A stored record of a newer layout was read as if it had this one."""
    module = {"stiction_fit": fit_file, "stiction_record": stored}[kind]
    with monkeypatch.context() as newer:
        newer.setattr(module, "LAYOUT", 2)
        newer.setattr(module, "own_version", lambda: "99.1")
        path = (found if kind == "stiction_fit" else record).save(tmp_path / "newer.nc")
    words = "has layout 2, and layout 1 is read here; stiction 99.1 wrote it"
    with pytest.raises(ResultError, match=words):
        st.check(path)


def test_a_fit_on_a_full_disk_is_one_error(found, tmp_path, monkeypatch):
    """HDF5, which crashes there, writes into memory."""

    def full(path, content):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(ResultError, match="cannot be written: No space left on device; make room"):
        found.save(tmp_path / "fit.nc")
    assert not [*tmp_path.iterdir()]


def test_coverage_is_measured_on_records_left_out_and_reported(found, tmp_path):
    # binomial: at least 300 trials, standard deviation 1.3 %; four of them
    assert len(found.ranks) >= 300
    assert all(x.coverage == pytest.approx(0.95, abs=0.05) for x in found.estimates)
    stored = xr.open_dataset(found.save(tmp_path / "fit.nc"))["phi"].attrs
    assert stored["coverage_of_95_percent_intervals"] == found["phi"].coverage
    brief, shown, notes = found.tables()
    assert "Experimental" in str(notes)
    assert brief.title == "In short"
    said = f"of {len(found.ranks)} simulated records that were left out"  # of which it is a share
    assert said in " ".join(str(notes).split())
    (line,) = (each for each in brief.sentences if each.startswith("With 95 % intervals: "))
    for x in found.estimates:  # each once: as known, or as not identifiable
        assert (f"{x.name.split('.')[-1]} {middle(x)} (" in line) is (x in found.known)
    shown = shown.table
    known = [row for row in shown.rows if row[1] != "not identifiable"]
    upright = str(Section("", [], shown._replace(rows=known))).splitlines()
    assert max(map(len, upright)) < 80  # no line of a usual terminal is folded


def test_a_stored_library_is_used_again(found, rig, record, copied):
    reports = []
    again = st.fit(record, rig, simulations=SIMULATIONS, library=copied, progress=reports.append)
    assert reports == [1.0]  # nothing was simulated or learned
    assert (again.estimates, again.farther) == (found.estimates, found.farther)
    kept = [*copied.glob("*/learned-*.npz")]
    assert len(kept) == 2
    for learned in kept:
        learned.write_bytes(learned.read_bytes()[:5000])  # damaged: it is learned again
    again = st.fit(record, rig, simulations=SIMULATIONS, library=copied)
    assert again.estimates == found.estimates


def test_a_library_that_was_interrupted_is_completed(rig, record, copied):
    plan = plan_for(rig, [observe(record, rig.slider).conditions])
    block = copied / f"{plan.key}-0" / "00003.npz"
    before = block.rename(block.with_suffix(".old"))
    whole = build(plan, SIMULATIONS, block.parent)
    with np.load(block) as made, np.load(before) as old:
        assert np.array_equal(made["features"], old["features"], equal_nan=True)
    assert whole.wanted == SIMULATIONS


def test_values_have_the_digits_of_their_errors(found):
    """A misalignment was "1.293e-6 to 2.282 deg", its width 143 % of the prior's."""
    phi = found["phi"]._replace(median=0.02, low=2.257e-8, high=0.03983, narrower=1.43)
    values = row(phi, "phi", "")
    assert values[1:3] == ("1.1 deg", "0 to 2.3 deg")
    assert values[4] == "as wide as the prior"
    assert row(phi._replace(narrower=0.99), "phi", "")[4] == "99 %"


def test_what_the_record_does_not_say_is_not_identifiable(found):
    """k_y swings far above the sample rate."""
    assert not found["k_y"].identified
    said = str(found.tables()[0])
    assert "Not identifiable from these records: k_y" in said


def test_a_fit_says_that_the_record_is_not_one_of_the_rig(found, rig, record, libraries):
    """A zero that is wrong by half the friction force: the estimates would be taken for true."""
    assert not found.doubts
    moved = record.model_copy(update={"force": record.force + 1.2})
    wrong = st.fit(moved, rig, simulations=SIMULATIONS, library=libraries)
    assert wrong.beyond == ["friction.mu_0", "friction.mu_inf"]
    part, table, _ = replace(wrong, farther=0.5).tables()
    assert "beyond which the records point: friction.mu_0" in part.sentences[0]
    # nothing is said of their values
    assert not any(each.startswith("friction.mu") for each in part.sentences)
    assert {row[1] for row in table.table.rows if row[0].startswith("mu")} == {"beyond its prior"}
    assert "mu_0" not in repr(wrong)
    assert "in doubt, see print(fit)" in repr(wrong)
    assert wrong.doubts[0] in str(wrong)
    assert "in doubt" not in repr(found)
    (withheld,) = replace(found, farther=0.02).tables()
    assert withheld.table is None  # values stood below a sentence that they mean nothing
    assert WITHHELD in withheld.sentences
    assert "not identifiable" not in str(withheld).lower()
    (disputed,) = replace(found, disputed="An analysis counts others.").tables()
    assert disputed.sentences[0] == "An analysis counts others."
    assert disputed.table is None
    shown = DriveOfRecords(found.rig, "It is as its displacement shows.", "It contradicts that.")
    assert "displacement" not in str(found)
    assert shown.said in str(replace(found, drive=shown))
    assert replace(found, drive=shown).doubts[0] == shown.doubt
    unlike = replace(found, farther=0.02, explanation="It paused.").tables()[0].sentences
    assert unlike[0].startswith("The records are not like those of the rig as described")
    assert unlike[0].endswith("the axis that the rig states? It paused.")


def test_a_force_of_the_other_sign_is_refused(rig, record, libraries):
    """It was fitted: "phi is 0.82 deg, 95 % interval 0.62 to 1.1"."""
    other = record.model_copy(update={"force": -record.force})
    with pytest.raises(ResultError, match=r"with the other sign, in all likelihood; fit it with"):
        st.fit(other, rig, simulations=SIMULATIONS, library=libraries)


def test_the_axis_of_the_load_cell_is_told_where_it_is_supposed(found):
    """Forces along the drive that were taken for k_x u_x: 2 of 8 intervals held phi, not 8."""
    told = "A load cell along the drive reads k_y u_y sin φ as well"
    assert told in str(found.tables()[-1])
    slider = found.plan.slider.replace(cell_angle="0 deg")
    along = replace(found, plan=found.plan._replace(slider=slider))
    assert told not in str(along)


def test_a_library_that_cannot_be_enough_is_refused_before_it_is_simulated(rig, record, tmp_path):
    """It was simulated for a minute, and refused then."""
    with pytest.raises(DescriptionError, match="simulations: must be at least 300, is 299; more"):
        st.fit(record, rig, simulations=299, library=tmp_path)
    assert [*tmp_path.iterdir()] == []


def test_too_few_cycles_of_the_record_s_length_say_so(rig, record, tmp_path, monkeypatch):
    """A record in fast cycles, and priors whose cycles last 30 times longer: "0 of 600"."""
    monkeypatch.setattr("stiction.inference.fit.FEWEST_SIMULATIONS", 30)
    soft = rig._replace(slider=rig.slider.replace(drive=st.ConstantVelocity("0.01 mm/s")))
    fast = record.model_copy(update={"drive_velocity": None, "time": record.time / 5.0})
    with pytest.raises(ResultError, match=r"no longer than 4 times the record's, 30 .* velocity"):
        st.fit(fast, soft, simulations=32, library=tmp_path)


def test_a_record_with_lost_samples_is_taken_and_one_with_large_gaps_is_not(rig, record, libraries):
    """Features change by less than they differ between the rigs of the prior."""
    plain = observe(record, rig.slider)
    plan = plan_for(rig, [plain.conditions])
    spread = build(plan, SIMULATIONS, libraries / f"{plan.key}-0").features.std(axis=0)
    lost = np.random.default_rng(1).choice(len(record.time), len(record.time) // 30, replace=False)
    lossy = without(record, lost)
    seen = observe(lossy, rig.slider)
    assert seen.conditions.step == pytest.approx(plain.conditions.step, rel=1e-9)
    assert seen.conditions.cycles == plain.conditions.cycles
    assert (np.abs(seen.features - plain.features) < spread).all()
    with pytest.raises(ResultError, match="fit a part without gaps"):
        observe(without(record, slice(200, 700)), rig.slider)


def without(record, lost):
    """Return a record without some of its samples."""
    its = {name: np.delete(getattr(record, name), lost) for name in ("time", "force")}
    return record.model_copy(update=its)


def test_the_filters_of_a_sensor_belong_to_the_conditions_of_a_record(rig, record):
    sensor = st.Sensor(filter="20 Hz", bandwidth="1 kHz", noise="4 mN")
    filtered = record.model_copy(update={"sensors": {"force": sensor}})
    (plain, seen) = (observe(each, rig.slider).conditions for each in (record, filtered))
    assert plain.noise["force"].filters == ()
    assert seen.noise["force"].filters == (LowPass(1e3, 1), LowPass(20.0, 4))
    assert plan_for(rig, [seen]).key != plan_for(rig, [plain]).key


@pytest.mark.parametrize("block", [1, 4])
def test_simulated_records_pass_the_filters_that_show_between_their_readings(rig, record, block):
    conditions = observe(record, rig.slider).conditions
    rate = 1.0 / conditions.step
    slow, fast = LowPass(0.2 * rate, 4), LowPass(10.0 * rate, 1)
    own = conditions._replace(block=block, step=block * conditions.step)
    channels = []
    for its, filters in ((conditions, ()), (own, ()), (own, (fast,)), (own, (fast, slow))):
        noise = {"force": Noise(0.0, filters=filters), "position": Noise(0.0)}
        (made,) = draw(plan_for(rig, [its._replace(noise=noise)]), 1, 0)[1]
        channels.append(made.channels)
    readings, plain, same, filtered = channels
    assert np.array_equal(same["force"], plain["force"])
    assert np.array_equal(filtered["position"], plain["position"])
    means = block_means(low_pass(readings["force"], [slow], rate), block)
    assert np.allclose(filtered["force"], means, rtol=1e-9, atol=1e-9)
    assert np.ptp(filtered["force"] - plain["force"]) > 0.05  # N: it smears the slips


def test_a_rig_that_was_turned_on_purpose_is_simulated_so(rig, record, tmp_path):
    """A design advises it; two records contradicted each other, as none said which was turned."""
    turned = record.model_copy(update={"turned": np.radians(2.0)})
    seen = [observe(each, rig.slider).conditions for each in (record, turned)]
    assert [each.yaw for each in seen] == [0.0, np.radians(2.0)]
    assert seen[1].slider_of(rig.slider).phi == rig.slider.phi + np.radians(2.0)
    path = turned.save(tmp_path / "turned.nc")
    assert st.read_record(path).turned == turned.turned
    said = st.read_record(path, turned="-3 deg")
    assert said.turned == np.radians(-3.0)
    either = st.Rig(rig.slider, {"phi": Uniform(-0.1, 0.05)})
    one, two = plan_for(either, seen[:1]), plan_for(either, seen)
    assert one.priors["phi"] == Uniform(-0.1, 0.0)  # a sign that is not seen: that of the middle
    assert two.priors["phi"] == Uniform(-0.1, 0.05)
    far = record.model_copy(update={"turned": np.radians(95.0)})
    with pytest.raises(ResultError, match=r"turned by 95 deg, to a misalignment of 96\.58 deg"):
        observe(far, rig.slider)


@pytest.mark.parametrize("deviation", [1.0, 13.0, 40.0, 60.0])
def test_a_misalignment_about_zero_has_one_sign(rig, record, deviation):
    """The median of a normal prior that ends at 90 deg is off by rounding."""
    text = TEXT.replace(
        '{low = "0.5 deg", high = "5 deg", scale = "log"}', f'"0 +- {deviation} deg"'
    )
    prior = plan_for(st.Rig.from_toml(text), [observe(record, rig.slider).conditions]).priors["phi"]
    assert (prior.low, prior.high > 0.5) == (0.0, True)


@pytest.mark.parametrize(
    ("readings", "hidden", "block"), [(20, False, 20), (20, True, 8), (3, False, 3)]
)
def test_a_record_of_many_readings_is_simulated_with_as_many(rig, readings, hidden, block):
    """Where rounding is not hidden; else the mean of eight is as good."""
    random, cycle = np.random.default_rng(3), 200 * readings
    force = 2.0 * np.tile(np.r_[np.linspace(0.4, 1.0, cycle - 8), np.linspace(0.99, 0.42, 8)], 9)
    noisy = force + (0.02 if hidden else 0.002) * random.standard_normal(len(force))
    time = 1.0 / cycle * np.arange(len(force))
    taken = {"drive_velocity": 0.5e-3, "normal_load": 4.0}
    record = st.Record(time=time, force=0.01 * np.rint(noisy / 0.01), **taken)
    conditions = observe(record, rig.slider).conditions
    assert conditions.block == block
    assert conditions.step == pytest.approx(readings / cycle, rel=1e-3)
    level = np.hypot(0.02, 0.01 / 12**0.5) if hidden else 0.002
    assert conditions.noise["force"].level == pytest.approx(level / readings**0.5, rel=0.3)


@pytest.mark.parametrize(("block", "noise"), [(8, 0.3), (20, 0.2), (100, 0.3), (300, 0.1)])
def test_means_of_rounded_readings_are_off_by_as_much_as_those_of_a_record(
    rig, record, block, noise
):
    """With an eighth of the noise in each reading rounding was not averaged away."""
    step, length = 0.02, 30
    conditions = observe(record, rig.slider).conditions._replace(cycles=6)
    exact = conditions._replace(block=8, noise={"force": Noise(0.0)})
    rounded = Noise(noise * step / block**0.5, quantisation=step)
    own = exact._replace(block=block, noise={"force": rounded})
    plain, made = (next(draw(plan_for(rig, [x]), 1, 0)[1]).channels["force"] for x in (exact, own))
    rises = np.abs(np.diff(plain))[: len(made) - 1]
    slow = np.flatnonzero(rises < np.quantile(rises, 0.8))
    off = (made - plain)[slow]
    random = np.random.default_rng(1)
    ramps = plain[slow, None] + np.diff(plain)[slow, None] * (np.arange(block) / block)
    readings = ramps + noise * step * random.standard_normal(ramps.shape)
    record_off = step * np.rint(readings / step).mean(axis=1) - ramps.mean(axis=1)
    ratio = np.std(off - np.median(off)) / np.std(record_off)
    assert len(slow) > length
    assert 0.8 < ratio < 1.25


@pytest.mark.parametrize("block", [1, 4])
def test_a_simulated_sample_is_the_mean_of_as_many_readings_as_that_of_the_record(
    rig, record, block
):
    """Each reading is rounded; a slip within a block is smeared as it is in the record."""
    conditions = observe(record, rig.slider).conditions._replace(block=block)
    fine = conditions._replace(step=conditions.step / block, block=1)
    channels = []
    for each, noise in ((conditions, 0.004), (fine, 0.004 * block**0.5)):
        for step in (0.0, 0.05):
            its = each._replace(noise={"force": Noise(noise, quantisation=step)})
            (made,) = draw(plan_for(rig, [its]), 1, 0)[1]
            channels.append(made.channels["force"])
    means, rounded_means, readings, rounded = channels
    assert np.allclose(means, block_means(readings, block), rtol=1e-12, atol=1e-12)
    assert np.array_equal(rounded, 0.05 * np.rint(readings / 0.05))
    assert np.allclose(rounded_means, block_means(rounded, block), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("stated", [False, True])
def test_rounding_that_noise_does_not_hide_is_simulated(rig, record, stated):
    sensor = st.Sensor(quantisation="30 mN") if stated else None
    for noise, hidden in ((0.003, False), (0.03, True)):
        random = np.random.default_rng(6)
        force = record.force + noise * random.standard_normal(len(record.force))
        its = {
            "force": 0.03 * np.rint(force / 0.03),
            "sensors": {"force": sensor} if stated else {},
        }
        found = observe(record.model_copy(update=its), rig.slider).conditions.noise["force"]
        assert found.quantisation == (0.0 if hidden else 0.03)
        of_rounding = 0.03 / 12**0.5 if hidden else 0.0
        assert found.level == pytest.approx(np.hypot(0.005 + noise, of_rounding), abs=0.006)
        assert found.error >= found.level


def test_the_drift_of_a_zero_belongs_to_the_conditions_of_a_record(rig, record):
    sensor = st.Sensor(zero_drift="0 +- 6 mN/min", noise="4 mN")
    drifting = record.model_copy(update={"sensors": {"force": sensor}})
    plain, seen = (observe(each, rig.slider) for each in (record, drifting))
    assert (plain.conditions.noise["force"].drift, plain.conditions.lead) == (0.0, 0.0)
    assert seen.conditions.noise["force"].drift == 1e-4
    assert seen.conditions.lead == near(seen.conditions.step * seen.cycles.before[0]) > 0.0
    priors = plan_for(rig, [seen.conditions]).priors
    assert priors["zero_drift"] == Normal(0.0, 1e-4)
    assert "zero_drift" not in plan_for(rig, [plain.conditions]).priors


def test_simulated_records_drift_as_the_zero_of_the_sensor_may(rig, record):
    """The zero is as stated a lead before the first cycle; a second record drifts by itself."""
    still = observe(record, rig.slider).conditions._replace(noise={"force": Noise(0.0)})
    still = still._replace(cycles=6)
    drifting = still._replace(noise={"force": Noise(0.0, drift=0.01)}, lead=2.5)
    plans = [plan_for(rig, [each, each]) for each in (still, drifting)]
    slopes = []
    for seed in range(3):
        scores = np.random.default_rng(seed).standard_normal(len(plans[1].priors))
        scores[:-2] = 0.0  # of a rig with cycles
        made = [
            list(synthesise(plan, own, np.random.default_rng(seed)))
            for plan, own in zip(plans, (scores[:-1], scores), strict=True)
        ]
        (plain, _), (first, second) = made
        apart = first.channels["force"] - plain.channels["force"]
        time = still.step * np.arange(len(apart))
        slope, start = np.polyfit(time, apart, 1)
        drift = plans[1].parameters(scores)["zero_drift"]
        assert drift == pytest.approx(0.01 * scores[-1], rel=1e-9)
        assert slope == pytest.approx(drift, rel=1e-9)
        begins = time[plain.cycles.before[0]] - 2.5
        assert -start / slope == pytest.approx(begins, abs=1e-9)
        scale = drifting.scale(rig.slider)
        of_each = (plain, first, second)
        rises, drops = np.transpose(
            [of_trend(still.step, x.channels["force"], scale, x.cycles) for x in of_each]
        )
        assert rises[1] - rises[0] == pytest.approx(scores[-1], rel=1e-9)
        assert drops[1] == pytest.approx(drops[0], abs=0.01)  # a slip takes 2 % of a cycle
        slopes.append((slope, 0.01 * rises[2]))
    assert all(abs(own - other) > 1e-4 for own, other in slopes)


def test_trends_are_features_only_of_a_record_whose_zero_may_drift(rig, record):
    sensor = st.Sensor(zero_drift="0 +- 6 mN/min", noise="4 mN")
    seen = observe(record.model_copy(update={"sensors": {"force": sensor}}), rig.slider)
    still = seen.conditions._replace(noise={"force": Noise(0.004)}, lead=0.0)
    channels = {"force": seen.force}
    plain = features(still.step, channels, still.scale(rig.slider), seen.cycles)
    assert len(seen.features) == len(plain) + 2
    assert np.array_equal(seen.features[: len(plain)], plain)


def test_a_trend_is_that_of_the_zero_only_as_far_as_it_is_stated():
    """Peaks of 15 cycles of 10 samples: a line of 1 % of their size, and scatter of 0.2 %."""
    random, rise = np.random.default_rng(4), np.r_[0.0:1.0:9j, 0.5]
    for slope in random.uniform(0.005, 0.02, 6) * random.choice([-1.0, 1.0], 6):
        sizes = 1.0 + 0.002 * random.standard_normal(15)
        zero = np.concatenate([rise * size for size in sizes]) + slope * np.arange(150) / 10.0
        friction = np.concatenate([rise * size * (1.0 + slope * n) for n, size in enumerate(sizes)])
        for force in (zero, friction):
            cycles = slip_cycles(force)
            assert trend(force, cycles).peaks < 0.01
            assert trend(force, cycles, 0.11 * abs(slope)).peaks > 0.05
            assert trend(force, cycles, 0.05 * abs(slope)).peaks < 0.01  # it may drift by half
        assert trend(zero, slip_cycles(zero)).drops > 0.001
        assert trend(friction, slip_cycles(friction), 1.0).drops < 0.01


def test_a_trend_that_may_be_of_the_zero_is_named(found):
    rising = replace(found, trend=Trend(1e-3, 0.5))
    for said in (rising.doubts, replace(rising, farther=0.02).doubts):
        assert 'under [sensors.force]: zero_drift = "0 +- 5 mN/min"' in said[-1]
    assert len(replace(found, farther=0.02, trend=found.trend).doubts) == 1
    for peaks in (1e-3, 0.5):
        (said,) = replace(found, trend=Trend(peaks, 1e-3)).doubts
        assert said.startswith("Friction drifts")
        assert "running in" in said
    (conditions,) = found.plan.conditions
    stated = conditions._replace(noise={"force": Noise(0.004, drift=1e-4)})
    plan = found.plan._replace(conditions=(stated,))
    assert len(replace(rising, farther=0.02, plan=plan).doubts) == 1


def test_records_of_one_rig_share_their_conditions_and_so_their_library(rig):
    """Saws of 16 cycles with a length of their own, 2 % of jitter, and times in microseconds."""
    random, alike = np.random.default_rng(8), 0
    for period in random.uniform(0.05, 3.0, 40):
        both, noise = [], 10.0 ** random.uniform(-3.0, -1.5)
        for _ in range(2):
            lengths = period * (1.0 + 0.02 * random.standard_normal(18))
            ends = np.cumsum(lengths)
            time = np.arange(0.0, ends[-1], period / 150.0)
            turn = np.searchsorted(ends, time, side="right").clip(max=17)
            phase = (time - ends[turn]) / lengths[turn] + 1.0
            force = np.where(phase < 0.9, phase, 9.0 - 9.0 * phase) + 1.0
            force += noise * random.standard_normal(len(time))
            clock = np.round(time + random.uniform(0.0, 1.0), 6)
            both.append(observe(st.Record(time=clock, force=force), rig.slider).conditions)
        alike += both[0] == both[1]
    assert alike > 20  # none without shared lengths: those, noise and counts have few values


def test_each_cycle_has_friction_of_its_own(rig):
    times = np.arange(0.0, 30.0, 0.005)
    random = np.random.default_rng(3)
    motion = move(rig.slider, times, Jitter(0.02, 1.0), random, cycle=1.4)
    force = rig.slider.k_x * motion.rows[:, 0]
    cycles = slip_cycles(force)
    peaks = np.log(force[cycles.peak])
    assert len(peaks) >= 15
    # 2 % with the uncertainty of a standard deviation from 15 values, 18 %; three of them
    assert peaks.std(ddof=1) == pytest.approx(0.02, rel=0.55)


def test_the_loading_from_rest_is_no_cycle_whatever_the_noise(rig):
    """Whether the first sample or a later one is the least is chance: the spring is unloaded."""
    made = record_of(rig.slider, 0)
    for seed in range(8):
        noise = 0.03 * np.random.default_rng(seed).standard_normal(len(made))
        seen = observe(st.Record(time=made.time, force=made.force + noise), rig.slider)
        troughs = seen.force[seen.cycles.before]
        assert troughs.min() > 0.2 * seen.force.max()  # a slip does not unload the spring
        mean = np.mean(seen.cycles.after - seen.cycles.before) * seen.conditions.step
        # the loading from rest takes twice as long, of at most 8 cycles: 1.58 s would be 1.8, not
        # 1.5, the value below; jitter is 0.5 %
        assert seen.conditions.cycle == near(mean) == 1.5


def test_without_jitter_a_record_is_that_of_one_run(rig):
    """The restarts at troughs leave no trace beyond the solver's tolerance.

    Square on, where slips do not depend on the phase of a transverse oscillation.
    """
    slider = rig.slider.replace(phi="0 deg")
    times = np.arange(0.0, 8.0, 0.01)
    motion = move(slider, times, Jitter(0.0, 0.0), np.random.default_rng(0), cycle=1.4)
    run = st.simulate(slider, duration=float(times[-1]), sample_rate=100.0)
    force = slider.k_x * motion.rows[:, 0]
    plain = run.data["spring_x"].values[: len(force)]
    assert len(motion.troughs) >= 3
    # a relative error of 1e-4 shifts each slip by 1e-4 of a cycle, 0.2 ms of the 25 ms of a fall
    assert np.abs(force - plain).max() < 0.01 * plain.max()


def test_a_name_that_several_parameters_share_is_refused(found):
    """Each of several springs has a k_x; the first was taken."""
    names = {"k_x": "springs.arm.k_x", "k_y": "springs.cell.k_x"}
    estimates = (x._replace(name=names.get(x.name, x.name)) for x in found.estimates)
    both = replace(found, estimates=tuple(estimates))
    assert both["springs.cell.k_x"].median == found["k_y"].median
    rows = {row[0] for row in both.tables()[1].table.rows}
    assert rows == {"phi", *names.values(), "mu_0", "mu_inf", "jitter"}
    with pytest.raises(ResultError, match=r"several parameters: springs\.arm\.k_x, springs\.cell"):
        both["k_x"]


LAWS = st.laws
EXPONENTIAL = LAWS.ExponentialWeakening(mu_0=0.6, mu_inf=0.35, v_f=0.01)
FITTED = {
    "stribeck": LAWS.Stribeck(mu_s=0.6, mu_c=0.35, v_s=0.01, c=0.1),
    "two-exponentials": LAWS.TwoExponentials(mu_inf=0.35, mu_1=0.1, v_1=0.01, mu_2=0.15, v_2=0.05),
    "anisotropic": LAWS.Anisotropic(law=EXPONENTIAL, ratio=1.2),
}


@pytest.mark.parametrize("name", FITTED)
def test_laws_without_states_are_fitted_whatever_their_coefficients_are_called(rig, name):
    """Stribeck's law lacks `mu_0`: it was "not fitted", while the guide said that it is."""
    other = rig._replace(slider=rig.slider.replace(friction=FITTED[name]))
    priors = {path: its for path, its in rig.priors.items() if not path.startswith("friction.")}
    other = other._replace(priors=priors | {"jitter": Uniform(0.01, 0.03)})
    check(other)
    seen = observe(record_of(rig.slider, 7, channels=("force",)), rig.slider)
    _, [made] = draw(plan_for(other, [seen.conditions]), 1, 0)
    drops = made.channels["force"][made.cycles.peak] - made.channels["force"][made.cycles.after]
    assert np.ptp(drops) > 0.005 * drops.mean()  # its coefficients differ from cycle to cycle


@pytest.mark.parametrize(
    ("law", "lacks"),
    [
        (LAWS.Table(v=["0 m/s", "1 mm/s"], mu=[0.6, 0.4], mu_static=0.7), "it has no coefficient"),
        (LAWS.LuGre(0.2, 0.3, 0.01, 1e5, 300.0), "it has internal states"),
    ],
)
def test_other_laws_are_refused_with_the_reason(rig, law, lacks):
    with pytest.raises(DescriptionError) as error:
        check(rig._replace(slider=rig.slider.replace(friction=law)))
    assert f"{type(law).__name__} is not fitted, as {lacks}" in str(error.value)
    assert "power-law-weakening, stribeck, two-exponentials, or one of your own" in str(error.value)
    remedy = "`st.mechanism`) say whether the record is like rate and state or LuGre"
    assert (remedy in str(error.value)) is (lacks == "it has internal states")


def test_a_record_without_cycles_is_refused(rig):
    flat = st.Record(time=np.arange(100.0), force=np.ones(100))
    with pytest.raises(ResultError, match=r"record 1 has 0 whole cycles .* needs 6"):
        st.fit(flat, rig)


def test_a_rig_without_priors_is_refused(record):
    with pytest.raises(DescriptionError, match="nothing is uncertain"):
        st.fit(record, st.Rig(st.presets.nakano_popov_2020(), {}))


def test_no_time_of_a_part_lies_beyond_its_end():
    """A run from the first to the last time ends before the last one in some, by rounding."""
    random, short = np.random.default_rng(0), 0
    for _ in range(1000):
        times = random.uniform(1e-3, 1e-2) * np.arange(400.0)
        begin = int(random.integers(1, 200))
        duration, part = stretch(times, begin, 399)
        assert part[-1] <= times[begin] + duration
        np.testing.assert_allclose(part, times[begin:], rtol=1e-15)
        short += times[begin] + duration < times[399]
    assert short > 0


def test_a_record_of_coefficients_takes_the_load_of_its_rig(record, rig, tmp_path):
    """A record of F/W was refused, though the description of its rig stated W."""
    path, beside = tmp_path / "data.csv", tmp_path / "data.toml"
    rows = np.column_stack([record.time, record.force / 4.0])
    np.savetxt(path, rows, "%.9g", ",", header="t (s),F/W (-)", comments="")
    load = load_of_records(rig)
    own = read_source(path, rig_load=load)
    assert own.normal_load == load == 4.0
    np.testing.assert_allclose(own.force, record.force, rtol=1e-8)
    assert "the normal load is that of the rig's description" in own.origin.notes
    (seen,) = observe_all(read_all(path, load), rig.slider)
    assert seen.conditions.normal_load == 4.0
    with pytest.raises(st.ResultError, match="if the load is unknown, 1 N: forces are then"):
        st.read_record(path)
    uncertain = st.Rig.from_toml(rig.to_toml().replace('"4 N"', '"4 +- 0.5 N"'))
    for unclear in (
        uncertain,
        Rig(rig.slider.replace(load=st.protocols.load_ramp(["2 N", "4 N"], ramp="1 s")), {}),
    ):
        with pytest.raises(st.ResultError, match="states none for certain: say normal_load="):
            read_source(path, rig_load=load_of_records(unclear))
    assert read_source(path, rig_load=load, normal_load="2 N").normal_load == 2.0
    beside.write_text('[record]\nnormal_load = "3 N"\n')
    stated = read_source(path, rig_load=load)
    assert stated.normal_load == 3.0  # what is said of the record comes before the rig
    assert "that of the rig" not in str(stated.origin)


def test_a_record_is_taken_from_its_file_and_from_a_run(record, rig, tmp_path):
    """A path was "must be a Record or a sequence, is 'data.csv'", though audits take one."""
    path = tmp_path / "data.csv"
    rows = np.column_stack([record.time, record.force])
    np.savetxt(path, rows, "%.9g", ",", header="t (s),F (N)", comments="")
    plain = observe(st.read_record(path), rig.slider)
    for given in (path, str(path), [path]):
        (seen,) = observe_all(read_all(given, 4.0), rig.slider)
        assert seen.conditions == plain.conditions
        np.testing.assert_array_equal(seen.features, plain.features)
    run = st.simulate(rig.slider, "1 ms", sample_rate="1 kHz")
    with pytest.raises(st.ResultError, match="record 1"):  # of too few samples
        observe_all(read_all(run, 4.0), rig.slider)
    with pytest.raises(st.StictionError, match="a record, a run or a path or a sequence, is 5"):
        st.fit(5, rig)


def test_a_record_of_steady_sliding_is_not_said_to_be_too_short():
    """The remedy was to record for longer, or slower: no stick-slip ever came."""
    slider = st.presets.nakano_popov_2020().replace(phi="12 deg", friction=st.Coulomb(0.2))
    run = st.simulate(slider, "10 s", sample_rate="200 Hz")
    noise = 2e-3 * np.random.default_rng(1).normal(size=len(run.samples["time"]))
    record = st.Record(
        time=run.samples["time"], force=run.samples["spring_x"] + noise, normal_load=10.0
    )
    with pytest.raises(st.ResultError, match=r"shows no stick-slip.*it is settling"):
        observe(record, slider)
