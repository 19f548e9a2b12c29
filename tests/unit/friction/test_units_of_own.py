"""A user's law that is made in Python takes units, as in a description and as ours do."""

from typing import Any, NamedTuple

import numpy as np
import pint
import pytest

import stiction as st
from stiction.text.units import Angle, Coefficient, PositiveSpeed


class Sloping(NamedTuple):
    mu: Coefficient
    v_c: PositiveSpeed
    grade: Angle = 0.0
    share: float = 0.5

    def coefficient(law, v):
        return law.mu + law.share * law.mu * v / (law.v_c + v)

    def slope(law, v):
        return law.share * law.mu * law.v_c / (law.v_c + v) ** 2


SLIDER = st.presets.nakano_popov_2020()
SPEED = pint.Quantity(10, "mm/s")
SI = Sloping(0.2, 0.01, np.radians(2.0))


@pytest.mark.parametrize(
    "law", [Sloping(0.2, "10 mm/s", "2 deg"), Sloping(0.2, SPEED, "2 deg"), SI]
)
def test_its_parameters_are_in_si(law: Sloping) -> None:
    assert SLIDER.replace(friction=law).law == SI
    round_it = st.laws.Anisotropic(law=law, ratio=1.2)
    assert SLIDER.replace(friction=round_it).law == st.laws.Anisotropic(law=SI, ratio=1.2)
    st.testing.check_law(law)  # written to JSON and read back, its angle too


def test_what_is_wrong_with_each_is_told_beside_other_faults() -> None:
    with pytest.raises(st.DescriptionError) as error:
        SLIDER.replace(friction=Sloping("x", "10 kg", share="0.5"), mass=-1)  # type: ignore[arg-type]
    assert [each.path for each in error.value.faults] == [
        "Slider.mass",
        "Slider.friction.mu",
        "Slider.friction.v_c",
        "Slider.friction.share",
    ]
    assert "is in kg, not a unit of a velocity" in str(error.value)
    assert "it is a plain float: write a number in SI" in str(error.value)
    with pytest.raises(st.DescriptionError, match=r"Sloping.v_c: '10 kg' is in kg"):
        st.testing.check_law(Sloping(0.2, "10 kg"))


def law_of_a_function() -> Any:
    """Return a law whose annotations are words, as of ``from __future__ import annotations``."""

    class Local(NamedTuple):
        mu: "Share"  # type: ignore[name-defined]  # noqa: F821
        v_c: "Share" = 0.01  # type: ignore[name-defined]  # noqa: F821

        def coefficient(law, v):
            return law.mu / (1.0 + v / law.v_c)

        def slope(law, v):
            return -law.mu / law.v_c / (1.0 + v / law.v_c) ** 2

    return Local


def test_a_law_whose_annotations_only_its_function_knows_has_plain_numbers() -> None:
    """Its audit, and the description with it, raised a NameError."""
    law = law_of_a_function()
    slider = SLIDER.replace(friction=law(0.2))
    assert "mu = 0.2" in slider.to_toml()
    with pytest.raises(st.DescriptionError, match=r"friction\.v_c: .* write a number in SI"):
        SLIDER.replace(friction=law(0.2, "1 cm/s"))
