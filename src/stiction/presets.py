"""Published systems as starting points."""

from __future__ import annotations

from stiction.drive import ConstantVelocity
from stiction.friction.laws import ExponentialWeakening
from stiction.system.slider import Slider


def nakano_popov_2020() -> Slider:
    """Return the system of Fig. 3 of Nakano & Popov, arXiv:2008.01854 (parameters: its caption)."""
    return Slider(
        mass="0.25 kg",
        k_x="1 kN/m",
        k_y="10 MN/m",
        phi="1 deg",
        normal_load="10 N",
        friction=ExponentialWeakening(mu_0=0.20, mu_inf=0.15, v_f="10 mm/s"),  # type: ignore[arg-type]
        drive=ConstantVelocity("1 mm/s"),  # type: ignore[arg-type]
    )
