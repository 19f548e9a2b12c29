"""Units as people write them: accepted and refused spellings."""

import copy
import json
import pickle

import numpy as np
import pint
import pytest
import xarray as xr

import stiction as st
from stiction.text.quantity.exact import quantity_text
from stiction.text.quantity.unit import COMMON, LONGEST_UNIT, UnitError, factor, short
from stiction.text.quantity.wording import in_digits, in_words, percent, to_error, with_error
from stiction.text.units import FORCE, VELOCITY, Kind, PydanticCustomError, to_si

DAMPING = Kind("a damping constant", "N*s/m", "0.5 N*s/m")
ANGLE = Kind("an angle", "rad", "1 deg")
FREQUENCY = Kind("a frequency", "Hz", "10 kHz")
NUMBER = Kind("a number", "", "0.2")
LENGTH = Kind("a length", "m", "0.1 mm")

DAMPINGS = """
40 N s/m | 40 N*s/m | 40 N·s/m | 40 N⋅s/m | 40 N.s/m | 40 Ns/m | 40 kg/s | 40N s/m | 4e1 kg s^-1
40 N * s / m | 40 N s m^-1 | 40 N s m-1 | 40 N·s·m⁻¹ | 40 N/(m/s) | 0.04 N / (mm / s)
40 newton second / meter | 0.04 kN s/m | 40 N*s*m**-1 |  40   N  s/m  | 40 N/m*s
"""


@pytest.mark.parametrize("text", DAMPINGS.strip().replace("\n", "|").split("|"))
def test_a_damping_constant_is_read_however_it_is_written(text):
    assert to_si(text, DAMPING) == pytest.approx(40.0, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("1 mm s^-1", VELOCITY, 1e-3),
        ("1 m s-1", VELOCITY, 1.0),
        ("3 µm/s", VELOCITY, 3e-6),  # the micro sign
        ("3 μm/s", VELOCITY, 3e-6),  # the Greek letter
        ("57 um", LENGTH, 57e-6),
        ("−2 mm", LENGTH, -2e-3),
        ("90°", ANGLE, np.pi / 2),
        ("30 arcmin", ANGLE, np.pi / 360),
        ("5 1/s", FREQUENCY, 5.0),
        ("5 /s", FREQUENCY, 5.0),
        ("1 kgf", FORCE, 9.80665),
        (np.float64(3.0), FORCE, 3.0),
        (np.int64(3), FORCE, 3.0),
        (np.array(3.0), FORCE, 3.0),
        (pint.Quantity(3, "kN"), FORCE, 3e3),
        (pint.Quantity(np.float64(2.0), "mm / s"), VELOCITY, 2e-3),
        (pint.Quantity(0.2, ""), NUMBER, 0.2),
        (xr.DataArray(2.0, attrs={"units": "mm/s"}), VELOCITY, 2e-3),
        (xr.DataArray(2.0, attrs={"units": "deg"}), ANGLE, np.pi / 90),
        (xr.DataArray(2.0, attrs={"long_name": "speed"}), VELOCITY, 2.0),
        (xr.DataArray(0.2, attrs={"units": "1"}), NUMBER, 0.2),
    ],
)
def test_other_quantities(text, kind, value):
    assert to_si(text, kind) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("power", [2, 3, 4])
@pytest.mark.parametrize("name", ["s", "mm", "µm", "lbf", "h"])
def test_a_small_digit_is_a_power_in_a_denominator_too(name, power):
    """It was part of the name: 1/s², as the program writes it, was the root of a second."""
    digit = "⁰¹²³⁴⁵⁶⁷⁸⁹"[power]
    expected = pint.Quantity(1.0, f"kg/{name}**{power}").to_root_units()
    wanted = f"{expected.units:~C}"
    for text in (
        f"kg/{name}{digit}",
        f"kg {name}⁻{digit}",
        f"{pint.Unit(f'kg/{name}**{power}'):~P}",
    ):
        assert factor(text, wanted) == pytest.approx(expected.magnitude, rel=1e-14)
    for text in (f"kg/{digit}{name}", f"kg/{name}{digit}{digit}"):
        with pytest.raises(UnitError):
            factor(text, wanted)


