"""Studies survive power cuts: from each possible state they continue to the same result.

The cut of a real file system is a command: ``python -m benchmarks.explore.power_cuts``.
"""

import os
import pickle
import shutil
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import xarray as xr
from tests.power import Disk, State, put
from tests.waiting import PATIENCE

import stiction as st
from stiction.storage.files import folder_lock
from stiction.study.execution import sweep
from stiction.study.execution.engines import Threads, never
from stiction.study.execution.sweep import do, do_block
from stiction.study.store.creation import create
from stiction.study.store.store import BlockResults

BASE = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="10 ms"))
AXES = {"phi": st.Values(["1 deg", "95 deg", "3 deg"])}  # one is refused, and says why
STUDY = st.Study(base=BASE, axes=AXES, measures=["peak_force"], traces=["force"], trace_samples=3)


@pytest.fixture
def disk(tmp_path, monkeypatch):
    (tmp_path / "folder").mkdir()
    made = Disk(tmp_path / "folder", monkeypatch)
    yield made
    made.close()


def test_a_store_is_there_whole_or_not_at_all(disk):
    create(STUDY, disk.root / "a.zarr")
    found = [contents(state, "a.zarr") for state in disk.states]
    disk.states.clear()
    disk.look()
    right, *others = [contents(state, "a.zarr") for state in disk.states]
    assert all(each == right for each in others)
    assert all(each in ({}, right) for each in found)
    assert {} in found


def test_no_block_is_taken_for_done_that_is_not_whole(tmp_path, monkeypatch):
    """Before and after each sync and rename, with what is not synced lost, empty, zero or there."""
    path, seen = tmp_path / "a.zarr", set()
    store = create(STUDY, path)
    disk = Disk(path, monkeypatch)
    st.sweep(STUDY, path, engine=Threads(1))
    right = {str(each.relative_to(path)): each for each in path.rglob("*") if each.is_file()}
    for number, state in enumerate(disk.states):
        found = store._replace(path=tmp_path / str(number))
        put(state, found.path)
        done = [task for task in range(STUDY.layout.tasks) if found.has(STUDY.layout.region(task))]
        seen.add(len(done))
        for name, file in right.items():
            if "/c/" not in name or name.startswith("phi") or name.split("/")[2] in map(str, done):
                assert state[name] == file.read_bytes()
    assert seen == {0, 1, 2, 3}
    disk.close()


def contents(state: State, folder: str) -> State:
    """Return what is in a folder of a state."""
    return {name: content for name, content in state.items() if name.startswith(folder)}


def test_what_was_said_to_be_done_stays(disk):
    """When a block is reported, no state in which it is not done is left."""
    marks = []

    def count(_):
        disk.states.clear()
        disk.look()
        files = [
            [name for name in state if name.startswith("a.zarr/status/c/") and state[name]]
            for state in disk.states
        ]
        marks.append({len(found) for found in files})

    st.sweep(STUDY, disk.root / "a.zarr", engine=Threads(1), progress=count)
    assert all(len(each) == 1 for each in marks)
    assert max(marks[-1]) == STUDY.layout.tasks


@pytest.mark.parametrize("name", ["status", "message", "peak_force", "force_trace"])
@pytest.mark.parametrize("left", [0, 3, None])
def test_a_block_that_lacks_something_is_done_again(tmp_path, name, left):
    st.sweep(STUDY, tmp_path / "a.zarr")
    right = xr.open_zarr(tmp_path / "a.zarr").load()
    chunk = tmp_path / "a.zarr" / name / "c" / "1"
    chunk = chunk / "0" if chunk.is_dir() else chunk
    chunk.unlink() if left is None else chunk.write_bytes(chunk.read_bytes()[:left])
    if name != "status" or left is not None:
        with pytest.raises(st.ResultError, match=f"is damaged: {name}/c/1"):
            st.open_study(tmp_path / "a.zarr")
    tallies = []
    assert st.sweep(STUDY, tmp_path / "a.zarr", progress=tallies.append).pending == 0
    assert len(tallies) == 1
    xr.testing.assert_identical(xr.open_zarr(tmp_path / "a.zarr").load(), right)


def test_two_sweeps_of_one_new_store_share_it(tmp_path, monkeypatch):
    """The second one has begun when the first one makes the store; each does a part."""
    from stiction.study.store import creation

    done, place = {"first": [], "second": []}, creation.place
    path = tmp_path / "a.zarr"

    def second(tally):
        done["second"].append(tally)

    def late(made):
        monkeypatch.setattr(creation, "place", place)
        st.sweep(STUDY, path, progress=second)  # it is faster
        place(made)

    monkeypatch.setattr(creation, "place", late)
    first = st.sweep(STUDY, path, progress=done["first"].append)
    assert first.pending == 0
    assert len(done["second"]) == STUDY.layout.tasks
    assert not done["first"]
    assert [each.name for each in tmp_path.iterdir()] == ["a.zarr"]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot tell who is alive")
