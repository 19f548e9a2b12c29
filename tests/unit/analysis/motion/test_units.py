"""A doubt of a unit, followed to the letter, vanishes, whatever the unit that was read."""

import re
from itertools import product

import numpy as np
import pytest
from tests.parts import assess

import stiction as st
from stiction.analysis.motion.doubts.units import Numbers, likely_changes

TIME = np.arange(0.0, 40.0, 0.01)
FORCE = 1.0 + TIME / 2.0 % 1.0
KNOWN = {"stiffness": "0.5 kN/m", "drive_velocity": "1 mm/s"}  # 0.5 N/s, as it rises
LOADED = KNOWN | {"normal_load": "5 N"}
SIZES = {
    "force": {
        "uN": 1e-6, "mN": 1e-3, "N": 1.0, "kN": 1e3, "gf": 9.80665e-3, "kgf": 9.80665,
        "-1 mN": -1e-3, "25 mm^2*MPa": 25.0,
    },
    "time": {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "seconds": 1.0},
}  # fmt: skip
COMBINATIONS = [
    (channel, unit, power)
    for channel, units in SIZES.items()
    for unit, power in product(units, (-1, 1))
]
UNIT = re.compile(r"Give (time|force)(_unit)?=('[^']*'|[\d.]+ \* \w+)")


def doubts(record):
    """Return the warnings about units, by channel."""
    said = [each for each in assess(record).warnings if "Give" in each]
    return said, {found[1]: found for each in said for found in UNIT.finditer(each)}


def columns(channel, unit, power, values):
    """Return a column that is 1000**power units of what it is read in."""
    return values / SIZES[channel][unit] / 1000.0**power


@pytest.mark.parametrize("known", [KNOWN, LOADED])
@pytest.mark.parametrize(("channel", "unit", "power"), COMBINATIONS)
def test_of_a_file(tmp_path, channel, unit, power, known):
    read = {"time": "s", "force": "N"} | {channel: unit}
    given = {"time": TIME, "force": FORCE}
    columns_of = [
        columns(name, read[name], power * (name == channel), given[name]) for name in given
    ]
    path = tmp_path / "a.csv"
    np.savetxt(path, np.transpose(columns_of), delimiter=",", header="t,F", comments="")
    asked = {"time": f"1={read['time']}", "force": f"2={read['force']}"}
    _, remedies = doubts(st.read_record(path, **asked, **known))
    assert channel in remedies
    if known is LOADED:  # the coefficient tells one from the other
        assert remedies.keys() == {channel}
    else:
        assert remedies.keys() == {"time", "force"}
    for name, found in remedies.items():
        mended = st.read_record(path, **asked | {name: found[3].strip("'")}, **known)
        assert doubts(mended) == ([], {})
        if name == channel:
            assert mended.force == pytest.approx(FORCE, rel=1e-9)
            assert mended.time == pytest.approx(TIME, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("known", [KNOWN, LOADED])
@pytest.mark.parametrize(
    ("channel", "unit", "power"),
    [x for x in COMBINATIONS if x[1][0].isalpha() and x[1] != "seconds"],
)
def test_of_arrays(channel, unit, power, known):
    arrays = {"time": TIME, "force": FORCE}
    arrays[channel] = columns(channel, unit, power, arrays[channel])
    given = arrays | {f"{channel}_unit": unit}
    _, remedies = doubts(st.Record(**given, **known))
    assert channel in remedies
    for name, found in remedies.items():
        remedy = found[3].strip("'")
        factor = remedy.partition(" * ")
        change = {f"{name}_unit": remedy} if found[2] else {name: float(factor[0]) * arrays[name]}
        assert doubts(st.Record(**given | change, **known)) == ([], {})


def test_of_an_array_that_carries_its_unit():
    import xarray as xr

    force = xr.DataArray(1e3 * FORCE, attrs={"units": "N"})
    said, _ = doubts(st.Record(time=TIME, force=force, **LOADED))
    assert "is the force 0.001 times as large? Give force=0.001 * force" in said[0]


def test_a_coefficient_has_no_unit_of_force(tmp_path):
    path = tmp_path / "a.csv"
    np.savetxt(path, np.c_[TIME, FORCE], delimiter=",", header="t [s],mu", comments="")
    said = " ".join(assess(st.read_record(path, normal_load="1 kN", **KNOWN)).warnings)
    assert "stiffness or drive velocity is stated" in said
    assert "is the force" not in said


def test_a_force_without_times_doubts_their_interval(tmp_path):
    path = tmp_path / "a.csv"
    np.savetxt(path, FORCE, header="F [N]", comments="")
    said, _ = doubts(st.read_record(path, interval="10 s", **KNOWN))
    assert "is the interval of the samples 0.001 times that which was read?" in said[0]


@pytest.mark.parametrize(
    ("seen", "causes"),
    [
        (Numbers(0.3, 1.0, 1.0), set()),
        (Numbers(300.0, 1e3, 1.0), {"force"}),
        (Numbers(0.3, 1e3, 1e3), {"stiffness"}),
        (Numbers(0.3, 1e-3, 1e-6), {"time"}),
        (Numbers(300.0, 1.0, 1.0), {"load"}),
        (Numbers(300.0, 1.0, 1e-6), {"time", "force"}),
        (Numbers(0.3, 1.0, 1e3), {"mass"}),
        (Numbers(0.3, 1e3), {"time", "stiffness", "velocity"}),
    ],
)
def test_one_wrong_number_explains_more_than_two(seen, causes):
    assert {name for change in likely_changes(seen) for name in change} == causes