def test_common_units_are_those_of_the_registry():
    """Factors without the registry equal its own, and it finds the same dimensions."""
    for name in COMMON:
        known = pint.Quantity(1.0, name).to_base_units()
        same = {"kilogram": "kg", "meter": "m", "second": "s"}
        base = "*".join(f"{same[each]}^{int(power)}" for each, power in known.units._units.items())
        assert factor(name, base) == pytest.approx(
            pint.Quantity(1.0, name).to(base).magnitude, rel=1e-15
        )


def test_what_is_written_in_decimals_becomes_the_nearest_float():
    for number in range(1, 2000):
        assert to_si(f"{number} um", LENGTH) == float(f"{number}e-6")


@pytest.mark.parametrize(
    ("text", "kind", "words"),
    [
        ("40 N/m s", DAMPING, "is ambiguous; put it in brackets"),
        ("1 rad/s", FREQUENCY, "not a unit of a frequency"),  # off by 2 pi
        ("60 rpm", FREQUENCY, "not a unit of a frequency"),
        ("1 m", FORCE, "is in m, not a unit of a force"),
        ("1 m/m", LENGTH, "no unit, not a unit of a length"),
        ("1 n", FORCE, "capitals matter"),
        ("1 dBm m", LENGTH, "'dBm m' is not a unit that can be converted"),
        ("1 nan", LENGTH, "'nan' is not a unit that can be converted"),
        ("1 N**9999999", FORCE, "not one number and its unit"),
        ("1 N^" + "9" * 40, FORCE, "not one number and its unit"),
        ("1 " + "m*" * LONGEST_UNIT + "m", LENGTH, "longer than"),
        ("1 (" * 20, LENGTH, "not one number and its unit"),
        ("1 m/", LENGTH, "incomplete"),
        ("1 m)", LENGTH, "')'"),
        ("2 * 3 m", LENGTH, "not one number and its unit"),
        ("1 __class__", LENGTH, "not one number and its unit"),
        ("1,5 mm", LENGTH, "the decimal sign is a point"),
        ("1 2 m", LENGTH, "not one number and its unit"),
        ("1 m 2", LENGTH, "not one number and its unit"),
        ("mm", LENGTH, "not one number and its unit"),
        ("5", LENGTH, "has no unit"),
        ("nan m", LENGTH, "not finite"),
        ("2 +- 1 deg", ANGLE, "is uncertain, which 'stiction fit', 'design' and 'audit' read"),
        ("4 ± 0.1 N", FORCE, "is uncertain"),
        ({"low": "1 N", "high": "2 N"}, FORCE, "is uncertain"),
        ({"value": "1 N", "uncertainty": "5 %"}, FORCE, "is uncertain"),
        ({"value": "1 N", "uncertanty": "5 %"}, FORCE, "has value and uncertainty, or low and"),
        ({"hold": 1}, FORCE, "{'hold': 1} is not"),
        (float("nan"), ANGLE, "not finite"),
        (True, LENGTH, "is not a length"),
        (None, LENGTH, "is not a length"),
        (np.array([1.0, 2.0]), LENGTH, "is not a length"),
        (xr.DataArray(2.0, attrs={"units": "g"}), VELOCITY, "is in g, not a unit of a velocity"),
        (xr.DataArray(2.0, attrs={"units": "1"}), VELOCITY, "is in no unit, not a unit"),
        (np.float64(1.0), ANGLE, "degree or radian"),
    ],
)
def test_what_is_unclear_is_refused(text, kind, words):
    with pytest.raises(PydanticCustomError) as error:
        to_si(text, kind)
    assert words in error.value.message()


def test_what_is_said_in_words_is_read_again():
    for unit in ("m", "N", "s", "m/s", "N/m", "kg", "N*s/m", "Hz"):
        for value in (1.0, 0.0123, 4.5e-7, 6.7e5):
            text = in_words(value, unit)
            assert to_si(text, Kind("such a quantity", unit, "")) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (1.5e-3, "1/s", "0.0015 1/s"),  # not 1.5 1/ks
        (2e4, "%", "20000 %"),
        (11434.2, "s", "11430 s"),
        (3e7, "s", "3e7 s"),
        (6.31152e8, "s", "20 yr"),
        (0.25, "kg", "250 g"),
        (999.97, "N", "1 kN"),
        (40.0, "N*s/m", "40 N s/m"),
        (-3e-7, "m", "-300 nm"),
        (0.0, "kg", "0 kg"),
        (0.25, "1", "0.25"),
        (1500.0, "s", "1500 s"),  # not 1.5 ks
    ],
)
def test_words_have_a_prefix_where_the_unit_can(value, unit, text):
    assert in_words(value, unit) == text


