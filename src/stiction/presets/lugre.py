"""The LuGre model: C. Canudas de Wit et al., IEEE Trans. Automatic Control 40, 419 (1995)."""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING

from stiction.drive.protocols import Constant, ConstantVelocity, DriveProgram, Hold, Modulation
from stiction.friction.laws import LuGre
from stiction.presets.preset import Published, holds, on_a_line, preset
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

REFERENCE = "Canudas de Wit et al., IEEE Trans. Automatic Control 40, 419 (1995)"
DOI = "10.1109/9.376053"
V = 0.1  # m/s


def bristles() -> LuGre:
    """Return the law of the paper's Table I, for a normal load of 1 N."""
    return LuGre(1.0, 1.5, 1e-3, 1e5, sqrt(1e5), 0.4)


@preset(
    lambda run: [float(run.final[name]) for name in ("X", "V_X", "z_x")],
    shows="stick-slip of a block pulled by a spring, on bristles",
    reference=f"{REFERENCE}; values: Exudyn, example lugreFrictionTest",
    doi=DOI,
    grade="solid",
    published=(
        Published("x(25 s)", 1.9088391992, 5e-11, "m"),
        # below 3 % of V an error of the slip is absolute
        Published("v(25 s)", 9.42415459e-6, 5e-13, "m/s"),
        Published("z(25 s)", 1.18167955e-5, 5e-14, "m"),
    ),
)
def lugre_stick_slip() -> Description:
    """A block of 1 kg pulled at 0.1 m/s by a spring of 2 N/m.

    With bristles in place of a jump "stick" is elastic: the block moves by some ten micrometres
    while the force rises. Position, velocity and bristle at 25 s are published to eleven digits.
    """
    slider = on_a_line(k_x=2.0, friction=bristles(), drive=ConstantVelocity(V), driven="spring")
    start = Initial(v_x=V, v_y=0.0)
    return Description(slider, start, Settings(duration=25.0, sample_rate=1e3, rtol=1e-13))


SOFT, RATE, PEAK = 1e-3, 0.1425, 1.425  # N/m, N/s, N


def _pre_sliding(run: Trajectory) -> list[float]:
    d = run.data
    t, X = d["time"].values, 1e6 * d["X"].values
    at = {when: float(X[t.searchsorted(when - 1e-9)]) for when in (10.0, 15.0, 40.0, 65.0)}
    return [
        float(d["spring_x"].max()),
        at[10.0],
        at[15.0],
        at[40.0],
        at[65.0] - at[15.0],
        float(d["slip_speed"].max()) < 0.1 * 1e-3,
    ]


@preset(
    _pre_sliding,
    shows="a hysteresis loop below break-away: pre-sliding displacement",
    reference=f"{REFERENCE}, Fig. 2",
    doi=DOI,
    grade="half",
    published=(
        Published("largest force, 0.95 of F_s", 1.425, 1e-6, "N"),
        Published("displacement after 10 s", 44.8579, 1e-3, "um", "computed"),
        Published("  after 15 s", 45.3119, 1e-3, "um", "computed"),
        Published("  after 40 s", -10.0174, 1e-3, "um", "computed"),
        Published("  less that when the loop closes", 0.0, 1e-3, "um", "computed"),
        holds("slip stays below a tenth of the Stribeck speed: no break-away"),
    ),
    assumed=("the force acts through a spring of 1 mN/m, which the mass changes by 1e-8 N",),
)
def lugre_pre_sliding() -> Description:
    """A mass of 1 kg without a spring, pushed to 95 % of its break-away force and back.

    The force rises to 1.425 N within 10 s, stays for 5 s, falls to -1.425 N, stays, and rises
    again. The bristles bend by 14 um, and creep by twice as much: force over displacement is a
    closed loop.
    """
    speed = RATE / SOFT
    program = [
        Constant(speed, 10.0),
        Hold(5.0),
        Constant(-speed, 20.0),
        Hold(5.0),
        Constant(speed, 20.0),
        Hold(),
    ]
    slider = on_a_line(
        k_x=SOFT, friction=bristles(), drive=DriveProgram(program=program), driven="spring"
    )
    start = Initial(v_x=speed, v_y=0.0)
    return Description(slider, start, Settings(duration=65.0, sample_rate=100.0, rtol=1e-10))


def lag(omega: float) -> Description:
    """Return the run in which the slip speed varies as 1 mm/s (1.5 + cos(omega t))."""
    k = 1e10  # N/m: the contact is all that gives
    waves = Modulation(1e-3, omega / (2 * pi), "90 deg")
    slider = on_a_line(
        mass=1e-4,
        k_x=k,
        c_x=2 * sqrt(1e-4 * k),
        friction=bristles(),
        drive=DriveProgram(velocity=1.5e-3, along=waves),
    )
    period = 2 * pi / omega
    settings = Settings(duration=3 * period, sample_rate=400 / period, rtol=1e-9)
    return Description(slider, Initial(v_x=0.0, v_y=0.0), settings)


def _lag(run: Trajectory) -> list[float]:
    from stiction.simulation import run as simulate

    width, slow = loop_width(run), loop_width(simulate(lag(1.0)))
    return [1e3 * width, 1e3 * slow, 0.0 < slow < width]


def loop_width(run: Trajectory) -> float:
    """Return friction while the speed rises through 1.5 mm/s less that while it falls, N."""
    F = run.samples["friction"][-401:]
    falls, rises = F[100], F[300]  # a quarter and three quarters of the last period
    return float(rises - falls)


@preset(
    _lag,
    shows="friction lags behind the slip speed",
    reference=f"{REFERENCE}, Fig. 3",
    doi=DOI,
    grade="half",
    published=(
        Published("width of the loop at 25 rad/s", 36.0937, 1e-3, "mN", "computed"),
        Published("  at 1 rad/s", 1.21976, 1e-4, "mN", "computed"),
        holds("faster changes widen the loop"),
    ),
    assumed=("a mass-less contact is a mass of 0.1 g on a spring of 10 GN/m",),
)
def lugre_lag() -> Description:
    """A contact whose slip speed varies as 1 mm/s (1.5 + cos(25 t)).

    Friction does not follow the steady curve: while the speed rises, the bristles still carry the
    higher friction of slower slip. The loop in the plane of friction over slip speed is wider the
    faster the speed changes.
    """
    return lag(25.0)
