"""Messages: values in them are shortened, however large they are."""

import ast
import re
from collections.abc import Callable
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

import stiction as st
from stiction.errors import (
    ECHOED,
    MOST_FAULTS,
    DescriptionError,
    Fault,
    Faults,
    Instruction,
    echo,
    in_terminal,
)

PAPER = st.presets.nakano_popov_2020()
MANY = 20_000
LARGE = {
    "array": np.arange(MANY) / 3.0,
    "matrix": np.zeros((200, 300)),
    "list": (np.arange(MANY) / 3.0).tolist(),
    "text": "x" * MANY,
    "table": {f"key {i}": i for i in range(MANY)},
    "slider": PAPER,
    "integer": 10**3000,
}
FIELDS = ("mass", "k_x", "phi", "normal_load", "friction", "drive", "load", "c_x", "driven")
KNOWN = ("stiffness", "normal_load", "zero", "sensors", "origin", "time_unit", "force")
RECORD = {"time": np.arange(9.0), "force": np.ones(9)}
RUN = st.simulate(PAPER, "1 ms", sample_rate="10 kHz")
PLACES: dict[str, Callable[[object], object]] = {
    **{name: lambda value, name=name: PAPER.replace(**{name: value}) for name in FIELDS},
    **{f"record {name}": lambda value, name=name: st.Record(**RECORD | {name: value})
       for name in KNOWN},
    "springs": lambda value: PAPER.replace(springs=value),
    "name of a spring": lambda value: st.Spring(value, k_x="1 N/m", k_y="1 N/m"),
    "simulate": lambda value: st.simulate(value, "1 s"),
    "duration": lambda value: st.simulate(PAPER, value),
    "sample_rate": lambda value: st.simulate(PAPER, "1 ms", sample_rate=value),
    "initial": lambda value: st.simulate(PAPER, "1 ms", initial=value),
    "max_steps": lambda value: st.simulate(PAPER, "1 ms", max_steps=value),
    "velocity": st.ConstantVelocity,
    "program": lambda value: st.protocols.DriveProgram(program=value),
    "piece": lambda value: st.protocols.DriveProgram(program=[value]),
    "hold": lambda value: st.protocols.Hold(duration=value),
    "coefficient": lambda value: st.Coulomb(mu_0=value),
    "table of a law": lambda value: st.laws.Table(v=value, mu=value),
    "sensor": lambda value: st.Sensor(noise=value),
    "unit of a sensor": lambda value: st.Sensor(unit=value),
    "ends of an axis": lambda value: st.Grid(value, value, 3),
    "analyse": lambda value: st.analyse([value]),
    "edges": lambda value: st.analysis.energy_budget(RUN, value),
    "fit": lambda value: st.fit(value, PAPER),
}  # fmt: skip


@pytest.mark.parametrize("kind", LARGE)
@pytest.mark.parametrize("place", PLACES)
def test_no_message_holds_a_large_value_whole(place, kind):
    """A line has the rule, the value and the remedy, and names of a path."""
    try:
        PLACES[place](LARGE[kind])
    except st.StictionError as error:
        lines = str(error).splitlines()
        assert len(lines) <= MOST_FAULTS + 1
        assert max(map(len, lines)) < 5 * ECHOED


@pytest.mark.parametrize("value", LARGE.values(), ids=LARGE.keys())
def test_a_value_is_echoed_in_one_short_line(value):
    shown = echo(value)
    assert len(shown) <= ECHOED + 2
    assert "\n" not in shown


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        ("1 kg", "'1 kg'"),
        (0.1, "0.1"),
        (np.float64(0.5), "0.5"),
        ([1, 2], "[1, 2]"),
        ({"a": 1}, "{'a': 1}"),
        ("y" * ECHOED, repr("y" * ECHOED)),
        (None, "None"),
    ],
)
def test_a_short_value_is_echoed_as_it_is(value, shown):
    assert echo(value) == shown


def test_a_value_that_cannot_be_printed_is_named():
    class Strange:
        def __repr__(self) -> str:
            raise ValueError

    assert "Strange" in echo(Strange())


def test_faults_beyond_a_hundred_are_counted_and_kept():
    error = DescriptionError([Fault(f"springs.{i}", "is not a spring") for i in range(250)])
    assert len(error.faults) == 250
    assert str(error).splitlines()[-1] == "and 150 more faults"


def values_by_repr(tree: ast.AST) -> list[str]:
    """Return the values that the messages of a module print by `!r`, constants left out."""
    found = []
    for call in ast.walk(tree):
        name = ast.unparse(call.func).rpartition(".")[2] if isinstance(call, ast.Call) else ""
        if name not in {"Fault", "fault", "_fault", "_refuse"} and not name.endswith("Error"):
            continue
        for part in ast.walk(call):
            if isinstance(part, ast.FormattedValue) and part.conversion == ord("r"):
                found.append(ast.unparse(part.value))
    return found


