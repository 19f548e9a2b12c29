"""Changes within a record: a drive that turns or changes its speed, cycles of another kind."""

import numpy as np
import pytest

import stiction as st

RIG = {"normal_load": 10.0, "stiffness": 1e3, "drive_velocity": 1e-3}


def pull_of(travel, static=2.0, kinetic=1.5):
    """Return the force of a mass that slips at once to beyond its kinetic friction, N."""
    force, pulls = np.zeros(len(travel)), 0.0
    for i, step in enumerate(np.diff(travel, prepend=0.0)):
        pulls += 1e3 * step
        if abs(pulls) >= static:
            pulls = np.sign(pulls) * (2.0 * kinetic - static)
        force[i] = pulls
    return force


@pytest.mark.parametrize("mass", [None, 0.25])
@pytest.mark.parametrize("slips", [0, 1, 2, 6])
def test_strokes_have_no_friction_in_one_number(slips, mass):
    """It said: kinetic friction -0.136 N, or a zero that is off, or a wrong mass."""
    length = 1.0 if slips == 0 else 4.0 + slips - 0.5  # mm
    time = np.arange(0.0, 6.5 * length, 4e-3)
    travel = 1e-3 * np.abs((time + 0.5 * length) % (2.0 * length) - length)
    travel = 0.5e-3 * length - travel
    noise = 1e-2 * np.random.default_rng(slips).standard_normal(len(time))
    record = st.Record(time=time, force=pull_of(travel) + noise, mass=mass, **RIG)
    found = st.analyse(record)
    assert found.regime.kind == "undetermined"
    assert found.friction[:3] == (None, None, None)
    assert found.warnings == ()
    assert np.isnan(found.summary["mean"].sel(quantity="slip_distance"))
    moved = record.model_copy(update={"drive_position": travel, "stiffness": None})
    assert "back and forth" in str(st.analyse(moved))
