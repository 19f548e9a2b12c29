"""Published systems, by name: each with its reference, and the numbers that it must give.

>>> import stiction as st
>>> run = st.run(st.presets.leine_belt())
>>> numbers = st.presets.find("leine-belt").numbers(run)
>>> [number.agrees for number in numbers]
[True, True, True, True, True, True]
"""

from __future__ import annotations

from stiction.presets.belts import leine_arctan as leine_arctan
from stiction.presets.belts import leine_belt as leine_belt
from stiction.presets.belts import leine_lugre as leine_lugre
from stiction.presets.belts import veraszto_stepan as veraszto_stepan
from stiction.presets.demonstrations import conveyor as conveyor
from stiction.presets.demonstrations import modelica_force as modelica_force
from stiction.presets.demonstrations import modelica_spring as modelica_spring
from stiction.presets.earthquake import earthquake_cycle as earthquake_cycle
from stiction.presets.earthquake import period_doubling as period_doubling
from stiction.presets.earthquake import two_state_chaos as two_state_chaos
from stiction.presets.lugre import lugre_lag as lugre_lag
from stiction.presets.lugre import lugre_pre_sliding as lugre_pre_sliding
from stiction.presets.lugre import lugre_stick_slip as lugre_stick_slip
from stiction.presets.nakano_popov import nakano_popov_2020 as nakano_popov_2020
from stiction.presets.nakano_popov import nakano_popov_constant as nakano_popov_constant
from stiction.presets.nakano_popov import nakano_popov_weakening as nakano_popov_weakening
from stiction.presets.preset import PRESETS as PRESETS
from stiction.presets.preset import Number as Number
from stiction.presets.preset import Preset as Preset
from stiction.presets.preset import find as find
from stiction.presets.rate_and_state import slide_hold_slide as slide_hold_slide
from stiction.presets.rate_and_state import velocity_step_ageing as velocity_step_ageing
from stiction.presets.rate_and_state import velocity_step_perrin as velocity_step_perrin
from stiction.presets.rate_and_state import velocity_step_slip as velocity_step_slip
from stiction.presets.rate_and_state import velocity_step_two_states as velocity_step_two_states
from stiction.presets.rosin import rosin_hyperbolic as rosin_hyperbolic
from stiction.presets.rosin import rosin_power_law as rosin_power_law
from stiction.presets.rosin import rosin_two_exponentials as rosin_two_exponentials
from stiction.presets.scenarios import friction_force_microscope as friction_force_microscope
from stiction.presets.scenarios import paper_on_paper as paper_on_paper
from stiction.presets.scenarios import wiper_blade as wiper_blade
from stiction.presets.scenarios import yaw_angle_brake as yaw_angle_brake
from stiction.presets.vibration import den_hartog as den_hartog
from stiction.presets.vibration import free_vibration as free_vibration
from stiction.presets.vibration import transverse_vibration as transverse_vibration


def __dir__() -> list[str]:
    """List the presets and the functions that find them, not the modules."""
    return sorted(
        name
        for name, each in globals().items()
        if name.startswith("__")
        or each is PRESETS
        or str(getattr(each, "__module__", "")).startswith(__name__)
    )
