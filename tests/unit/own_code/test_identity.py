"""Everything that a user's law or measure reads belongs to its identity."""

import json
import os
import re
import subprocess
import sys
from enum import Enum
from functools import lru_cache, partial, wraps
from math import exp, log1p
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
import pytest
from numba import njit, vectorize
from numba.extending import register_jitable
from tests.waiting import PATIENCE

import stiction as st
from stiction.own_code.identity import differences, state_of, values_outside
from stiction.study.execution.cores import Cores
from stiction.study.execution.engines import Processes, Threads
from stiction.study.execution.repair import restore

b = 0.01
TABLE = np.array([0.2, 0.01])
HELPERS = ModuleType("helpers")
HELPERS.loss = 0.01


@njit
def loss_at(v):
    return b * log1p(v / 1e-4)


@njit("float64(float64)")
def stated_loss(v):
    return b * log1p(v / 1e-4)


@register_jitable
def extended_loss(v):
    return b * log1p(v / 1e-4)


@njit
def loss_in_turn(v, n):
    return b * log1p(v / 1e-4) if n == 0 else in_turn(v, n - 1)


@njit
def in_turn(v, n):
    return loss_in_turn(v, n - 1) + 0.0 * b if n > 0 else b * log1p(v / 1e-4)


class ByField(NamedTuple):
    mu: float = 0.2
    b: float = 0.01

    def coefficient(law, v):
        return law.mu - law.b * log1p(v / 1e-4)

    def slope(law, v):
        return -law.b / (1e-4 + v)


class ByVariable(NamedTuple):
    mu: float = 0.2

    def coefficient(law, v):
        return law.mu - b * log1p(v / 1e-4)

    def slope(law, v):
        return -b / (1e-4 + v)


class ByFunction(NamedTuple):
    mu: float = 0.2

    def coefficient(law, v):
        return law.mu - loss_at(v)

    def slope(law, v):
        return -b / (1e-4 + v)


class BySignature(ByFunction):
    def coefficient(law, v):
        return law.mu - stated_loss(v)


class ByExtension(ByFunction):
    def coefficient(law, v):
        return law.mu - extended_loss(v)


class ByRecursion(ByFunction):
    def coefficient(law, v):
        return law.mu - loss_in_turn(v, 3)


class ByArray(NamedTuple):
    unused: float = 0.0

    def coefficient(law, v):
        return TABLE[0] - TABLE[1] * log1p(v / 1e-4)

    def slope(law, v):
        return -TABLE[1] / (1e-4 + v)


class ByModule(NamedTuple):
    mu: float = 0.2

    def coefficient(law, v):
        return law.mu - HELPERS.loss * log1p(v / 1e-4)

    def slope(law, v):
        return -HELPERS.loss / (1e-4 + v)


def law_of_closure(mu):
    c = b

    class ByClosure(NamedTuple):
        unused: float = 0.0

        def coefficient(law, v):
            return mu - c * log1p(v / 1e-4)

        def slope(law, v):
            return -c / (1e-4 + v)

    def change(to):
        nonlocal c
        c = to

    return ByClosure, change


def set_variable(monkeypatch, to):
    monkeypatch.setattr(sys.modules[__name__], "b", to)


def set_array(monkeypatch, to):
    TABLE[1] = to


def set_module(monkeypatch, to):
    HELPERS.loss = to


KINDS = {
    "variable": ByVariable,
    "function": ByFunction,
    "signature": BySignature,
    "extension": ByExtension,
    "recursion": ByRecursion,
    "array": ByArray,
    "module": ByModule,
}


@pytest.fixture(params=[*KINDS, "closure"])
def law_and_change(request, monkeypatch):
    """A law that reads its parameter b elsewhere, and what changes that."""
    name = request.param
    if name == "closure":
        kind, change = law_of_closure(0.2)
        yield kind(), change
        return
    change = {"array": set_array, "module": set_module}.get(name, set_variable)
    yield KINDS[name](), partial(change, monkeypatch)
    change(monkeypatch, 0.01)


def force_of(slider, law):
    return st.simulate(slider.replace(friction=law), "1 s", sample_rate=100).samples["spring_x"]


@pytest.mark.parametrize("of", [lambda law: law, partial(st.laws.Anisotropic, ratio=1.5)])
def test_a_run_has_the_values_of_now(slider, law_and_change, of):
    """numba froze those of the first run: the slider's own coefficient said otherwise."""
    law, change = law_and_change
    loss_at(1e-3)  # compiled before, with the first value
    slider = slider.replace(friction=of(law))
    for value in (0.01, 0.001, 0.01):
        change(value)
        found = st.simulate(slider, "1 s", sample_rate=100).samples["spring_x"]
        wanted = force_of(slider, of(ByField(b=value)))
        np.testing.assert_allclose(found, wanted, rtol=1e-4)  # that of a run; constants are folded
        assert slider.law.coefficient(0.01) == ByField(b=value).coefficient(0.01)


