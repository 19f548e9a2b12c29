"""Public names refuse in words what they cannot use: argument, rule, value and remedy."""

from __future__ import annotations

import inspect
import pickle
import re
import traceback
from enum import EnumMeta
from pkgutil import resolve_name
from types import FunctionType

import matplotlib as mpl
import numpy as np
import pytest
from tests.docs.test_reference import public_objects

import stiction as st
from stiction.arguments import FROM_ZERO, _patient, address, doorway, is_list
from stiction.errors import echo

mpl.use("Agg")
NO_ONE_S = (b"12", object())  # nothing takes bytes
NONSENSE = (5, "x", None, [], {}, *NO_ONE_S)
SERVER, WRITERS = {"explore"}, {"init", "paper"}  # serves a page; write x
LATE = {"analysis.stream_spectrogram", "testing.checks_of"}  # fail when what they return is used
# results of functions, and the parts of a published system
MADE = {"Trajectory", "Rig", "results", "analysis", "linear_stability", "presets"}


def is_called(name, each):
    """Whether users call it: results are returned to them, errors raised, statuses compared."""
    if isinstance(each, FunctionType):
        return name not in SERVER | WRITERS | LATE
    kinds = isinstance(each, EnumMeta) or (isinstance(each, type) and issubclass(each, Exception))
    return not kinds and name.partition(".")[0] not in MADE


PAPER = st.presets.nakano_popov_2020()
NAMES = public_objects().values()
CALLED = {name: resolve_name(f"stiction:{name}") for name in sorted(NAMES)}
CALLED = {name: each for name, each in CALLED.items() if is_called(name, each)}


def call(public, value):
    """Call a public function or class with this value for each argument that it needs."""
    shape = inspect.signature(public).parameters.values()
    needed = [each for each in shape if each.default is each.empty]
    names = [each.name for each in needed if each.kind is each.KEYWORD_ONLY]
    places = sum(each.kind is each.POSITIONAL_OR_KEYWORD for each in needed)
    return public(*[value] * max(1, places), **dict.fromkeys(names, value))


def outcome(public, value):
    """Return the error of such a call; None if there is none."""
    try:
        call(public, value)
    except Exception as error:
        return error
    return None


def is_arity(error):
    """Whether Python itself refused the call, before the first line of the function."""
    said = ("positional argument", "keyword argument", "multiple values", " takes ")
    return isinstance(error, TypeError) and any(words in str(error) for words in said)


@pytest.mark.parametrize("name", CALLED)
def test_nonsense_is_refused_in_words(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for value in NONSENSE:
        error = outcome(CALLED[name], value)
        told = "".join(traceback.format_exception(error))
        assert error is not None or not any(value is each for each in NO_ONE_S), value
        assert error is None or isinstance(error, st.StictionError) or is_arity(error), told
        for found in re.findall(r"help\(st\.([^)]+)\)", told):
            assert resolve_name(f"stiction:{found}") is CALLED[name]
    assert not [*tmp_path.iterdir()]


def test_the_registry_is_not_empty():
    assert len(CALLED) > 120


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: st.simulate(PAPER, 1, max_steps=1.5), r"number, is 1.5; see help\(st.simulate\)"),
        (lambda: st.Grid(1, 2, "many"), "Grid.count: must be a whole number, is 'many'"),
        (lambda: st.protocols.reversal_loops(1, 1, loops="2"), r"help\(st.protocols.reversal_l"),
        (lambda: st.check(5), r"path: must be text or a path, is 5; see help\(st.check\)"),
        (lambda: st.read_record(5), r"must be text or a path or a Dataset or a DataFrame, is 5;"),
        (lambda: st.Slider(5), r"Slider: its values have names, 5 has none; write Slider\(mass="),
        (lambda: st.Grid(1, 2, 3, "log", None, 7), "its values have names, 7 has none"),
        (lambda: st.protocols.velocity_steps(b"12", duration=1), "must be a list of at least one"),
        (lambda: st.protocols.end(5), "5 is not a program"),
        (lambda: st.Description(5, 6, 7), r"5 is not a Slider; make one with st.Slider\(...\)"),
        (lambda: st.plotting.plot_posterior("x"), "fit: must be a Fit, is 'x'; see help"),
        (lambda: st.plotting.plot_comparison({}), "there is no run to compare"),
        (lambda: st.analysis.summary([]), r"must be a Dataset, is \[\]; see help\(st.analysis"),
        (lambda: st.theory.critical_angle("x"), "numbers in SI, or arrays of them, not 'x'"),
        (lambda: st.theory.critical_angle(None), "numbers in SI, or arrays of them, not None"),
    ],
)
def test_the_message_names_the_rule_the_value_and_the_remedy(wrong, words):
    with pytest.raises(st.StictionError, match=words):
        wrong()


