"""The drive velocity that the displacement of the drive shows, in place of a stated one."""

import re

import numpy as np
import pytest
from tests.uncertain import TEXT, record_of

import stiction as st
from stiction.drive.program import nominal_velocity
from stiction.inference.measured.drive_of_records import with_measured_drive
from stiction.inference.observation import VELOCITY, observe

STATED = 0.5e-3  # m/s, of the rig
UNCERTAIN = TEXT.replace('"0.5 mm/s"', '"0.5 +- 0.05 mm/s"')


def with_drive(record, velocity, *, noise=1e-7, seed=1, gain_error=0.0, **changes):
    """Return a record with the displacement of a drive of that velocity, m/s."""
    random = np.random.default_rng(seed)
    way = velocity * record.time + noise * random.standard_normal(len(record))
    sensors = {"drive_position": st.Sensor(unit="m", gain_uncertainty=gain_error)}
    its = {"time": record.time, "force": record.force, "normal_load": 4.0, "drive_position": way}
    return st.Record(**its, **({"sensors": sensors} if gain_error else {}), **changes)


def velocity_prior(found, shares=(0.025, 0.5, 0.975)):
    return found.rig.priors[VELOCITY].quantile(np.array(shares))


@pytest.mark.parametrize("stated", [{}, {"drive_velocity": STATED}])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_fit_takes_the_velocity_that_the_drive_shows(rig, record, stated, way):
    """A certain 0.5 mm/s was taken, and the difference was found in the stiffness."""
    its = with_drive(record, way * 0.525e-3, **stated)
    found = with_measured_drive(rig, [its])
    assert nominal_velocity(found.rig.slider.motion) == pytest.approx(0.525e-3, rel=1e-4)
    assert observe(its, found.rig.slider).conditions.velocity == pytest.approx(0.525e-3, rel=1e-4)
    assert re.search(r"its displacement shows: 52[45]\S* .* \(stated: 500 µm/s\)", found.said)
    assert not found.doubt


def test_a_velocity_that_agrees_or_is_not_measured_remains_as_stated(rig, record):
    uncertain = st.Rig.from_toml(UNCERTAIN)
    for its in (
        record,
        with_drive(record, 0.5e-3 * np.sin(record.time)),
    ):  # without, and to and fro
        assert with_measured_drive(rig, [its]).rig == rig
        assert with_measured_drive(uncertain, [its]).rig == uncertain
    agrees = with_measured_drive(rig, [with_drive(record, STATED)])
    assert (agrees.rig, agrees.said, agrees.doubt) == (rig, "", "")
    assert observe(with_drive(record, STATED), rig.slider).conditions.velocity == STATED


def test_a_velocity_that_is_measured_narrows_the_prior_to_its_error(record):
    uncertain = st.Rig.from_toml(UNCERTAIN)
    found = with_measured_drive(uncertain, [with_drive(record, 0.53e-3)])
    low, middle, high = velocity_prior(found)
    assert low < 0.53e-3 < high
    assert middle == pytest.approx(0.53e-3, rel=1e-3)
    assert high - low < 0.005 * middle  # stated: 40 %
    rough = with_measured_drive(uncertain, [with_drive(record, 0.53e-3, gain_error=0.02)])
    low, middle, high = velocity_prior(rough)
    assert (high - low) / middle == pytest.approx(4.0 * 0.02, rel=0.1)
    worse = with_drive(record, 0.53e-3, gain_error=0.2)
    assert with_measured_drive(uncertain, [worse]).rig == uncertain


def test_a_displacement_in_another_unit_is_doubted(rig, record):
    found = with_measured_drive(rig, [with_drive(record, 1e-3 * STATED, noise=0.0)])
    assert "contradicts the velocity as stated" in found.doubt


def test_the_velocity_lies_within_the_prior_as_often_as_it_says(record):
    """Of random drives, noise, and gains of the sensor; 95 % intervals."""
    random, rig = np.random.default_rng(61), st.Rig.from_toml(UNCERTAIN)
    inside = []
    for number in range(120):
        velocity = STATED * np.exp(0.08 * random.standard_normal())
        error = float(random.choice([0.002, 0.01]))
        shown = velocity * (1.0 + error * random.standard_normal())
        noise = 10.0 ** random.uniform(-8.0, -5.0)
        its = with_drive(record, shown, noise=noise, seed=number, gain_error=error)
        low, _, high = velocity_prior(with_measured_drive(rig, [its]))
        inside.append(low <= velocity <= high)
    assert np.mean(inside) > 0.95 - 3.0 * (0.05 * 0.95 / len(inside)) ** 0.5


def test_records_at_several_velocities_keep_their_own(rig, record):
    slider = rig.slider.replace(phi="2.5 deg")
    both = [
        with_drive(record, 0.525e-3),
        with_drive(record_of(slider, 9, channels=("force",)), 0.51e-3),
    ]
    found = with_measured_drive(rig, both)
    velocities = [observe(each, found.rig.slider).conditions.velocity for each in both]
    assert velocities == pytest.approx([0.525e-3, 0.51e-3], rel=1e-3)
    half = with_measured_drive(rig, [both[0], record])  # of one it is not known
    assert half.rig == rig
    assert observe(both[0], half.rig.slider).conditions.velocity == pytest.approx(
        0.525e-3, rel=1e-3
    )
