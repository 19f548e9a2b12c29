"""Rate and state: velocity steps and slide-hold-slide of rsfmodel, quasi-static."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from stiction.drive.protocols import Constant, DriveProgram, Hold
from stiction.friction.laws import (
    RateStateAgeing,
    RateStateAgeing2,
    RateStatePerrin,
    RateStateSlip,
)
from stiction.presets.preset import Make, Published, on_a_line, preset
from stiction.presets.samples import crest
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

REFERENCE = "Ruina, J. Geophys. Res. 88, 10359 (1983); values: rsfmodel (Leeman et al. 2016)"
DOI = "10.1029/JB088iB12p10359"
QUASI_STATIC = 1e-12  # m V^2/(a W D_c): inertia over the direct effect
ASSUMED = (f"a small mass, m V^2 = {QUASI_STATIC:g} a W D_c, where the source has none",)
AFTER = (1.0, 2.0, 3.0, 4.0, 10.0, 30.0)  # s
UM = 1e-6


def quasi_static(law: Any, k: float, drive: DriveProgram, settings: Settings) -> Description:
    """Return a run without inertia, W = 1 N, that begins with steady sliding, k in N/m."""
    D = getattr(law, "D_c", None) or law.D_1
    start = abs(drive.rate(0.0)[0])
    fastest = 10 * UM
    slider = on_a_line(
        mass=QUASI_STATIC * law.a * D / fastest**2,
        k_x=k,
        friction=law,
        drive=drive,
        driven="spring",
    )
    return Description(slider, Initial(u_x=law.coefficient(start) / k, v_x=0.0, v_y=0.0), settings)


def step(law: Any, k: float) -> Description:
    """Return the step from 1 to 10 um/s after 10 s, and the 30 s after it."""
    drive = DriveProgram(velocity=UM, program=[Constant(duration=10.0), Constant(10 * UM)])
    return quasi_static(law, k, drive, Settings(duration=40.0, sample_rate=20.0, rtol=1e-11))


def _steps(run: Trajectory) -> list[float]:
    at = run.samples["time"].searchsorted([10.0 + t - 1e-9 for t in AFTER])
    mu = run.samples["spring_x"][at]
    v = run.samples["slip_speed"][at] / UM
    return [*map(float, mu), *map(float, v)]


def rsfmodel(
    shows: str,
    mu: tuple[float, ...],
    v: tuple[float, ...],
    reference: str = REFERENCE,
    doi: str = DOI,
) -> Callable[[Make], Make]:
    """Decorate the function that makes a case of rsfmodel, with its printed rows.

    Each number is printed to half a unit of its eighth decimal, or its last.
    """
    forces = (
        Published(f"mu, {t:g} s after the step", x, 1e-8) for t, x in zip(AFTER, mu, strict=True)
    )
    speeds = (
        Published(f"v, {t:g} s after", x, 1e-6, "um/s") for t, x in zip(AFTER, v, strict=True)
    )
    return preset(
        _steps, shows=shows, reference=reference, doi=doi, grade="solid", assumed=ASSUMED,
        published=(*forces, *speeds),
    )  # fmt: skip


@rsfmodel(
    "a step of the speed, ageing law: k twice critical, ringing",
    (0.60720485, 0.60186637, 0.58400910, 0.58563096, 0.58858313, 0.58848708),
    (5.98760938, 29.06408439, 13.87639287, 6.26688086, 9.82182937, 10.0000074),
)
def velocity_step_ageing() -> Description:
    """Velocity step A of rsfmodel: from 1 to 10 um/s, ageing law, a = 0.005, b = 0.01.

    Friction first rises with the logarithm of the speed, then falls over a distance D_c as the
    contacts are renewed: by (a - b) ln 10 in all. The spring is twice as stiff as the critical
    stiffness (b - a) W/D_c, so that the approach rings.
    """
    return step(RateStateAgeing(0.005, 0.01, 10 * UM, 0.6, UM), 1e3)


@rsfmodel(
    "a step of the speed, slip law, strengthening",
    (0.60839299, 0.61462880, 0.61663335, 0.61451424, 0.61149781, 0.61151293),
    (2.40532918, 5.50394141, 10.60027612, 12.69404325, 9.97125078, 9.99999999),
)
def velocity_step_slip() -> Description:
    """Velocity step B of rsfmodel: from 1 to 10 um/s, slip law, a = 0.01, b = 0.005."""
    return step(RateStateSlip(0.010, 0.005, 10 * UM, 0.6, UM), 1e3)


@rsfmodel(
    "a step of the speed, law of Perrin, Rice and Zheng",
    (0.60839207, 0.61456074, 0.61610039, 0.61386731, 0.61150337, 0.61151293),
    (2.41090004, 5.71219864, 11.15638292, 12.3913343, 9.97758477, 10.0),
    reference=f"{REFERENCE}; law: Perrin et al., J. Mech. Phys. Solids 43, 1461 (1995)",
    doi="10.1016/0022-5096(95)00036-I",
)
def velocity_step_perrin() -> Description:
    """Velocity step C of rsfmodel: from 1 to 10 um/s, theta' = 1 - (V theta/2 D_c)^2."""
    return step(RateStatePerrin(0.010, 0.005, 10 * UM, 0.6, UM), 1e3)