FUNCTIONS = [each for each in CALLED.values() if isinstance(each, FunctionType)]


def test_where_a_message_sends_its_reader_there_is_the_function():
    found = {
        each: resolve_name(str(address(each)).replace("st.", "stiction:", 1)) for each in FUNCTIONS
    }
    assert [each for each in FUNCTIONS if found[each] is not each] == []


def whole_numbers():
    """Yield each public function or class, and the name of an argument that is a whole number."""
    for name, each in CALLED.items():
        for argument in inspect.signature(each).parameters.values():
            hint = argument.annotation
            hint = getattr(hint, "__name__", hint)
            if isinstance(hint, str) and re.search(r"\bint\b", hint):
                yield pytest.param(each, argument, id=f"{name}-{argument.name}")


@pytest.mark.parametrize(("public", "argument"), [*whole_numbers()])
def test_a_whole_number_is_read_whatever_its_type(public, argument):
    """The outcome is that of an integer, an error of the rest or none; others are named."""
    shape = inspect.signature(public).parameters.values()
    needed = [each.name for each in shape if each.default is each.empty and each != argument]
    others = dict.fromkeys(needed, object())

    def told(value):
        try:
            made = str(public(**others, **{argument.name: value}))
        except st.StictionError as error:
            made = str(error)
        return re.sub("object at 0x[0-9a-f]+", "", made)

    least = 0 if argument.name in FROM_ZERO else 1
    good = told(4)
    for value in (4.0, np.int64(4), np.uint8(4), np.float32(4.0), np.array(4)):
        assert told(value) == good
    for value in (4.5, True, np.True_, np.nan, np.inf):
        assert f"{argument.name}: must be a whole number, is {echo(value)}" in told(value)
    assert re.search(rf"{argument.name}: must .*[0-9], is {least - 1}", told(least - 1))


def test_an_error_of_another_origin_stays_what_it_is():
    def divide(number: float) -> float:
        return 1.0 / number

    with pytest.raises(ZeroDivisionError):
        doorway(divide, "stiction", "divide")(0.0)
    with pytest.raises(st.DescriptionError, match="number: must be a number, is '0'"):
        doorway(divide, "stiction", "divide")("0")
    with pytest.raises(TypeError, match="unexpected keyword argument 'nonsense'"):
        st.check("x", nonsense=1)


def test_a_public_function_is_one_object_that_can_be_sent_to_another_process():
    assert st.simulate is st.simulate
    assert pickle.loads(pickle.dumps(st.simulate)) is st.simulate
    assert pickle.loads(pickle.dumps(st.analysis.summary)) is st.analysis.summary
    assert "duration" in inspect.signature(st.simulate).parameters


@pytest.mark.parametrize("verb", [st.load, st.animate, st.listen, st.open_study, st.check])
def test_a_number_in_place_of_a_path_leaves_open_files_alone(verb, tmp_path):
    with (tmp_path / "x").open("w") as file:
        with pytest.raises(st.DescriptionError, match=r"must be .* path.*, is \d+"):
            verb(file.fileno())
        file.write("still open")


def test_lists_are_what_has_values_in_order():
    assert all(map(is_list, ([1], (1, 2), np.ones(2), {"a": 1}.values())))
    assert not any(map(is_list, ("1", b"1", {"a": 1}, {1, 2}, 5, None, iter([1]))))


def test_a_whole_number_elsewhere_does_not_make_a_wrong_path_of_another_argument(paper_run):
    """Beside ``simulations=500`` a slider was refused as a path; alone, what it lacks was told."""
    record, slider = st.measure(paper_run, st.Sensor()), st.presets.nakano_popov_2020()
    for options in ({}, {"simulations": 500}):
        with pytest.raises(st.DescriptionError, match=r"nothing is uncertain.*in Python st\.Rig"):
            st.fit(record, slider, **options)


def test_a_session_that_raises_an_error_at_underflow_is_no_obstacle():
    """``np.seterr(all="raise")``: the tails of distributions, of which audits and analyses take."""
    rig = {"mass": 0.1, "k_x": 2e3, "k_y": 4e6, "phi": "40 deg", "normal_load": 6.0}
    law = st.ExponentialWeakening(mu_0=0.25, mu_inf=0.15, v_f="10 mm/s")
    slider = st.presets.nakano_popov_2020().replace(friction=law, **rig)
    with np.errstate(all="raise"):
        run = st.simulate(slider, "10 s", sample_rate="20 kHz")
        for found in (st.analyse(st.measure(run, st.Sensor(noise="0.1 mN"))), st.audit(slider)):
            assert str(found)
        assert {*np.geterr().values()} == {"raise"}  # as it was


