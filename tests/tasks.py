"""Tasks for engines, which another process can import."""

import os
import time
from pathlib import Path

import stiction as st


def who(task, _):
    """Return the task, and the process that did it; print something on the way."""
    os.write(1, b"printed by a task\n")
    return task, os.getpid()


def stop_elsewhere(how, own, seen, task, _):
    """Return the task in one process; in all others note that, and die, fail, or never end."""
    if os.getpid() != own:
        Path(seen).write_text(str(os.getpid()))
        if how == "dies":
            os._exit(1)
        if how == "fails":
            raise ValueError
        if how == "answers nonsense":
            return lambda: None  # cannot be sent
        time.sleep(1e6)
    return task


def forces(slider, *_):
    """Return the elongation at the end of a run, and the process that did it."""
    return float(st.simulate(slider, 1e-3).final.u_x), os.getpid()