def test_a_law_is_checked_with_the_values_of_now(slider, monkeypatch):
    assert slider.replace(friction=ByVariable())
    set_variable(monkeypatch, 0.1)
    with pytest.raises(st.DescriptionError, match=r"'ByVariable' is -0\.0"):
        slider.replace(friction=ByVariable())


LOG = open(os.devnull, "w")  # noqa: SIM115


class Writing(NamedTuple):
    mu: float = 0.2

    def coefficient(law, v):
        return law.mu

    def slope(law, v):
        LOG.write("")
        return 0.0


def test_a_law_that_reads_the_unknown_is_refused(slider):
    told = r"Writing reads LOG, a TextIOWrapper, .* make it a field of the class, or a number"
    with pytest.raises(st.DescriptionError, match=told):
        slider.replace(friction=Writing())


LAW = """
import os
from math import log1p
from typing import NamedTuple
from numba import njit

b = float(os.environ["LOSS"])

@njit(cache=True)
def loss_at(v):
    return b * log1p(v / 1e-4)

class Mine(NamedTuple):
    mu: float = 0.2
    def coefficient(law, v): return law.mu - loss_at(v)
    def slope(law, v): return -b / (1e-4 + v)
"""
RUN = """
import stiction as st
from ownlaw import Mine
base = st.presets.nakano_popov_2020().replace(friction=Mine())
run = st.simulate(base, "1 s", sample_rate=100)
print(run.samples["spring_x"].max())
"""


def python(code, folder, **environment):
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_stored_machine_code_has_the_values_that_it_is_named_after(tmp_path, slider, code_cache):
    """Also where a user lets numba store a function: it does not look at variables."""
    (tmp_path / "ownlaw.py").write_text(LAW)
    cache = {"NUMBA_CACHE_DIR": str(code_cache)}
    for value in (0.01, 0.001, 0.01):
        found = float(python(RUN, tmp_path, LOSS=str(value), **cache))
        assert found == pytest.approx(force_of(slider, ByField(b=value)).max(), rel=1e-4)
    kept = [each for each in code_cache.rglob("*.code") if "coefficient_and_slope" in each.name]
    assert len(kept) == 2


def test_a_result_is_not_read_with_other_values(slider, monkeypatch, tmp_path):
    run = st.simulate(slider.replace(friction=ByVariable()), "50 ms")
    assert json.loads(run.data.attrs["description"])["friction"]["reads"] == {}
    run.save(tmp_path / "a.nc")
    assert st.load(tmp_path / "a.nc").slider == run.slider
    set_variable(monkeypatch, 0.005)
    told = (
        "friction.reads: 'test_identity.py:ByVariable' reads what has changed since it was stored"
    )
    with pytest.raises(st.ResultError, match=f"{told}: b was as in the text and is 0.005"):
        st.load(tmp_path / "a.nc")


K = 3.0


def scale(value):
    return K * value


def peak(run):
    return scale(run.samples["spring_x"].max())


def descriptor(run):
    return float(LOG.fileno())


def study_of(*measures, friction=None):
    slider = st.presets.nakano_popov_2020()
    slider = slider if friction is None else slider.replace(friction=friction)
    base = st.Description.of(slider, "50 ms")
    return st.Study(base=base, axes={"phi": st.Values(["1 deg", "2 deg"])}, measures=measures)


def values(path, name):
    with st.open_study(path) as data:
        return data[name].values


def test_a_measure_that_reads_another_value_is_another_study(tmp_path, monkeypatch):
    """The old numbers were handed out."""
    study, path = study_of(peak), tmp_path / "a.zarr"
    st.sweep(study, path, engine=Threads(1))
    monkeypatch.setattr(sys.modules[__name__], "K", 30.0)
    told = r"another study: study.measures.1.reads.K of scale is nothing there and '30.0' here"
    with pytest.raises(st.ResultError, match=told):
        st.sweep(study, path, engine=Threads(1))
    st.sweep(study, tmp_path / "b.zarr", engine=Threads(1))
    ten = values(tmp_path / "b.zarr", "peak") / values(path, "peak")
    np.testing.assert_allclose(ten, 10.0)
    with st.open_study(path) as data:
        restored = st.Study.from_json(data.attrs["description"])
    with pytest.raises(st.DescriptionError, match="peak reads what has changed since"):
        st.sweep(restored, tmp_path / "c.zarr", engine=Threads(1))
    assert restore(path) == []


def test_a_law_that_reads_another_value_is_another_study(tmp_path, monkeypatch):
    study = study_of("peak_force", friction=ByVariable())
    st.sweep(study, tmp_path / "a.zarr", engine=Threads(1))
    set_variable(monkeypatch, 0.005)
    with pytest.raises(st.ResultError, match=r"another study: friction\.reads\.b is"):
        st.sweep(study, tmp_path / "a.zarr", engine=Threads(1))


