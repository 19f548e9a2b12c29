"""The schema takes what the parser takes, and finds the faults of types and keys that it finds."""

import json
import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

import stiction as st
from stiction.friction import LAWS, has_state
from stiction.system.schema import schema

ROOT = Path(__file__).parents[3]
RIGS = sorted((ROOT.parent / "shared" / "rigs").glob("*.toml"))
VALIDATOR = Draft7Validator(schema())
PAPER = st.presets.nakano_popov_2020()
SPRINGS = [
    st.Spring("load cell", k_x="20 kN/m", k_y="rigid", angle="2 deg", mass="20 g"),
    st.Spring("leaf springs", compliance_x="1 mm/N", k_y="5 MN/m"),
]
# faults between values, which are not the schema's
BETWEEN = (
    "missing; only the last piece may have no end",
    "must have a value for each v",
    "must be at least two points",
    "give either by or to",
    "are rigid together along some axis",
    "follows from springs",
)
WRONG = (True, [], {}, "", "fast", "1 , 2")  # of no table, quantity, name or number


def describe(**changes):
    """A description as nested tables, as if from TOML."""
    slider = PAPER.replace(**changes)
    whole = st.Description(slider, st.Initial(), st.Settings(duration="1 s", sample_rate="1 kHz"))
    return tomllib.loads(whole.to_toml())


def programs():
    """Every piece, in programs of drive and load."""
    p = st.protocols
    pieces = [p.Constant("1 mm/s", "1 s"), p.Step("1 mm/s", "1 s"), p.Ramp("2 mm/s", "1 s")]
    pieces += [p.Hold("1 s"), p.Reversal("1 s"), p.Harmonic("1 mm/s", "1 Hz", duration="1 s")]
    load = [p.Ramp("20 N", "1 s"), p.Step("1 N")]
    return {
        "drive": p.DriveProgram(program=[*pieces, p.Free()], across=p.Modulation("1 mm/s", "9 Hz")),
        "load": p.LoadProgram(program=load, modulation=p.Modulation("1 N", "9 Hz")),
    }


def laws():
    for name, kind in LAWS.items():
        yield name, describe(friction=kind.like(0.2, 0.15, 1e-2))
    rough = st.laws.Anisotropic(st.Coulomb(mu_0=0.2), 0.8, "10 deg")
    yield "anisotropic", describe(friction=rough)
    yield "programs", describe(**programs())
    yield "springs", describe(springs=SPRINGS)


CASES = dict(laws())


def faults(tables):
    try:
        st.Description.from_dict(tables)
    except st.DescriptionError as error:
        return [fault.message for fault in error.faults]
    return []


def is_read(tables):
    return not faults(tables)


def change(tables):
    """Yield copies with one fault each: a key that is unknown, absent, or of a wrong type."""

    def places(part, path=()):
        items = part.items() if isinstance(part, dict) else enumerate(part)
        for key, value in items:
            yield (*path, key)
            if isinstance(value, dict | list):
                yield from places(value, (*path, key))

    for path in places(tables):
        for change in ("rename", "remove", *WRONG):
            copy = json.loads(json.dumps(tables))
            part = copy
            for key in path[:-1]:
                part = part[key]
            if change in ("rename", "remove"):
                value = part.pop(path[-1])
                if change == "rename" and isinstance(part, dict):
                    part[f"{path[-1]}_"] = value
            else:
                part[path[-1]] = change
            yield (*path, change), copy


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_every_rig_is_valid(path):
    assert not [*VALIDATOR.iter_errors(tomllib.loads(path.read_text("utf-8")))]


def test_so_are_the_template_the_examples_and_every_law(tmp_path):
    paths = [st.init(tmp_path / "my.toml"), ROOT / "examples" / "own_law.toml"]
    for path in paths:
        assert not [*VALIDATOR.iter_errors(tomllib.loads(path.read_text("utf-8")))]
    for tables in CASES.values():
        assert is_read(tables)
        assert not [*VALIDATOR.iter_errors(tables)]


@pytest.mark.parametrize("name", CASES)
def test_it_finds_the_faults_of_keys_and_types_that_the_parser_finds(name):
    missed = [
        path
        for path, tables in change(CASES[name])
        if VALIDATOR.is_valid(tables)
        and any(not says.startswith(BETWEEN) for says in faults(tables))
        and (name, path[0]) != ("programs", "run")  # needed, as its last piece has no end
    ]
    assert not missed


@pytest.mark.parametrize("name", CASES)
def test_it_refuses_nothing_that_the_parser_takes(name):
    refused = [
        path
        for path, tables in change(CASES[name])
        if is_read(tables) and not VALIDATOR.is_valid(tables)
    ]
    assert not refused


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [
        ("slider", "mass", -1.0),
        ("slider", "phi", 1.0),
        ("slider", "driven", "bridge"),
        ("friction", "law", "colomb"),
        ("drive", "velocity", "5"),
        ("run", "rtol", 1.0),
        ("run", "multiscale", "yes"),
    ],
)
def test_bounds_choices_and_bare_angles(table, key, value):
    tables = describe()
    tables[table][key] = value
    assert not VALIDATOR.is_valid(tables)
    assert not is_read(tables)


def test_an_editor_shows_what_a_key_means():
    keys = schema()["properties"]["slider"]["properties"]
    assert keys["c_y"]["description"].startswith("Damping constants of the spring along x and y")
    assert keys["mass"]["anyOf"][0] == {"type": "number", "exclusiveMinimum": 0}


def test_init_writes_it_beside_a_description(tmp_path):
    path = st.init(tmp_path / "my.toml", schema=True)
    assert json.loads((tmp_path / "stiction.schema.json").read_text()) == schema()
    assert path.read_text().startswith("#:schema stiction.schema.json\n")
    assert st.Description.from_toml(path).slider == PAPER
    path.write_text("mine")
    (tmp_path / "stiction.schema.json").unlink()
    assert st.init(path, schema=True).read_text() == "mine"
    assert (tmp_path / "stiction.schema.json").exists()


def test_a_run_whose_program_ends_needs_no_duration():
    whole = describe(drive=st.protocols.slide_hold_slide("1 mm/s", ["1 s"], slide="1 s"))
    for run in ({}, {"run": {"rtol": 1e-6}}):
        tables = {name: each for name, each in whole.items() if name != "run"} | run
        assert is_read(tables)
        assert VALIDATOR.is_valid(tables)
    steady = describe()
    del steady["run"]
    assert not is_read(steady)
    assert not VALIDATOR.is_valid(steady)


@pytest.mark.parametrize("name", LAWS)
def test_laws_with_a_state_have_no_grain(name):
    tables = describe(friction=LAWS[name].like(0.2, 0.15, 1e-2))
    tables["friction"]["anisotropy"] = {"ratio": 1.5}
    assert VALIDATOR.is_valid(tables) == is_read(tables) == (not has_state(LAWS[name]))