def test_a_power_of_ten_is_of_the_number_that_is_shown():
    assert [in_words(2.1e7, "Hz", 1), in_words(2e8, "N", 1), in_words(45.0, "s", 1)] == [
        "20 MHz",
        "200 MN",
        "40 s",
    ]


SYSTEM = ("kg", "N/m", "N*s/m", "N", "m", "m/s", "s", "Hz", "rad", "s/m")


def test_what_is_written_is_read_again_to_the_last_digit():
    random = np.random.default_rng(1)
    for unit in SYSTEM:
        kind = Kind("such a quantity", unit, "")
        for value in (*10.0 ** random.uniform(-9, 9, 300), *np.arange(-5.0, 5.0), 1e-59, 1e59):
            assert to_si(quantity_text(float(value), unit), kind) == value
        for digits in range(1, 1000):
            assert to_si(quantity_text(digits / 1e4, unit), kind) == digits / 1e4


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.001, "m/s", "1 mm/s"),
        (0.01, "m/s", "10 mm/s"),
        (1e3, "N/m", "1 kN/m"),
        (1e7, "N/m", "10 MN/m"),
        (10.0, "N", "10 N"),
        (0.08, "kg", "80 g"),
        (1e-11, "kg", "10 ng"),
        (40.0, "N*s/m", "40 N s/m"),
        (0.0, "N*s/m", "0 N s/m"),
        (5.0, "s", "5 s"),
        (np.radians(3.5), "rad", "3.5 deg"),
        (-np.radians(90), "rad", "-90 deg"),
        (0.1, "rad", "0.1 rad"),
        (0.5, "s/m", "0.5 s/m"),
        (987318.695067941, "N/m", "987.318695067941 kN/m"),
    ],
)
def test_quantities_are_written_as_people_write_them(value, unit, text):
    assert quantity_text(value, unit) == text


def test_degrees_need_no_registry():
    for degrees in np.arange(-90, 90.1, 0.37):
        assert to_si(f"{degrees} deg", ANGLE) == to_si(f"{degrees}°", ANGLE)


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.974, "97 %"), (0.9953, "99.5 %"), (0.99996, "99.996 %"), (1.0, "100 %"), (1.26, "126 %"),
     (0.0, "0 %"), (6.48e-5, "0.0065 %"), (1.0 - 1e-9, "100 %")],
)  # fmt: skip
def test_less_than_the_whole_is_not_100_percent(share, text):
    assert percent(share) == text


@pytest.mark.parametrize(
    ("value", "error", "unit", "text"),
    [(0.9776, 0.0048, "N", "978 ± 5 mN"), (62e-6, 6.1e-7, "m/s", "62.0 ± 0.6 µm/s"),
     (1.863, 0.00071, "N", "1.8630 ± 0.0007 N"), (np.radians(1.99), np.radians(0.02), "rad",
     "1.99 ± 0.02 deg"), (0.2, 0.0, "1", "0.2"), (0.2, np.nan, "1", "0.2"),
     (3299.0, 98.0, "1/s²", "3300 ± 100 1/s²"), (1.08015179565207, 2e-14, "N", "1.08 N")],
)  # fmt: skip
def test_an_error_has_the_unit_of_its_value(value, error, unit, text):
    assert with_error(value, error, unit) == text


def test_zeros_that_are_known_are_written():
    """A period of 24.0 s was "24 s", a spread of 0.10 "0.1": half of the digits of the others."""
    assert to_error(24.0, 0.3, "s") == "24.0 s"
    assert to_error(1.0998e-9, 6e-13, "N") == "1.100 nN"
    assert to_error(5e6, 4e5, "Hz") == "5.0 MHz"
    assert to_error(24.0, 30.0, "s") == "20 s"
    assert in_digits(0.1, "", 2) == "0.10"
    assert in_digits(0.0, "N", 2) == "0 N"
    assert in_digits(np.nan, "N", 2) == "none"
    assert in_digits(1e-14, "m", 2) == "< 1 pm"