def test_messages_print_values_by_echo():
    """By `!r` only what is short: an example, a constant, a slice, the name of a member."""
    short = {"kind.example", "KINDS[name].unit", "name", "module", "room", "self.smoothing"}
    source = Path(st.__file__).parent
    wrong = [
        f"{path.relative_to(source)}: {value}"
        for path in source.rglob("*.py")
        if not path.is_relative_to(source / "solver")
        for value in values_by_repr(ast.parse(path.read_text(encoding="utf-8")))
        if value not in short and not value.isupper() and ":" not in value
    ]
    assert wrong == []


def texts_of(tree: ast.AST) -> list[str]:
    """Return the texts of a module, without docstrings."""
    bodies = [getattr(node, "body", None) for node in ast.walk(tree)]
    firsts = [body[0] for body in bodies if isinstance(body, list) and body]
    docs = {id(each.value) for each in firsts if isinstance(each, ast.Expr)}
    texts = (x for x in ast.walk(tree) if isinstance(x, ast.Constant) and id(x) not in docs)
    return [x.value for x in texts if isinstance(x.value, str)]


def test_an_argument_that_a_message_suggests_is_no_option_to_everybody():
    """`Suggestion` writes it as whoever called does; only whole commands stand in a message."""
    source, option = Path(st.__file__).parent, re.compile(r"(?<![\w-])--[a-z]")
    files = (each for each in source.rglob("*.py") if not each.is_relative_to(source / "cli"))
    modules = {each: each.read_text(encoding="utf-8") for each in files}
    wrong = [
        f"{path.relative_to(source)}: {text}"
        for path, module in modules.items()
        if option.search(module)
        for text in texts_of(ast.parse(module))
        if option.search(text) and not re.search("stiction (fit|run|sweep)|uv run|^ --", text)
    ]
    assert wrong == []


class Refusal(st.StictionError):
    """An error of its own kind."""


class Unclear(st.ResultError):
    """An error of a file that takes more than a text."""

    def __init__(self, what: str, remedy: str) -> None:
        super().__init__(f"{what}; {remedy}")


@pytest.mark.parametrize(
    ("errors", "kind"),
    [
        ([Refusal("a"), Refusal("b")], Refusal),
        ([Refusal("a"), st.ResultError("b")], st.ResultError),
        ([Refusal("a"), st.StictionError("b")], st.ResultError),
        ([Unclear("a", "c"), Unclear("b", "d")], st.ResultError),
        ([DescriptionError.of("x", "a"), Refusal("b")], st.ResultError),
    ],
)
def test_faults_of_one_kind_keep_it(errors, kind):
    faults = Faults()
    for error in errors:
        with faults.of_part():
            raise error
    with pytest.raises(kind) as raised:
        faults.refuse()
    assert type(raised.value) is kind
    assert len(str(raised.value).splitlines()) == 2


COMMAND = re.compile(r"\bstiction (run|sweep|init|map|plot|analyse|audit|fit|check|design)\b")
REPORTS = ("auditing", "linear_stability", "explorer")  # are read on paper and on a page, too


def commands_in(tree: ast.AST) -> list[str]:
    """Return the texts of a module that name a command to everybody."""
    calls = [x for x in ast.walk(tree) if isinstance(x, ast.Call)]
    made = [x for x in calls if getattr(x.func, "id", "") == "Instruction"]
    for_typists = {id(each) for call in made for each in ast.walk(call.args[0])}
    texts = [x for x in ast.walk(tree) if isinstance(x, ast.Constant) and id(x) not in for_typists]
    own = {*texts_of(tree)}
    return [x.value for x in texts if x.value in own and COMMAND.search(x.value)]


def test_a_message_names_a_command_only_to_those_who_type_commands():
    """In Python, a missing file was to be written "with 'stiction run'"."""
    source = Path(st.__file__).parent
    files = (
        x for x in source.rglob("*.py") if not {*x.relative_to(source).parts} & {"cli", *REPORTS}
    )
    found = {text for x in files for text in commands_in(ast.parse(x.read_text(encoding="utf-8")))}
    # these name the function of Python beside the command; ready studies have none
    both = re.compile(r"st\.Rig|export\(\.\.\.\)|in a terminal")
    assert [text for text in found if not both.search(text)] == []


def test_an_error_of_a_thread_is_told_where_the_command_was_typed():
    """Chunks of a store are read by threads: their errors named calls of Python in a terminal."""
    said = []
    instruction = Instruction("stiction check", "st.check(path)")
    thread = Thread(target=lambda: said.append(str(instruction)))
    with in_terminal():
        thread.start()
        thread.join()
    assert said == ["stiction check"]
    assert str(instruction) == "st.check(path)"