def test_a_second_sweep_begins_at_the_other_end(tmp_path):
    def stop(_):
        raise KeyboardInterrupt

    store = create(STUDY, tmp_path / "a.zarr")
    first, *_, last = (store.layout.region(task) for task in range(store.layout.tasks))
    with folder_lock(store.path, alone=True), pytest.raises(KeyboardInterrupt):
        st.sweep(STUDY, store.path, engine=Threads(1), progress=stop)
    assert store.has(last)
    assert not store.has(first)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot tell who is alive")
@pytest.mark.parametrize("others", [1, 2, 4])
def test_any_number_of_sweeps_share_the_work(tmp_path, monkeypatch, others):
    """A sweep leaves out the blocks that others are doing; a third one did all again."""
    study = st.Study(base=BASE, axes={"phi": st.Grid("1 deg", "3 deg", 9)}, measures=["peak_force"])
    store, done, run_one = create(study, tmp_path / "a.zarr"), [], sweep.run_one
    begun = threading.Barrier(others + 1)

    def noted(study, wanted, index, *arguments):
        if len(done) < others + 1:
            done.append(index)
            begun.wait(PATIENCE)  # each sweep is in its first block
        else:
            done.append(index)
        return run_one(study, wanted, index, *arguments)

    monkeypatch.setattr(sweep, "run_one", noted)
    with ThreadPoolExecutor(others + 1) as pool:
        sweeps = [
            pool.submit(st.sweep, study, store.path, engine=Threads(1)) for _ in range(others + 1)
        ]
        assert all(each.result().pending == 0 for each in sweeps)
    assert len({*done[: others + 1]}) == others + 1
    assert {*done} == {(number,) for number in range(9)}
    assert not [*store.path.glob("status/.*")]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot tell who is alive")
def test_a_block_that_another_sweep_keeps_is_done_last(tmp_path):
    """One that is suspended keeps its claim; one that was killed leaves its file."""
    store, told = create(STUDY, tmp_path / "a.zarr"), []
    (store.path / "status" / ".claim-1").touch()  # of a killed sweep
    with store.claim(0) as mine:
        assert mine
        with store.claim(0) as again:
            assert not again
        st.sweep(STUDY, store.path, engine=Threads(1), progress=lambda _: told.append(order(store)))
        assert [*store.path.glob("status/.*")] == [store.path / "status" / ".claim-0"]
    assert told[-1] == [0, 1, 2]
    assert all(0 not in done for done in told[:-1])
    assert not [*store.path.glob("status/.*")]


def order(store):
    """Return the blocks that are done."""
    layout = store.layout
    return [task for task in range(layout.tasks) if store.has(layout.region(task))]


OTHER = st.Study(base=BASE, axes={"phi": st.Grid("1 deg", "3 deg", 5)}, measures=["peak_force"])


def replace_store(path, study):
    """Put a new store in place of another one; the file system may give it the same number."""
    shutil.rmtree(path)
    return create(study, path)


def test_a_worker_that_outlives_a_store_opens_the_one_in_its_place(tmp_path):
    """Workers of a cluster do: they took the blocks of the old layout for all blocks."""
    path = tmp_path / "a.zarr"
    old = sent(create(STUDY, path)).store()
    new = replace_store(path, OTHER)
    assert sent(new).store().layout == new.layout != old.layout
    for task in range(OTHER.layout.tasks):
        do_block(OTHER, sent(new), task, never)
    assert (st.open_study(path)["status"] == 0).all()


def sent(store):
    """Return the address of a store as a worker has it."""
    return pickle.loads(pickle.dumps(store.address))


def test_equal_stores_are_opened_once(tmp_path):
    """A worker opens a store for its first block, and a store of the same content is the same."""
    store = create(STUDY, tmp_path / "a.zarr")
    first = sent(store).store()
    assert sent(store).store() is first
    again = replace_store(store.path, STUDY)
    assert again.identity == store.identity
    assert sent(again).store() is first


@pytest.mark.parametrize("instead", [OTHER, None])
def test_a_store_in_place_of_another_one_is_not_written_to(tmp_path, instead):
    """Nor by a run that began before, whose blocks have another shape."""
    store = create(STUDY, tmp_path / "a.zarr")
    address, region = sent(store), store.layout.region(0)
    whole = BlockResults([], np.zeros(1, np.int8), np.array([""], object))
    shutil.rmtree(store.path) if instead is None else replace_store(store.path, instead)
    for write in (
        lambda: do(STUDY, store, [0], Threads(1), None),
        lambda: do_block(STUDY, address, 0, never),
        lambda: store.write(region, whole),
    ):
        with pytest.raises(st.ResultError, match="removed or replaced by another store"):
            write()
    if instead is None:
        assert not store.path.exists()
    else:
        assert (st.open_study(store.path)["status"] == -1).all()
