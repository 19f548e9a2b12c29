"""Friction laws, one file a law: its parameters, its equations, and where they are published.

The line that imports a law here makes it known to descriptions, by the name that its file gives it.
"""

from __future__ import annotations

from stiction.friction.laws.anisotropic import Anisotropic as Anisotropic
from stiction.friction.laws.coulomb import Coulomb as Coulomb
from stiction.friction.laws.exponential_weakening import (
    ExponentialWeakening as ExponentialWeakening,
)
from stiction.friction.laws.hyperbolic_weakening import HyperbolicWeakening as HyperbolicWeakening
from stiction.friction.laws.lugre import LuGre as LuGre
from stiction.friction.laws.lugre_hyperbolic import LuGreHyperbolic as LuGreHyperbolic
from stiction.friction.laws.power_law_weakening import PowerLawWeakening as PowerLawWeakening
from stiction.friction.laws.rate_and_state.one_state import RateStateAgeing as RateStateAgeing
from stiction.friction.laws.rate_and_state.one_state import RateStatePerrin as RateStatePerrin
from stiction.friction.laws.rate_and_state.one_state import RateStateSlip as RateStateSlip
from stiction.friction.laws.rate_and_state.two_states import RateStateAgeing2 as RateStateAgeing2
from stiction.friction.laws.rate_and_state.two_states import RateStateSlip2 as RateStateSlip2
from stiction.friction.laws.stribeck import Stribeck as Stribeck
from stiction.friction.laws.table import Table as Table
from stiction.friction.laws.two_exponentials import TwoExponentials as TwoExponentials
from stiction.friction.registry import LAWS


def __dir__() -> list[str]:
    return sorted(["Anisotropic", *(kind.__name__ for kind in LAWS.values())])
