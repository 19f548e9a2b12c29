"""Compilation in a second process."""

import sys

import numba
import pytest

from stiction.solver.compilation import ahead, machine_code, pointer
from stiction.solver.multiscale import method
from stiction.solver.segments import segments

KINDS = (numba.types.UniTuple(numba.int32, 3), numba.types.int64)  # as nothing else is compiled


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache, for this process and its children."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(ahead, "CORES", 2)
    machine_code.folder.cache_clear()
    yield tmp_path
    machine_code.folder.cache_clear()


def test_the_second_process_leaves_code_in_the_cache(cache, monkeypatch):
    """Nothing of the working folder runs there."""
    (cache / "numba.py").write_text("raise SystemExit(1)")
    monkeypatch.chdir(cache)
    assert not ahead.is_compiled(pointer.write, KINDS)
    ahead.compile_beside(pointer.write, KINDS)()
    assert ahead.is_compiled(pointer.write, KINDS)
    (code,) = cache.glob("compiled-*/*.code")
    assert "pointer.write" in code.name
    assert ahead._begun[-1].returncode == 0


@pytest.mark.parametrize("fault", ["one core", "no such program", "a program that fails"])
def test_without_a_second_process_nothing_is_left_and_nothing_fails(cache, monkeypatch, fault):
    if fault == "one core":
        monkeypatch.setattr(ahead, "CORES", 1)
    program = str(cache / "none") if fault == "no such program" else "/bin/false"
    monkeypatch.setattr(sys, "executable", program)
    ahead.compile_beside(pointer.write, KINDS)()
    assert not ahead.is_compiled(pointer.write, KINDS)


def test_second_processes_end_with_the_first(cache):
    count = len(ahead._begun)
    ahead.compile_beside(pointer.write, KINDS)
    ahead.end()
    assert len(ahead._begun) == count + 1
    assert all(begun.returncode is not None for begun in ahead._begun)


@pytest.mark.parametrize("steps_are_there", [True, False])
def test_the_map_is_compiled_beside_steps_that_are_not_there(monkeypatch, slider, steps_are_there):
    """Where steps are there, a run in steps takes milliseconds: there is nothing to use."""
    begun, waited = [], []
    monkeypatch.setattr(method, "_met", set())
    monkeypatch.setattr(method, "_compiled_beside", {})
    monkeypatch.setattr(
        method,
        "is_compiled",
        lambda function, kinds: steps_are_there and function is method.advance,
    )
    monkeypatch.setattr(
        method,
        "compile_beside",
        lambda function, kinds: begun.append(function) or (lambda: waited.append(function)),
    )
    solver = method.Multiscale(slider, 1e-6)
    problem = next(segments(slider, 0.0, 1.0)).problem
    for _ in range(2):
        solver.compile_map(problem)
    assert begun == ([] if steps_are_there else [method.stride])
    assert not waited
