"""What the search for garbage looks through after compiling."""

import gc
import threading

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


def test_the_search_is_on_again_after_threads_that_compiled_side_by_side(monkeypatch):
    """The second one finds it off, and turns it off once the first has turned it on again."""
    first_ended, second_asks = threading.Event(), threading.Event()
    is_enabled = gc.isenabled

    def ask_and_wait():
        found = is_enabled()
        if threading.current_thread() is not threading.main_thread():
            second_asks.set()
            first_ended.wait(10.0)
        return found

    def second():
        with compiling():
            second_asks.set()  # where it need not ask

    thread = threading.Thread(target=second)
    monkeypatch.setattr(gc, "isenabled", ask_and_wait)
    with compiling():
        thread.start()
        assert second_asks.wait(10.0)
    first_ended.set()
    thread.join()
    assert is_enabled()


def test_a_search_that_was_off_stays_off():
    gc.disable()
    try:
        with compiling(), compiling():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
    with compiling():
        with compiling():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()
