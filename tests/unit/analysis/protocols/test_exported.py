"""What a report of a test writes beside its text: a table, numbers and a figure."""

import json

import numpy as np
import pytest

import stiction as st
from stiction.analysis.export import numbers, tables
from stiction.analysis.parts import procedure
from stiction.plotting.analysis.overview import figures

p = st.protocols
ROCK = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
STIFF = st.Slider(
    mass="1 g", k_x="1 MN/m", k_y="100 MN/m", phi="0 deg", normal_load="10 N", friction=ROCK
)
COULOMB = STIFF.replace(
    friction=st.Coulomb(mu_0=0.3), k_x="20 kN/m", drive=st.ConstantVelocity("1 mm/s")
)
TESTS = {
    "velocity-steps": (
        STIFF,
        {"drive": p.velocity_steps(["1 um/s", "10 um/s"], distance="0.2 mm")},
    ),
    "healing": (STIFF, {"drive": p.slide_hold_slide("10 um/s", ["3 s", "9 s"], slide="20 s")}),
    "hysteresis": (COULOMB, {"drive": p.reversal_loops("1 mm/s", travel="1 mm", loops=2)}),
    "load-dependence": (
        COULOMB,
        {"load": p.load_ramp(["5 N", "10 N", "20 N"], ramp="0.5 s", hold="2 s")},
    ),
}


@pytest.mark.parametrize("name", TESTS)
def test_a_report_of_a_test_writes_its_rows(name):
    """The text had a, b and D_c; neither a file nor ``analysis.json`` did."""
    slider, change = TESTS[name]
    found = st.analyse(st.simulate(slider.replace(**change), sample_rate="20 Hz"))
    its, table = found.parts["procedure"], tables(found)[name]
    stored = json.loads(json.dumps(numbers(found)["procedure"]))
    assert stored["test"] == name
    assert name in figures(found)
    for key, column in table.data_vars.items():
        parts = getattr(its, {"velocity-steps": "steps", "hysteresis": "loops"}.get(name, ""), None)
        known = getattr(its, key) if parts is None else [getattr(each, key) for each in parts]
        assert column.values.tolist() == list(known)
        assert stored["rows"][key]["unit"] == column.attrs.get("units", "")
        assert len(stored["rows"][key]["values"]) == len(known)
    for key, each in stored.items():
        if key not in ("test", "rows"):
            assert each["value"] is None or each["value"] == getattr(its, key)


def test_each_test_that_a_report_finds_is_written():
    assert [*procedure.TESTS] == [*TESTS]


def test_a_report_of_no_test_writes_none():
    record = st.Record(time=np.arange(100.0), force=np.ones(100))
    found = st.analyse(record)
    assert numbers(found)["procedure"] is None
    assert not {*tables(found)} & {*TESTS}