RUN = st.simulate(PAPER, "20 s", sample_rate="1 kHz")
RIG = st.Rig(PAPER, {"phi": "1 +- 0.5 deg"})
TOGETHER = {  # a call with a whole number, and an argument that is refused
    "simulate": lambda count, **wrong: st.simulate(PAPER, "1 s", max_steps=count, **wrong),
    "run": lambda count, description=RUN.description: st.run(description, max_steps=count),
    "compare": lambda count, laws="coulomb": st.compare(RUN.description, laws, max_steps=count),
    "measure": lambda count, **wrong: st.measure(RUN, st.Sensor(), seed=count, **wrong),
    "fit": lambda count, rig=RIG: st.fit(RUN, rig, simulations=count),
    "mechanism": lambda count, rig=RIG: st.mechanism(RUN, rig, simulations=count),
    "design": lambda count, **wrong: st.design(RIG, simulations=count, **wrong),
    "audit": lambda count, slider=RIG: st.audit(slider, simulations=count),
}
REFUSED = {
    "simulate": ({"rtol": 5.0}, "rtol"),
    "run": ({"description": "x.toml"}, ""),
    "compare": ({"laws": "bogus"}, "law bogus"),
    "measure": ({"sample_rate": "1 kg"}, "sample_rate"),
    "fit": ({"rig": PAPER}, "slider"),
    "mechanism": ({"rig": PAPER}, "slider"),
    "design": ({"noise": "1 kg"}, "noise"),
    "audit": ({"slider": "x.toml"}, ""),
}


@pytest.mark.parametrize("name", TOGETHER)
def test_a_wrong_whole_number_hides_no_fault_of_another_argument(name):
    wrong, path = REFUSED[name]
    with pytest.raises(st.DescriptionError) as error:
        TOGETHER[name](1.5, **wrong)
    first, second = error.value.faults
    assert first.path.endswith(path)
    assert "must be a whole number, is 1.5" in second.message


@pytest.mark.parametrize("name", TOGETHER)
def test_a_wrong_whole_number_alone_is_refused_before_the_work(name, monkeypatch):
    """A long run would begin; each function that waits says when it has read its arguments."""
    monkeypatch.setattr("stiction.simulation.integrate", lambda *_, **__: pytest.fail("it works"))
    with pytest.raises(st.DescriptionError, match=r"must be a whole number, is 1.5; see help\(st"):
        TOGETHER[name](1.5)


def test_every_function_that_reads_its_arguments_together_is_tried():
    assert {each.__name__ for each in _patient} == set(TOGETHER)


def quantities():
    """Yield each public function with a quantity, its other arguments, and whether it is needed."""
    P = st.protocols
    calls = (
        (st.measure, {"sensor": st.Sensor()}, "sample_rate"),
        (st.simulate, {"slider": PAPER, "duration": "1 ms"}, "duration sample_rate regularisation"),
        (st.compare, {"description": PAPER, "laws": ["coulomb"]}, "duration"),
        (st.design, {"rig": st.Rig(PAPER, {"phi": "1 +- 1 deg"})}, "noise position_noise"),
        (st.animate, {}, "length at"),
        (st.plotting.plot_law, {"slider": PAPER}, "fastest"),
        (st.theory.damping_number_of, {"slider": PAPER, "V": "1 mm/s"}, "V phi"),
        (P.load_ramp, {"levels": ["20 N"], "ramp": "1 s"}, "ramp hold"),
        (P.reversal_loops, {"velocity": "1 mm/s", "travel": "1 mm"}, "velocity travel"),
        (P.slide_hold_slide, {"velocity": 1e-3, "holds": [1.0], "slide": 1.0}, "velocity slide"),
        (P.velocity_steps, {"velocities": [1e-3, 2e-3]}, "duration distance"),
    )
    for public, values, names in calls:
        for name in names.split():
            optional = "None" in inspect.signature(public).parameters[name].annotation
            yield pytest.param(public, values, name, optional, id=f"{public.__name__}-{name}")


@pytest.mark.parametrize(("public", "values", "name", "optional"), [*quantities()])
def test_what_is_not_one_quantity_is_refused_by_its_name(public, values, name, optional):
    """An array as a sample rate showed NumPy's "truth value of an array is ambiguous"."""
    if public in (st.measure, st.animate):
        values = values | {"run": st.simulate(PAPER, "2 ms", sample_rate="10 kHz")}
    several = np.array([1.0, 2.0]), [1.0, 2.0], np.array(["1 s", "2 s"]), np.array([])
    for wrong in (*several, True, np.nan, np.inf, 1j, {}, *([] if optional else [None])):
        with pytest.raises(st.StictionError, match=rf"\b{name}\b"):
            public(**values | {name: wrong})
