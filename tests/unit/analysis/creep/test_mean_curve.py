"""The mean creep curve of a record: its stiffness, when it is backward, and its further errors."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction.analysis.creep import mean_curve as module
from stiction.analysis.creep.mean_curve import calibrate, mean_curve, with_base, with_rounding
from stiction.errors import ResultError
from stiction.recording.noise import rounding_error

V, STIFFNESS = 1e-3, 1e3
TIME = np.linspace(0.0, 1.0, 1001)
NONE = np.zeros(4)


def record_of(force=TIME, **known):
    return st.Record(
        time=TIME, force=force, **{"stiffness": STIFFNESS, "drive_velocity": V, **known}
    )


def mean_of(velocity, error=NONE):
    """Return mean creep in bins of 0.1 s, from the slip on."""
    velocity = np.asarray(velocity, dtype=float)
    end = 0.1 * np.arange(len(velocity))
    columns = {"begin": end + 0.1, "end": end, "velocity": velocity, "velocity_error": error}
    return xr.Dataset({name: ("bin", np.asarray(each)) for name, each in columns.items()})


def cycles_of(stiffness=(), peak=(1.0, 1.0)):
    return xr.Dataset({"stiffness": ("a", np.array(stiffness)), "peak": ("b", np.array(peak))})


@pytest.fixture
def mean_or_refusal(monkeypatch):
    """Return a function that passes a mean curve, or says why it is refused."""

    def result(mean, record, stated=None):
        monkeypatch.setattr(module, "mean_creep", lambda curves: mean)
        curves = xr.Dataset({"velocity": (("phase", "bin"), np.ones((2, 4)))})
        try:
            assert mean_curve(curves, record, stated or record) is mean
        except ResultError as error:
            return str(error)
        return ""

    return result


@pytest.mark.parametrize(
    ("seen", "taken"),
    [
        ([900.0, 950.0, 1200.0, np.nan], 950.0),
        ([np.nan, np.nan], STIFFNESS),
        ([], STIFFNESS),
        ([-900.0, -950.0, 1200.0], STIFFNESS),  # no spring
    ],
)
def test_the_stiffness_is_the_median_of_that_of_the_loadings_if_it_is_one(seen, taken):
    assert calibrate(record_of(), cycles_of(seen)).stiffness == taken


def test_the_stiffness_is_the_fitted_one_and_as_stated_where_the_position_shows_creep():
    fitted = SimpleNamespace(stiffness=970.0)
    assert calibrate(record_of(), cycles_of([900.0]), fitted).stiffness == 970.0
    placed = record_of(position=TIME)
    assert calibrate(placed, cycles_of([900.0]), fitted) is placed


def test_creep_is_backward_where_more_than_a_quarter_of_it_is_beyond_its_error(mean_or_refusal):
    one, two = [-0.03 * V, 0.0, 0.0, 0.0], [-0.03 * V, -0.03 * V, 0.0, 0.0]
    assert mean_or_refusal(mean_of(one), record_of()) == ""
    assert "would creep against the drive" in mean_or_refusal(mean_of(two), record_of())
    assert mean_or_refusal(mean_of(two), record_of(position=TIME)) == ""
    slightly = [-0.019 * V] * 4
    assert mean_or_refusal(mean_of(slightly), record_of()) == ""
    unsure = mean_of(two, [0.006 * V] * 4)  # two errors and a fiftieth of V are more
    assert mean_or_refusal(unsure, record_of()) == ""
    assert mean_or_refusal(mean_of(two, [0.004 * V] * 4), record_of()) != ""


def test_creep_that_is_not_backward_with_the_stated_stiffness_is_none(mean_or_refusal):
    """A spring seen 5 % softer makes 0.05 V of the loading creep."""
    backward = mean_of([-0.03 * V] * 4)
    softer = record_of(stiffness=0.95 * STIFFNESS)
    assert mean_or_refusal(backward, softer, record_of()) == ""
    assert mean_or_refusal(backward, softer, softer) != ""


def test_steps_of_a_hundredth_of_the_range_hide_creep(mean_or_refusal):
    backward = mean_of([-0.1 * V] * 4)
    for step, said in ((0.02, "recorded in steps of 20 mN"), (0.005, "against the drive")):
        coarse = record_of(np.rint(TIME / step) * step)
        assert said in mean_or_refusal(backward, coarse)


def test_the_error_has_the_difference_of_the_stiffnesses():
    own = np.array([0.0, 3e-5, np.nan, 4e-5])
    softer, mean = record_of(stiffness=0.96 * STIFFNESS), mean_of(NONE, own)
    found = with_base(mean, softer, record_of())["velocity_error"].values
    np.testing.assert_allclose(found, np.hypot(np.nan_to_num(own), 0.04 * V))
    for known, stated in (
        (record_of(position=TIME, stiffness=900.0), record_of()),
        (softer, record_of(stiffness=None)),
    ):
        assert with_base(mean, known, stated) is mean


@pytest.mark.parametrize(
    ("creep", "passed"),
    [(0.0, 5.0), (0.9 * V, 1.0)],  # steps that the force passes in half a bin; one at least
)
def test_the_error_has_the_steps_of_the_force_the_less_the_more_it_passes(creep, passed):
    step = 0.01
    record = record_of(np.rint(TIME / step) * step)
    mean = mean_of([creep] * 4)
    one_code = with_rounding(mean, record, cycles_of())["velocity_error"].values
    place = rounding_error(record.force, step) / STIFFNESS
    np.testing.assert_allclose(one_code, 8.0**0.5 * place / 0.1 / passed, rtol=1e-6)
    two = cycles_of(peak=(1.0, 1.0 + step))  # two codes of one height
    assert with_rounding(mean, record, two)["velocity_error"].values == pytest.approx(one_code)
    many = cycles_of(peak=(1.0, 1.0 + 4.0 * step))  # then each is rounded by itself
    assert (with_rounding(mean, record, many)["velocity_error"].values < 1e-6 * one_code).all()


def test_a_force_without_steps_or_with_a_position_has_no_such_error():
    mean, random = mean_of(NONE), np.random.default_rng(1)
    assert with_rounding(mean, record_of(TIME + random.normal(size=1001)), cycles_of()) is mean
    placed = record_of(np.rint(TIME / 0.01) * 0.01, position=TIME)
    assert with_rounding(mean, placed, cycles_of()) is mean
