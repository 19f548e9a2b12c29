"""Dates and spans of time are read as seconds, wherever times are."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import stiction as st
from stiction.text.units import FORCE, TIME, to_si

START = datetime(2024, 3, 30, 23, 59, 58)
SINCE = np.array([0.0, 3600.0, 7200.0, 10800.0])  # over midnight and the start of summer time
CLOCK = [START + timedelta(seconds=float(each)) for each in SINCE]
INDEX = pd.DatetimeIndex(CLOCK)


@pytest.mark.parametrize(
    "time",
    [
        CLOCK,
        tuple(each.replace(tzinfo=UTC) for each in CLOCK),
        np.array(CLOCK, "M8[ns]"),
        np.array(CLOCK, "M8[ms]"),
        np.array(CLOCK, dtype=object),
        INDEX,
        INDEX.tz_localize("UTC").tz_convert("Europe/Berlin"),
        pd.Series(INDEX.tz_localize("UTC").tz_convert("Europe/Berlin"), index=[7, 5, 3, 1]),
        pd.Series(INDEX, dtype=object, index=[7, 5, 3, 1]),
        xr.DataArray(INDEX, dims="i"),
        INDEX - INDEX[0],
        [each - START for each in CLOCK],
        np.array(SINCE * 1e3, "m8[ms]"),
        pd.Series(pd.to_timedelta(SINCE, unit="s"), index=[7, 5, 3, 1]),
    ],
    ids=lambda time: f"{type(time).__name__} of {getattr(time, 'dtype', type(next(iter(time))))}",
)
def test_a_row_of_dates_is_seconds_since_the_first(time: Any) -> None:
    record = st.Record(time=time, force=[1.0, 2.0, 3.0, 4.0])
    assert np.array_equal(record.time, SINCE)
    piece = st.protocols.Recorded(time=time, velocity=[1e-3, 2e-3, 3e-3, 2e-3])
    assert np.array_equal(piece.time, SINCE)


@pytest.mark.parametrize("unit", ["ns", "us", "ms", "s"])
def test_dates_lose_nothing_that_floats_hold(unit: str) -> None:
    rng = np.random.default_rng(5)
    for _ in range(100):
        ticks = np.sort(rng.choice(10**6, size=9, replace=False))
        dates = np.datetime64("2024-05-01", unit) + ticks.astype(f"m8[{unit}]")
        exact = (ticks - ticks[0]) / {"ns": 1e9, "us": 1e6, "ms": 1e3, "s": 1.0}[unit]
        found = st.Record(time=dates, force=np.zeros(9)).time
        assert np.allclose(found, exact, rtol=1e-15, atol=0.0)


@pytest.mark.parametrize(
    ("time", "said"),
    [
        ([CLOCK[0], *SINCE[1:]], "time: must be all dates or all spans of time"),
        ([CLOCK[0] - START, *CLOCK[1:]], "time: must be all dates or all spans of time"),
        (np.arange(4).astype("m8[M]"), "and not in months"),
        (INDEX.where(SINCE != 7200.0), "1 of 4 samples are not finite, the first is number 3"),
        (INDEX[::-1], "time must increase"),
        (CLOCK[0], "must have one dimension, has 0"),
        (np.array([CLOCK, CLOCK], "M8[s]"), "must have one dimension, has 2"),
    ],
)
def test_what_is_no_row_of_dates_is_told(time: Any, said: str) -> None:
    with pytest.raises(st.DescriptionError) as error:
        st.Record(time=time, force=SINCE)
    assert said in str(error.value)


def test_dates_are_seconds_and_nothing_else() -> None:
    with pytest.raises(st.DescriptionError, match="time_unit: is 'ms', but time carries 's'"):
        st.Record(time=CLOCK, force=SINCE, time_unit="ms")
    with pytest.raises(st.DescriptionError, match=r"force: '1 s' is in s, not a unit of a force"):
        st.Record(time=SINCE, force=CLOCK)


def test_a_run_is_sampled_at_spans_of_time() -> None:
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(slider, times=pd.to_timedelta([0, 3, 20], unit="ms"))
    assert np.array_equal(run.samples["time"], [0.0, 0.003, 0.02])


@pytest.mark.parametrize(
    "span",
    [
        timedelta(milliseconds=20),
        pd.Timedelta("20 ms"),
        np.timedelta64(20, "ms"),
        np.timedelta64(20_000_000, "ns"),  # whose ``item()`` is a bare 20000000
        np.array(20_000, "m8[us]"),
    ],
    ids=repr,
)
def test_one_span_of_time_is_a_time(span: Any) -> None:
    assert to_si(span, TIME) == 0.02
    assert len(st.simulate(st.presets.nakano_popov_2020(), span, sample_rate="1 kHz").samples) == 21
    with pytest.raises(ValueError, match=r"'0.02 s' is in s, not a unit of a force"):
        to_si(span, FORCE)


@pytest.mark.parametrize(
    "value", [START, pd.Timestamp(START), np.datetime64(START, "ns"), np.timedelta64(1, "M")]
)
def test_a_date_or_months_are_not_a_time(value: Any) -> None:
    with pytest.raises(ValueError, match="is not a time"):
        to_si(value, TIME)
