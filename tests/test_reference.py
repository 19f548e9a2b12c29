"""Fig. 3's system against the project's reference values, which two methods agree on."""

import numpy as np
import pytest

import stiction as st


def turning_points(run: st.Trajectory) -> tuple[tuple[float, float], tuple[float, float]]:
    """Time and force of the first peak and of the trough after it."""
    time, force = run.data["time"].values, run.data["spring_x"].values
    peak = int(force[time < 2.5].argmax())
    trough = peak + int(force[peak : peak + 3000].argmin())
    return (time[peak], force[peak]), (time[trough], force[trough])


def test_reaches_its_duration(paper_run):
    assert paper_run.status is st.Status.COMPLETED
    assert paper_run.data.sizes["time"] == 50001
    assert paper_run.data["time"].values[[0, 1, -1]] == pytest.approx([0, 1e-4, 5], abs=1e-15)


def test_final_state(paper_run, sharp_run):
    # half a unit of the last digit given; the default promises 1e-6
    assert float(sharp_run.final["u_x"]) == pytest.approx(1.3305693378e-3, rel=4e-11 + 1e-10)
    assert float(sharp_run.final["u_y"]) == pytest.approx(1.474023e-7, abs=5e-14)
    assert float(paper_run.final["u_x"]) == pytest.approx(1.3305693378e-3, rel=1e-6)


def test_sticks(paper_run, sharp_run):
    first = 1e3 * paper_run.sticks[0, 1]
    assert first == pytest.approx(11.4595, abs=5.1e-5)  # 11.459549...: rounded in its last digit
    assert len(paper_run.sticks) == len(sharp_run.sticks) == 2959
    assert sharp_run.statistics.time_stuck == pytest.approx(0.323110, abs=5e-7)


def test_cycle(paper_run):
    (peak_time, peak), (trough_time, trough) = turning_points(paper_run)
    assert peak == pytest.approx(1.9926, abs=5e-5)
    assert peak_time == pytest.approx(2.0321, abs=1e-4)  # one sample
    assert trough == pytest.approx(1.1686, abs=5e-5)
    assert trough_time == pytest.approx(2.0905, abs=1e-4)
    time, force = paper_run.data["time"].values, paper_run.data["spring_x"].values
    second = np.flatnonzero((time > 2.5) & (time < 3.3))
    assert time[second[force[second].argmax()]] - peak_time == pytest.approx(0.9151, abs=2e-4)


def test_largest_velocity(slider, sharp_run):
    # the peak is broader than a sample; a restart resolves it
    coarse = float(sharp_run.data["time"][int(sharp_run.data["V_X"].values.argmax())])
    fine = st.simulate(
        slider, 4e-3, sample_rate=1e6, rtol=1e-10, initial=sharp_run.state(coarse - 2e-3)
    )
    assert 1e3 * float(fine.data["V_X"].max()) == pytest.approx(26.284, abs=5e-4)


def test_constant_friction(slider):
    run = st.simulate(slider.replace(friction=st.Coulomb(mu_0=0.2)), 10.0, sample_rate=10e3)
    assert len(run.sticks) == 1  # only the first
    assert float(run.final["spring_x"]) == pytest.approx(2 * np.cos(np.pi / 180), abs=1e-6)
    assert 1e3 * float(run.data["V_X"].max()) == pytest.approx(1.6124, abs=5e-5)


def test_rtol_means_something(slider, sharp_run):
    """Each decade of rtol buys a decade of accuracy, over six decades and more."""
    tolerances = 10.0 ** -np.arange(3, 11)
    errors = []
    for rtol in tolerances:
        run = st.simulate(slider, 5.0, sample_rate=1e3, rtol=rtol)
        same = sharp_run.data.sel(time=run.data["time"], method="nearest")
        errors.append(np.abs(run.data["spring_y"].values - same["spring_y"].values).max())
    errors = np.array(errors)
    # the transverse force (2 N) holds the micro stick-slip: it is what is hard to get right
    assert np.all(errors[1:] < 0.5 * errors[:-1])
    slope = np.polyfit(np.log10(tolerances), np.log10(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.15)
    assert errors[-1] < 1e-6 * errors[0]


def test_samples_do_not_influence_the_run(slider, paper_run):
    other = st.simulate(slider, 5.0, sample_rate=777.0)
    assert np.array_equal(other.sticks, paper_run.sticks)
    assert other.statistics == paper_run.statistics
    shared = st.simulate(slider, 5.0, sample_rate=100.0)
    for name in ("u_x", "u_y", "slip_x", "slip_y", "friction", "theta"):
        assert np.array_equal(shared.data[name].values, paper_run.data[name].values[::100])
