"""Parts of an analysis, of tests that ask hundreds of runs and records for one finding."""

from __future__ import annotations

import stiction as st
from stiction.analysis.assessment import Assessment, assess_record, assess_run
from stiction.analysis.creep.findings import CreepFound, find_creep
from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.motion.regime.classify import classify_record


def assess(record: st.Record) -> Assessment:
    """Return cycles, friction, stated values and warnings as `st.analyse` finds them."""
    record = as_record(record)
    return assess_record(record, *classify_record(record)[1:])


def creep_of(run: st.Trajectory) -> CreepFound:
    """Return the creep of a run as `st.analyse` finds it, without an energy budget."""
    record = as_record(run)
    its = assess_run(run, record, *classify_record(record, run)[1:])
    return find_creep(run, record, its.sticking.as_dataset(), None)
