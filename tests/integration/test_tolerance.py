"""Fig. 3's system: the meaning of a tolerance, and samples that change nothing.

The reference values are among the verification cases.
"""

import numpy as np
import pytest

import stiction as st


def test_reaches_its_duration(paper_run):
    assert paper_run.status is st.Status.COMPLETED
    assert paper_run.data.sizes["time"] == 50001
    assert paper_run.data["time"].values[[0, 1, -1]] == pytest.approx([0, 1e-4, 5], abs=1e-15)


def test_the_default_tolerance_keeps_its_promise(paper_run, sharp_run):
    exact = float(sharp_run.final["u_x"])
    assert float(paper_run.final["u_x"]) == pytest.approx(exact, rel=1e-6)
    assert len(paper_run.stick_intervals) == len(sharp_run.stick_intervals)


def test_rtol_means_something(slider, sharp_run):
    """Each decade of rtol buys a decade of accuracy in steps, over six decades."""
    tolerances = 10.0 ** -np.arange(3, 12)
    errors = []
    for rtol in tolerances:
        run = st.simulate(slider, 5.0, sample_rate=1e3, rtol=rtol, multiscale=False)
        same = sharp_run.data.sel(time=run.data["time"], method="nearest")
        errors.append(np.abs(run.data["spring_y"].values - same["spring_y"].values).max())
    errors = np.array(errors)
    # the transverse force (2 N) holds the micro stick-slip: it is what is hard to get right
    assert np.all(errors[1:] < errors[:-1])
    slope = np.polyfit(np.log10(tolerances[2:]), np.log10(errors[2:]), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.15)
    assert errors[-1] < 1e-5 * errors[2]
    # at the loosest, no step is longer than the swing allows, which is better than asked for
    assert np.all(errors[:2] < errors[2] * tolerances[:2] / tolerances[2])


@pytest.mark.parametrize(
    ("phi", "rtol"), [(9.04, 1e-2), (9.055, 1e-2), (8.8, 5e-3), (9.13, 5e-3), (8.665, 2e-3)]
)
def test_steady_sliding_near_its_onset_stays_steady(slider, phi, rtol):
    """Steps of nearly a period of the slow spring, in which a defect may vanish by chance."""
    system = slider.replace(phi=f"{phi} deg")
    run, sharp = (st.simulate(system, 5.0, sample_rate=500, rtol=r) for r in (rtol, 1e-9))
    off = abs(run.data["spring_x"] - sharp.data["spring_x"])
    assert float(off.max()) < rtol * float(sharp.data["spring_x"].max())


def test_samples_do_not_influence_the_run(slider, paper_run):
    other = st.simulate(slider, 5.0, sample_rate=777.0)
    assert np.array_equal(other.stick_intervals, paper_run.stick_intervals)
    assert other.statistics == paper_run.statistics
    shared = st.simulate(slider, 5.0, sample_rate=100.0)
    for name in ("u_x", "u_y", "slip_x", "slip_y", "friction", "theta"):
        assert np.array_equal(shared.data[name].values, paper_run.data[name].values[::100])