def test_a_power_of_ten_has_no_zeros_and_tonnes_no_megagrams():
    assert in_words(2e-8, "1") == "2e-8"
    assert in_words(1.5575e7, "1/s") == "1.558e7 1/s"
    assert in_words(8e3, "kg") == "8 t"


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("3.3 in", LENGTH, 0.08382),
        ("7.1 ft", LENGTH, 2.16408),
        ("3.3 gf", FORCE, 0.032361945),
        ("0.3 mm", LENGTH, 0.0003),
    ],
)
def test_exact_factors_leave_no_digits_of_rounding(text, kind, value):
    """A pound is 0.45359237 kg: 3.3 lb came back as 1.4968548210000001 kg."""
    assert to_si(text, kind) == value


@pytest.mark.parametrize("text", ["1e305 MN", "1e308 kN", "-1e307 GN"])
def test_a_number_that_its_unit_makes_too_large_is_refused(text):
    with pytest.raises(PydanticCustomError, match="is not finite"):
        to_si(text, FORCE)


@pytest.mark.parametrize("text", ["um/s", "µm/s", "μm/s", "micrometer/s"])
def test_micro_is_the_sign_whichever_pint_writes(text):
    assert short(text) == "\N{MICRO SIGN}m/s"


@pytest.mark.parametrize("name", ["phi", "mass_angle", "damping_angle", "cell_angle"])
def test_an_angle_of_one_slider_is_that_of_another(name):
    slider = st.presets.nakano_popov_2020()
    for angle in np.random.default_rng(5).uniform(-1.57, 1.57, 200).tolist():
        given = getattr(slider.replace(**{name: f"{angle!r} rad"}), name)
        assert given == angle
        assert getattr(slider.replace(**{name: given}), name) == angle
        assert getattr(slider.replace(**{name: copy.deepcopy(given)}), name) == angle
        assert getattr(slider.replace(**{name: pickle.loads(pickle.dumps(given))}), name) == angle


def test_an_angle_keeps_its_unit_where_a_number_would_be_refused():
    slider = st.presets.nakano_popov_2020()
    assert st.Values([slider.phi, "2 deg"]).values == ("0.017453292519943295 rad", "2 deg")
    with pytest.raises(st.DescriptionError, match="is in rad, not a unit of a mass"):
        slider.replace(mass=slider.phi)
    with pytest.raises(st.DescriptionError, match="degree or radian"):
        slider.replace(phi=2 * slider.phi)


def test_an_angle_is_a_number_everywhere_else():
    phi = st.presets.nakano_popov_2020().phi
    plain = float(phi)
    assert json.loads(json.dumps({"phi": phi})) == {"phi": plain}
    assert np.array([phi]).dtype == float
    assert np.sin(phi) == np.sin(plain)
    assert repr(phi) == repr(plain)
    found = [st.theory.creep_velocity(0.5, 1e-3, each, 1e-3) for each in (phi, plain)]
    assert found[0] == found[1]


@pytest.mark.parametrize(("mass", "weight"), [("4kg", "4 kgf"), ("400 g", "0.4 kgf")])
def test_a_mass_in_place_of_a_force_names_its_weight(mass, weight):
    """ "4kg is not a unit of a force; write for example '10 N'" left the reader to find kgf."""
    with pytest.raises(st.DescriptionError, match=f"is a mass, not a force.*'{weight}'"):
        st.Record(time=[0.0, 1.0], force=[1.0, 2.0], normal_load=mass)
    record = st.Record(time=[0.0, 1.0], force=[1.0, 2.0], normal_load=weight)
    assert record.normal_load == pytest.approx(9.80665 * float(weight.split()[0]))


def test_a_single_spring_that_is_rigid_names_the_way_out():
    with pytest.raises(st.DescriptionError, match=r"springs? in series.*'1 GN/m'"):
        st.presets.nakano_popov_2020().replace(k_y="rigid")


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (6e7, "kg", "60 kt"),  # was 6e+10 g
        (150.0, "kg", "150 kg"),
        (1e-5, "N*s/m", "10 uN s/m"),  # was 1e-8 kN s/m
        (0.02, "Hz", "20 mHz"),  # was 2e-8 MHz
        (1e-30, "N", "1e-21 nN"),
    ],
)
def test_a_description_has_no_power_of_ten_where_a_unit_can(value, unit, text):
    assert quantity_text(value, unit) == text
    assert to_si(text, Kind("such a quantity", unit, "")) == value


def test_kt_is_a_knot_of_a_speed_alone():
    assert factor("kt", "kg") == 1e6
    assert factor("kt", "m/s") == pytest.approx(1852.0 / 3600.0)