def test_a_measure_that_reads_the_unknown_is_refused():
    told = (
        "descriptor reads LOG, a TextIOWrapper, .* make it inside the function, or a number, a text"
    )
    with pytest.raises(st.DescriptionError, match=told):
        study_of(descriptor)


def test_other_processes_refuse_values_that_they_cannot_know(tmp_path, monkeypatch):
    """They run the text, and would compute with its values; all cores do it here instead."""
    monkeypatch.setattr(sys.modules[__name__], "K", 30.0)
    st.sweep(study_of(peak), tmp_path / "a.zarr", engine=Cores(2))
    st.sweep(study_of(peak), tmp_path / "b.zarr", engine=Threads(2))
    np.testing.assert_array_equal(*(values(tmp_path / f"{each}.zarr", "peak") for each in "ab"))
    told = r"K of scale was 30\.0 and is as in the text; another process knows the text only"
    with pytest.raises(st.DescriptionError, match=told):
        st.sweep(study_of(peak), tmp_path / "c.zarr", engine=Processes(1))


class Settings:
    factor = 2.0
    names = ("a", "b")

    @property
    def twice(self):
        return 2.0 * b

    @staticmethod
    def root(value):
        return exp(value)


def decorator(function):
    @wraps(function)
    def inner(run, by=K):
        return by * function(run)

    return inner


@decorator
@lru_cache
def value_of_all(run):
    return loss_at(run) + Settings.root(Settings.factor) + np.pi


def test_a_function_reads_all_that_its_helpers_read():
    found = {path: token for path, token in state_of(value_of_all) if isinstance(token, str)}
    assert found == {
        "defaults of value_of_all": "(3.0)",
        "np of value_of_all": "module numpy",
        "Settings of value_of_all": "class Settings",
        "Settings.factor": "2.0",
        "Settings.names": "('a', 'b')",
        "log1p of loss_at": "math.log1p",
        "b of loss_at": "0.01",
        "b of Settings.twice": "0.01",
        "exp of Settings.root": "math.exp",
    }
    outside = {"defaults of value_of_all", "Settings.factor", "Settings.names"}
    assert values_outside(value_of_all).keys() == outside


class Point(NamedTuple):
    x: float
    of: object


@pytest.mark.parametrize(
    ("value", "name"),
    [
        ([1, LOG], "value[1], a TextIOWrapper"),
        ({"a": 1, "b": np.random.default_rng(1)}, "value['b'], a numpy.random"),
        (Point(1.0, iter(())), "value.of, a tuple_iterator"),
        (partial(exp, object()), "value()[0], a object"),
        (np.array([object()]), "value, a numpy.ndarray"),
        (np.vectorize(lambda x: x), "value, a numpy.vectorize"),
        (np.frompyfunc(lambda x: x, 1, 1), "value, a numpy.ufunc"),
        (vectorize(lambda x: b * x), "value, a function of numba.vectorize that reads variables"),
    ],
)
def test_the_unknown_is_named(value, name):
    def measure(run):
        return value

    with pytest.raises(ValueError, match=re.escape(name)):
        values_outside(measure)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (0.0, -0.0),
        (1, 1.0),
        (1, True),
        ("1", 1),
        ([1, 2], (1, 2)),
        ({"a": 1}, {"a": 2}),
        (np.zeros(3), np.zeros((3, 1))),
        (np.zeros(1000), np.eye(1, 1000)[0]),
        (range(3), range(4)),
        (Path("a"), Path("b")),
        (Point(1.0, (np.sin,)), Point(1.0, (np.cos,))),
        (st.Coulomb(0.1), st.Coulomb(0.2)),
        (st.presets.nakano_popov_2020(), st.presets.nakano_popov_2020().replace(mass=1.0)),
        (partial(scale, 1), partial(scale, 2)),
        (lambda x: x + 1, lambda x: x + 2),
    ],
)
def test_other_values_are_told_apart(first, second):
    def measure(value):
        return lambda run: value

    assert values_outside(measure(first)) == values_outside(measure(first))
    assert values_outside(measure(first)) != values_outside(measure(second))


def test_differences_are_told_by_name():
    assert differences({"c": "1"}, {"c": "1"}) == ""
    assert differences({"c": "1"}, {}) == "c was 1 and is as in the text"


opened = print  # also the names of local variables below
unread = object()


def test_what_a_function_has_itself_is_not_read_outside():
    def measure(unread):
        opened = 0.1
        return sum(each < opened for each in unread), (lambda x: x * opened + len(unread))(1.0)

    assert values_outside(measure).keys() == {"measure"}


class Mode(Enum):
    SLOW = 1
    FAST = "x"


def test_an_enumeration_is_its_members():
    def measure(run):
        return Mode.SLOW.value

    assert "Mode.FAST" in dict(state_of(measure))