@rsfmodel(
    "a step of the speed, two ageing states",
    (0.61777816, 0.56719338, 0.57926411, 0.58134415, 0.57046462, 0.56488327),
    (11.24366669, 9.27431239, 6.24880306, 12.6979352, 10.3510415, 10.00791305),
)
def velocity_step_two_states() -> Description:
    """Velocity step D of rsfmodel: two ageing states, over 5 um and over 50 um.

    Friction ends at 0.6 + (a - b_1 - b_2) ln 10 = 0.5647704, which is not yet reached after 30 s.
    """
    law = RateStateAgeing2(0.012, 0.0185, 5 * UM, 0.0088, 50 * UM, 0.6, UM)
    return step(law, 3e3)


def _slide_hold_slide(run: Trajectory) -> list[float]:
    t, mu = run.samples["time"], run.samples["spring_x"]
    at = t.searchsorted([20.0 - 1e-9, 120.0 - 1e-9])
    again = mu[at[1] :]
    return [*map(float, mu[at]), crest(again), float(again[-1])]


@preset(
    _slide_hold_slide,
    shows="slide-hold-slide: the longer at rest, the higher the peak",
    reference="Marone, Annu. Rev. Earth Planet. Sci. 26, 643 (1998); parameters: rsfmodel",
    doi="10.1146/annurev.earth.26.1.643",
    grade="half",
    assumed=ASSUMED,
    published=(
        Published("mu before the hold", 0.6, 1e-9, "1", "closed form"),
        Published("mu after a hold of 100 s", 0.59309381, 1e-8, "1", "computed"),
        Published("peak on sliding again", 0.64146623, 1e-8, "1", "computed"),
        Published("mu 30 s later", 0.60000006, 1e-8, "1", "computed"),
    ),
)
def slide_hold_slide() -> Description:
    """Sliding at 10 um/s, a hold of 100 s, sliding again: ageing law, as rsfmodel's example.

    During the hold the spring relaxes, by slip that slows down, while the contacts age; on
    sliding again friction peaks and comes back. The values are of an independent quasi-static
    integration. `st.protocols.slide_hold_slide` makes the programs for several holds.
    """
    law = RateStateAgeing(0.005, 0.01, 10 * UM, 0.6, 10 * UM)
    drive = DriveProgram(
        velocity=10 * UM, program=[Constant(duration=20.0), Hold(100.0), Constant()]
    )
    return quasi_static(law, 1e3, drive, Settings(duration=150.0, sample_rate=200.0, rtol=1e-11))
