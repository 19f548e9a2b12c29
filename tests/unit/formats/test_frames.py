"""Tables in memory: each is read like the same numbers in a file."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stiction as st

TIME = np.arange(0.0, 2.0, 0.01)
FORCE = 0.1 * (TIME % 0.5)
DATES = pd.to_datetime("2026-03-01") + pd.to_timedelta(TIME, unit="s")


def with_units(table, **units):
    table.attrs["units"] = units
    return table


@pytest.mark.parametrize(
    "table",
    [
        pd.DataFrame({"t [ms]": 1e3 * TIME, "Fx [mN]": 1e3 * FORCE}),
        with_units(pd.DataFrame({"time": TIME, "force": FORCE}), time="s", force="N"),
        pd.DataFrame({"Fx [mN]": 1e3 * FORCE}, pd.Index(TIME, name="time [s]")),
        pd.DataFrame({"Fx [mN]": 1e3 * FORCE}, DATES),
        pd.DataFrame({"Fx [mN]": 1e3 * FORCE}, DATES.tz_localize("Europe/Berlin")),
        pd.DataFrame({"t [s]": TIME, "F [N]": pd.array(FORCE, "Float64"), "step": "a"}),
        pd.DataFrame({("rig", "t [s]"): TIME, ("cell", "F [N]"): FORCE}),
        xr.Dataset(
            {"force": ("time", 1e3 * FORCE, {"units": "mN"})},
            {"time": ("time", 1e3 * TIME, {"units": "ms"})},
        ),
    ],
)
def test_a_table_is_read_like_a_file(table):
    record = st.read_record(table, stiffness="1 kN/m")
    np.testing.assert_allclose(record.time, TIME, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(record.force, FORCE, rtol=1e-12, atol=1e-15)
    assert record.stiffness == 1e3
    assert type(table).__name__ in str(record.origin)


@pytest.mark.parametrize("kind", ["data", "to_dataframe"])
def test_data_of_a_run_are_those_of_its_record(kind):
    run = st.simulate(st.presets.nakano_popov_2020(), "0.2 s", sample_rate="5 kHz")
    table = run.data if kind == "data" else run.to_dataframe()
    record = st.read_record(table)
    assert np.array_equal(record.force, run.samples["spring_x"])
    assert np.array_equal(record.force_across, run.samples["spring_y"])
    again = st.read_record(record.to_dataframe())
    assert np.array_equal(again.force, record.force)


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (pd.DataFrame(), "DataFrame: no samples in it, or none that are numbers"),
        (pd.DataFrame({"F [N]": FORCE}), "DataFrame: no column is the time"),
        (pd.DataFrame({"t [s]": TIME, "F": FORCE}), "DataFrame: column 2 'F' states no unit"),
        (xr.Dataset({"a": ("x", ["b", "c"])}), "Dataset: no samples in it"),
    ],
)
def test_a_table_that_is_no_record_says_why(table, said):
    with pytest.raises(st.ResultError, match=said):
        st.read_record(table)
