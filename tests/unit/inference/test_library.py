"""Folders in which simulations are stored: one that is named, and the user's cache."""

import numpy as np
import pytest
from tests.uncertain import TEXT

import stiction as st
from stiction.cli.options import library_or_cache
from stiction.errors import ResultError
from stiction.inference.columns import features_from
from stiction.inference.mechanism import comparison
from stiction.inference.next_test import design as designs
from stiction.inference.simulated.library import (
    BLOCK,
    FIRST_SIMULATIONS,
    Ensemble,
    library_folder,
)
from stiction.storage import arrays
from stiction.storage.arrays import cache_folder, read_arrays, write_arrays


@pytest.fixture
def unwritable(tmp_path):
    """A folder that cannot be made, by anybody: its parent is a file."""
    (tmp_path / "file").write_text("")
    return tmp_path / "file" / "libraries"


@pytest.fixture
def cache(unwritable, monkeypatch):
    """The user's cache, which cannot be written to."""
    monkeypatch.setattr(arrays, "cache_folder", lambda: unwritable)
    monkeypatch.setattr("stiction.inference.simulated.library.cache_folder", lambda: unwritable)
    return unwritable


@pytest.mark.parametrize("name", ["fit", "mechanism", "design"])
def test_a_library_that_cannot_be_made_is_refused_before_simulating(
    name, unwritable, rig, record, monkeypatch
):
    def simulate(*_, **__):
        raise AssertionError("something is simulated")

    for module, function in (
        (Ensemble, "simulate"), (comparison, "simulate"), (designs, "observe"),
    ):  # fmt: skip
        monkeypatch.setattr(module, function, simulate)
    given = (rig, record) if name == "design" else (record, rig)
    with pytest.raises(ResultError, match=r"libraries: cannot be made: "):
        getattr(st, name)(*given, library=unwritable)


def test_an_audit_refuses_it_too_and_does_not_call_it_no_verdict(unwritable, record):
    with pytest.raises(ResultError, match=r"libraries: cannot be made: "):
        st.audit(st.Rig.from_toml(TEXT), record=record, library=unwritable)


def test_a_cache_that_cannot_be_written_to_is_said_once_and_passed_over(cache, capsys):
    """A fit ended after its first block: "Read-only file system; choose another, or make room"."""
    assert library_or_cache(None) == cache
    said = capsys.readouterr().err
    assert said.startswith("Simulations are not stored: ")
    assert said.rstrip().endswith("--library FOLDER stores them elsewhere.")
    assert library_folder(cache) == cache
    block = cache / "key-0" / "00000.npz"
    write_arrays(block, scores=np.zeros(3))
    assert read_arrays(block) is None


def test_other_folders_are_written_or_refused(tmp_path, unwritable, capsys):
    folder = tmp_path / "new" / "libraries"
    assert library_or_cache(folder) == library_folder(folder) == folder
    assert not capsys.readouterr().err
    assert library_folder(None) is None
    write_arrays(folder / "key-0" / "00000.npz", scores=np.zeros(3))
    assert read_arrays(folder / "key-0" / "00000.npz")["scores"].tolist() == [0.0, 0.0, 0.0]
    with pytest.raises(ResultError, match="cannot be made"):
        write_arrays(unwritable / "00000.npz", scores=np.zeros(3))


def test_the_cache_is_in_the_users_cache():
    assert cache_folder().name == "libraries"
    assert "stiction" in cache_folder().parts


def test_what_is_begun_is_not_simulated_again(monkeypatch):
    """Simulations that are stored nowhere would be made twice, after a look at the first ones."""
    asked = []

    def simulate(_, number, __):
        asked.append(number)
        return np.array([number]), np.array([-number])

    monkeypatch.setattr("stiction.inference.simulated.library.simulate", simulate)
    begun = Ensemble(None, None, 0).simulate(2 * BLOCK)
    assert sorted(asked) == [*range(2 * BLOCK)]
    scores, found = begun.simulate(2 * BLOCK + 1).rows(2 * BLOCK + 1)
    assert sorted(asked) == [*range(3 * BLOCK)]
    assert scores[:, 0].tolist() == (-found[:, 0]).tolist() == [*range(2 * BLOCK + 1)]


FEW = {  # simulations, and how the refusal begins after the first of them
    "fit": (400, "only 1 of 96 simulated records have"),
    "mechanism": (200, "only 4 of 128 simulated records of rate and state, and by no mechanism"),
    "design": (200, "only 1 of 96 rigs drawn from the priors have"),
    "audit": (400, "No verdict: only 1 of 96 simulated records have"),
}


@pytest.mark.parametrize("name", FEW)
def test_too_few_cycles_are_refused_after_the_first_simulations(name, rig, record, monkeypatch):
    """A mechanism and a design simulated all for minutes, and said then that few have cycles."""
    asked, (count, begins) = [], FEW[name]

    def simulate(plan, number, _):
        asked.append(number)
        columns = len(features_from((), plan.conditions[0], plan.basis or plan.slider))
        row = np.full(columns * len(plan.conditions), np.nan if number else 0.0)
        return np.zeros(len(plan.priors)), row

    monkeypatch.setattr("stiction.inference.simulated.library.simulate", simulate)
    said = refusal(name, rig, record, count)
    assert said.startswith(begins)
    assert " have cycles of stick and slip no longer than 4 times the record's, " in said
    assert " are needed: check the priors, and stiffness and velocity, which decide how " in said
    assert said.rstrip(".").endswith("whether the record is stick-slip at all: `st.analyse` tells")
    assert max(asked) == FIRST_SIMULATIONS - 1


def refusal(name, rig, record, count):
    """What is said of so many simulations of which hardly any has cycles."""
    if name == "audit":
        page = str(st.audit(rig, record=record, simulations=count))
        return next(line.strip() for line in page.splitlines() if "of 96" in line)
    given = (rig, record) if name == "design" else (record, rig)
    with pytest.raises(ResultError) as refused:
        getattr(st, name)(*given, simulations=count)
    return str(refused.value)


def test_progress_is_told_within_the_first_block(monkeypatch):
    """A design said nothing for its first 35 s."""
    row = np.zeros(2), np.zeros(3)
    monkeypatch.setattr("stiction.inference.simulated.library.simulate", lambda *_: row)
    told = []
    scores, _ = Ensemble(None, None, 0).simulate(40, told.append).rows(40)
    assert scores.shape == (40, 2)
    assert told[0] == 1 / (2 * BLOCK)
    assert told == sorted(told)
    assert told[-1] == 1.0


@pytest.mark.parametrize("count", [0, -40])
def test_no_simulations_are_refused(count):
    """A fit with -n 0 ended in a traceback."""
    with pytest.raises(st.DescriptionError, match=f"simulations: must be at least 1, is {count}"):
        Ensemble(None, None, 0).simulate(count)
