"""Values of a study in any order: what is drawn and refined is that of the values in order."""

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction.plotting.maps import draw_measure
from stiction.study.execution.refine import changes
from stiction.study.variables.kinds import KINDS
from stiction.study.view.mapping import in_order, side

BASE = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="20 ms"))
ANGLES, SPEEDS = [1.0, 5.0, 6.0, 12.0], [-3e-3, 0.0, 1e-3, 2e-3]


def study_of(angles, speeds):
    axes = {
        "phi": st.Values([f"{each} deg" for each in angles]),
        "drive.velocity": st.Values(list(speeds)),
    }
    return st.Study(base=BASE, axes=axes, measures=["peak_force", "regime"])


def shuffle(values, seed):
    return np.random.default_rng(seed).permutation(values).tolist()


@pytest.fixture(scope="module", params=[None, 1, 2])
def found(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("order") / "a.zarr"
    orders = [ANGLES, SPEEDS]
    if request.param is not None:
        orders = [shuffle(each, request.param) for each in orders]
    st.sweep(study_of(*orders), path)
    return st.map(path, "peak_force")


def test_each_cell_of_a_map_has_the_value_of_its_run(found):
    import matplotlib.pyplot as plt

    view = in_order(found.view)
    x, y = side(view, "phi"), side(view, "drive.velocity")
    assert (np.diff(x.edges) > 0.0).all()
    assert (np.diff(y.edges) > 0.0).all()
    np.testing.assert_allclose(x.values, ANGLES)
    _, ax = plt.subplots()
    mesh, _ = draw_measure(ax, x, y, view.data["peak_force"].values, "force")
    for i, angle in enumerate(ANGLES):
        for j, speed in enumerate(SPEEDS):
            run = found.data["peak_force"].sel({"phi": angle, "drive.velocity": speed})
            assert mesh.get_array()[j, i] == float(run)


def test_the_drawn_map_holds_all_values(found):
    (ax,) = found.plot()
    assert ax.get_xlim() == pytest.approx((1.0, 12.0))
    assert ax.get_ylim() == pytest.approx((-3.0, 2.0))


def test_the_store_keeps_the_order_that_was_asked_for(found):
    np.testing.assert_array_equal(found.data["phi"], found.view.study.coordinates["phi"].values)


def test_an_axis_along_one_that_lies_along_another_is_refused():
    """Twelve runs became 144, of which the angle of all in a column was not that of its name."""
    axes = {
        "phi": st.Sobol("1 deg", "3 deg", 4),
        "normal_load": st.Random("5 N", "10 N", 4, along="phi"),
    }
    with pytest.raises(st.DescriptionError, match=r"normal_load.along: is 'phi', which lies along"):
        st.Study(base=BASE, axes=axes, measures=["regime"])


@pytest.mark.parametrize("seed", range(20))
def test_changes_lie_between_neighbouring_values(seed):
    """Of random kinds: the intervals are those of the study whose values ascend."""
    random = np.random.default_rng(seed)
    kinds = random.integers(-1, len(KINDS), (4, 4))
    intervals = []
    for angles in (ANGLES, shuffle(ANGLES, seed)):
        places = [ANGLES.index(each) for each in angles]
        data = xr.Dataset({"regime": (("phi", "drive.velocity"), kinds[places])})
        its = changes(study_of(angles, SPEEDS), data, "phi", None)
        rows = zip(
            its.low["phi"], its.high["phi"], its.low["drive.velocity"], its.below, its.above,
            strict=True,
        )  # fmt: skip
        intervals.append(sorted(rows))
    assert intervals[0] == intervals[1]
    assert all(low < high for low, high, *_ in intervals[0])
