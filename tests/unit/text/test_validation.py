"""One fault of an object does not hide the others."""

import numpy as np
import pytest
from tests.drawn import all_over

import stiction as st
from stiction.text.quantity.unit import registry

N = np.arange(10.0)
BASE = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="1 s"))
AXES = {"phi": st.Grid("1 deg", "2 deg", 3)}
CASES = {  # a class, valid arguments, and from each fault's path to the arguments that make it
    "record": (
        st.Record,
        {"time": N, "force": N},
        {
            "time_unit": {"time_unit": "kg"},
            "force_unit": {"force_unit": "kg"},
            "stiffness": {"stiffness": "1 kg"},
            "mass": {"mass": -1.0},
            "position": {"position": ["a"] * 10},
            "slip_speed_unit": {"slip_speed": N, "slip_speed_unit": "N"},
            "bogus": {"bogus": 1},
            "": {"load": -N},
        },
    ),
    "sensor": (
        st.Sensor,
        {},
        {
            "noise": {"noise": "2 kg"},
            "filter": {"filter": "1 kg"},
            "filter_order": {"filter_order": 0},
            "zero": {"zero": "1 +- -1 N"},
            "zero_drift": {"zero_drift": "1 N"},
            "bogus": {"bogus": 1},
            "": {"gain": 0.0},
        },
    ),
    "study": (
        st.Study,
        {"base": BASE, "axes": AXES},
        {
            "measures": {"measures": ["bogus"]},
            "traces": {"traces": "force"},
            "trace_samples": {"trace_samples": 0},
            "seed": {"seed": -1},
            "bogus": {"bogus": 1},
            "axes.phi": {"axes": {"phi": st.Grid("1 deg", "99 deg", 3)}},
        },
    ),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("drawn", all_over(12, *[(0.0, 1.0)] * 4))
def test_faults_that_do_not_depend_on_each_other_are_named_together(
    case: str, drawn: tuple[float, ...]
) -> None:
    kind, valid, wrong = CASES[case]
    chosen = [*drawn, *(1.0 - each for each in drawn[::-1])]
    paths = [path for path, share in zip(wrong, chosen, strict=False) if share > 0.4]
    values = {name: value for path in paths for name, value in wrong[path].items()}
    with pytest.raises(st.DescriptionError) as error:
        kind(**(valid | values))
    told = [fault.path.partition(".")[2] for fault in error.value.faults]
    assert sorted(told) == sorted(paths)


def test_an_array_in_a_wrong_unit_hides_no_fault_of_a_number() -> None:
    time = N * registry().Unit("kg")
    with pytest.raises(st.DescriptionError) as error:
        st.Record(time=time, force=N, mass="1 m")
    assert [fault.path for fault in error.value.faults] == ["Record.time", "Record.mass"]


def test_axes_with_a_fault_hide_no_fault_of_others() -> None:
    axes = {"mass": ["1 kg"], "k_x": st.Values(["1 s"]), "nope": st.Values([1.0])}
    with pytest.raises(st.DescriptionError) as error:
        st.Study(base=BASE, axes=axes, measures=["bogus"])
    told = [fault.path.removeprefix("Study.") for fault in error.value.faults]
    assert told == ["axes.mass", "axes.k_x.1", "axes.nope", "measures"]


def test_each_part_of_a_description_is_replaced_in_one_way():
    slider = st.presets.nakano_popov_2020()
    whole = st.Description.of(slider, "20 ms", initial=st.Initial(u_x="1 mm"))
    program = st.protocols.DriveProgram(velocity=1e-3, program=[st.protocols.Hold("2 s")])
    parts = [
        slider.replace(damping_angle="3 deg", c_x=2.0),
        whole,
        whole.initial,
        whole.run,
        program,
        st.Study(base=whole, axes={"phi": st.Grid("1 deg", "3 deg", 3)}, measures=["period"]),
        st.Grid("1 deg", "3 deg", 3),
        st.Sensor(noise="1 mN", bandwidth="1 kHz"),
        st.Record(time=[0.0, 1.0, 2.0], force=[0.0, 1.0, 3.0], force_unit="mN", turned="3 deg"),
    ]
    for part in parts:
        assert part.replace() == part
    assert whole.run.replace(rtol=1e-4) == st.Settings(duration=0.02, rtol=1e-4)
    assert whole.replace(run=whole.run.replace(duration="1 s")).run.duration == 1.0
    # what was not stated stays so: a file holds only what is stated
    assert whole.replace(initial=st.Initial().replace(time=1.0)).to_dict()["initial"] == {
        "time": 1.0
    }
    with pytest.raises(st.DescriptionError) as caught:
        whole.run.replace(rtoll=3, duration="x")
    assert [fault.path for fault in caught.value.faults] == ["Settings.duration", "Settings.rtoll"]
    with pytest.raises(st.DescriptionError, match=r"write settings\.replace\(rtol=3\)"):
        whole.run.rtol = 3


def test_a_name_in_capitals_is_the_nearest(slider):
    """k_X is nearer to k_x than to k_y."""
    with pytest.raises(st.DescriptionError, match="did you mean 'k_x'"):
        slider.replace(k_X=1.0)
