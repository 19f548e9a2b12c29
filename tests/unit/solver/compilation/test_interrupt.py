"""What the search for garbage looks through after compiling."""

import gc

import pytest

from stiction.solver.compilation.interrupt import MANY, compiling


def is_old(thing):
    """Return whether only a full search for garbage looks at it."""
    return any(each is thing for each in gc.get_objects(generation=2))


@pytest.mark.parametrize("count", [100, 2 * MANY])
def test_what_was_compiled_is_old_and_what_a_run_makes_is_not(count):
    """Or memory of many runs with garbage in circles would never be given back."""
    gc.collect()
    kept = []
    with compiling():
        assert not gc.isenabled()
        kept.extend([k] for k in range(count))
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0
    assert is_old(kept[0]) == (count > MANY)


def test_what_somebody_froze_stays_frozen():
    gc.freeze()
    try:
        frozen = gc.get_freeze_count()
        with compiling():
            kept = [[k] for k in range(2 * MANY)]
        # threads may end frozen objects meanwhile; those kept would be far more
        assert abs(gc.get_freeze_count() - frozen) < MANY
        assert len(kept) == 2 * MANY
    finally:
        gc.unfreeze()
