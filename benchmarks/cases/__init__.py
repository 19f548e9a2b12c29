"""Cases with a known solution: exact, or published, or agreed on by two methods.

They are written once: the benchmark lists their errors at several tolerances, and the test suite
asks that they agree to the digits given.
"""

from .belt import CASES as BELT
from .case import Case
from .lugre import CASES as LUGRE
from .oscillator import CASES as OSCILLATOR
from .paper import CASES as PAPER
from .rate_and_state import CASES as RATE_AND_STATE
from .steady import CASES as STEADY
from .transverse import CASES as TRANSVERSE

CASES: tuple[Case, ...] = (
    *PAPER,
    *STEADY,
    *OSCILLATOR,
    *BELT,
    *LUGRE,
    *RATE_AND_STATE,
    *TRANSVERSE,
)
