"""Figures of friction tests by name: they show what the analyses found."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from stiction.analysis.protocols.healing import Healing
from stiction.analysis.protocols.hysteresis import Hysteresis, Loop
from stiction.analysis.protocols.load_dependence import LoadDependence
from stiction.analysis.protocols.step_findings import VelocityStep, VelocitySteps
from stiction.analysis.protocols.yaw import ApparentFriction


@pytest.fixture
def ax():
    return Figure().subplots()


def text(ax):
    return " ".join(each.get_text() for each in ax.get_legend().get_texts())


def test_healing_is_points_and_their_line(ax):
    hold = np.array([1.0, 10.0, 100.0])
    gain = np.array([0.01, 0.03, 0.05])
    found = Healing(hold, np.full(3, 0.6), 0.6 + gain, np.full(3, 0.5), 0.02, 1e-4, 0.01)
    assert found.plot(ax) is ax
    points, line = ax.lines
    assert points.get_ydata() == pytest.approx(gain)
    assert line.get_ydata() == pytest.approx([0.01, 0.05])
    assert "0.0200 ± 0.0001 per decade" in text(ax)


def test_velocity_steps_are_data_and_fit(ax):
    slip = np.linspace(0.0, 1e-4, 20)
    mu = 0.6 + 0.01 * np.exp(-slip / 1e-5)
    step = VelocityStep(
        1.0, 1e-6, 1e-5, 0.59, 0.6, 0.61, 0.01, 0.02, -0.01, 1e-5, 1e-8, slip, mu, mu
    )
    VelocitySteps((step,), 1e3).plot(ax)
    data, fit = ax.lines[:2]
    assert data.get_xdata() == pytest.approx(1e6 * slip)
    assert fit.get_ydata() == pytest.approx(mu)
    assert ax.get_xlim() == pytest.approx((0.0, 80.0))
    assert "1 µm/s to 10 µm/s" in text(ax)


def test_a_loop_is_closed_and_shaded(ax):
    travel, force = np.array([0.0, -1e-3, 0.0]), np.array([1.0, -1.0, 1.0])
    Hysteresis((Loop(travel, force, 2e-3, 1e-3, 0.1),)).plot(ax)
    assert len(ax.patches) == 1
    assert ax.lines[0].get_xdata() == pytest.approx([0.0, -1.0, 0.0])
    assert "2 mJ" in text(ax)


def test_friction_over_load_is_points_and_their_line(ax):
    load = np.array([10.0, 20.0, 30.0])
    found = LoadDependence(load, 1.0 + 0.3 * load, 0.3, 1e-3, 1.0)
    found.plot(ax)
    points, line = ax.lines
    assert points.get_ydata() == pytest.approx([4.0, 7.0, 10.0])
    assert line.get_xydata().ravel() == pytest.approx([0.0, 1.0, 30.0, 10.0])
    assert "slope 0.3" in text(ax)


def test_apparent_friction_has_peak_mean_and_steady_sliding(ax):
    phi = np.radians([0.0, 10.0, 20.0])
    steady = 0.3 * np.cos(phi)
    of_steady = steady, np.full(3, 0.3)
    found = ApparentFriction(phi, steady, steady + 0.02, np.full(3, 0.01), *of_steady)
    found.plot(ax)
    assert [line.get_ydata()[0] for line in ax.lines] == pytest.approx([0.32, 0.3, 0.3])
    assert ax.lines[0].get_xdata() == pytest.approx([0.0, 10.0, 20.0])
    assert "peak" in text(ax)
