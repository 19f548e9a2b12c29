"""Runs of a block share the memory of their samples, whatever the number of these."""

import numpy as np

import stiction as st
from stiction.study.execution.sweep import SharedRoom, run_one
from stiction.study.store.kept import stored_variables
from stiction.study.variables.measures import MEASURES, TRACES
from stiction.study.variables.observed_run import ObservedRun, observe_run


def numbers(run: ObservedRun) -> np.ndarray:
    """Return all that a study can keep of a run, one after the other."""
    kept = [np.array([each.value(run) for each in MEASURES.values()])]
    return np.concatenate([*kept, *(each.of(run) for each in TRACES.values())])


def test_runs_in_shared_memory_are_what_they_are_by_themselves():
    room, counts, slider = SharedRoom(), [], st.presets.nakano_popov_2020()
    for phi in ("6 deg", "1 deg", "9 deg", "3 deg"):
        run = st.Description(slider.replace(phi=phi), st.Initial(), st.Settings(duration="1 s"))
        alone, shared = observe_run(run, None), observe_run(run, None, room)
        np.testing.assert_array_equal(numbers(shared), numbers(alone))
        counts.append(len(alone.solution.samples))
    assert counts[1] < counts[0] < counts[2]  # fewer, more than there was room for, fewer


def test_a_block_keeps_what_its_runs_were(tmp_path):
    """Whatever a later run writes over their samples."""
    settings = st.Settings(duration="0.3 s")
    base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), settings)
    angles = {"phi": st.Grid("1 deg", "9 deg", 60)}
    study = st.Study(base=base, axes=angles, traces=[*TRACES], trace_samples=20)
    st.sweep(study, tmp_path / "a.zarr")
    found, wanted = st.open_study(tmp_path / "a.zarr").load(), stored_variables(study)
    assert study.layout.block[0] > 1
    for place in range(60):
        for its, value in zip(wanted, run_one(study, wanted, (place,), never).values, strict=True):
            np.testing.assert_array_equal(found[its.name].values[place], value)


def never() -> bool:
    """Return that a run is wanted until its end."""
    return False
