"""Rooms list their names once: what is listed is there, and what is there is listed."""

import inspect
from pathlib import Path
from pkgutil import iter_modules

import pytest

import stiction as st
from stiction.analysis import parts
from stiction.cli import BESIDE, function_of
from stiction.friction.registry import LAWS, register
from stiction.names import public_names, session_name
from stiction.presets.preset import preset

ROOMS = [
    "stiction",
    *(f"stiction.{room}" for room in ("analysis", "linear_stability", "plotting", "results")),
]
SESSION = {
    *("Slider", "Description", "Settings", "Initial", "ConstantVelocity", "Coulomb"),
    *("ExponentialWeakening", "Trajectory", "Record", "Study", "Grid", "Random", "Sobol"),
    *("Threads", "Processes", "Scheduler"),
    *("Values", "Status", "StictionError", "DescriptionError", "ResultError"),
    *("simulate", "run", "load", "export", "init", "analyse", "analyze", "audit", "stability"),
    *("compare", "check", "sweep", "refine", "open_study", "map", "plot", "paper"),
    *("analysis", "laws", "linear_stability", "plotting", "presets", "protocols", "results"),
    *("testing", "theory", "Spring", "Sensor", "read_record", "read_records"),
    *("measure", "mechanism"),
    *("explore", "animate", "listen", "fit", "design", "Rig"),
}


def room_of(name):
    return st if name == "stiction" else getattr(st, name.partition(".")[2])


@pytest.mark.parametrize("name", ROOMS)
def test_what_a_room_lists_is_there(name):
    room = room_of(name)
    assert room.__all__ == sorted(public_names(name))
    for each in public_names(name):
        assert getattr(room, each).__name__.rpartition(".")[2] in (each, "analyse")
        assert each in dir(room)
    with pytest.raises(AttributeError, match=f"module '{name}' has no attribute 'nonsense'"):
        room.nonsense  # noqa: B018


@pytest.mark.parametrize("name", ROOMS)
def test_no_submodule_hides_a_function_of_its_name(name):
    room = room_of(name)
    below = {each.name for each in iter_modules(getattr(room, "__path__", []))}
    hidden = {
        each for each in below & {*public_names(name)} if not inspect.ismodule(getattr(room, each))
    }
    assert not hidden


@pytest.mark.parametrize("name", ROOMS)
def test_a_stub_is_one_line_a_name(name):
    """Public for type checkers: imported from where it stands under its own name."""
    lines = Path(f"{room_of(name).__file__}i").read_text("utf-8").splitlines()
    named = [line.split() for line in lines if line.startswith("from")]
    assert [words[3] for words in named] == [words[5] for words in named]
    assert [words[3] for words in named] == [*public_names(name)]


def test_a_session_sees_what_it_uses():
    assert {name for name in dir(st) if not name.startswith("__")} == SESSION


def test_a_class_is_spelled_as_a_session_writes_it():
    assert session_name(st.Slider) == "st.Slider"
    assert session_name(st.Coulomb) == "st.Coulomb"
    assert session_name(st.protocols.Hold) == "st.protocols.Hold"

    class Coulomb(st.Coulomb):
        """A law of a user with the name of ours."""

    assert session_name(Coulomb) == "Coulomb"
    Coulomb.__module__ = "stiction.text.validation"
    assert session_name(Coulomb) == "Coulomb"


def test_a_name_in_a_registry_is_that_of_one_thing():
    """Who described an apparatus with 'coulomb' would have got another law without a word."""
    own = LAWS["coulomb"]
    other = type("Other", (own,), {"__module__": "mine"})
    message = r"the law 'coulomb' is stiction.*\.Coulomb; give mine.Other another name"
    with pytest.raises(st.StictionError, match=message):
        register("coulomb")(other)
    assert LAWS["coulomb"] is own
    assert register("coulomb")(own) is own  # its module, loaded anew

    def leine_belt():
        """Another one."""

    fields = dict.fromkeys(("shows", "reference", "doi", "grade", "published"), "")
    with pytest.raises(st.StictionError, match="the preset 'leine-belt' is stiction"):
        preset(print, **fields)(leine_belt)
    assert st.presets.find("leine-belt").make.__module__ != __name__


def test_a_line_that_names_no_file_is_named_where_it_is_used(monkeypatch):
    """One wrong line does not disable the command line."""
    absent = function_of("nonsense")
    message = r"COMMANDS names 'nonsense', stiction/cli/commands/nonsense.py: there is no such file"
    with pytest.raises(st.StictionError, match=message):
        absent()
    monkeypatch.setitem(BESIDE, "nonsense", "run")
    with pytest.raises(st.StictionError, match=r"commands/run.py: it has no function nonsense"):
        function_of("nonsense")()
    monkeypatch.setattr(parts, "PARTS", ("motion", "nonsense"))
    with pytest.raises(st.StictionError, match=r"PARTS names 'nonsense'.*; correct the line, or"):
        [*parts.functions("section")]
