"""Fig. 3's system, with the paper's friction and with constant friction."""

from __future__ import annotations

from functools import cache
from math import cos

import stiction as st
from benchmarks.cases.case import Case
from stiction import theory
from stiction.presets import Number, find
from stiction.presets.samples import crest
from stiction.solver.reference import reference_run

SAMPLE_RATE = 100e3  # so that extremes and their times are those of the solution
BEGINNING = 18.5e-3  # s; eight sticks, which take the reference some seconds


def figure3(rtol: float) -> list[Number]:
    """The reference values that two independent methods agree on, over 5 s."""
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(slider, 5.0, sample_rate=SAMPLE_RATE, rtol=rtol)
    s, V = slider, slider.motion.rate(0.0)[0]
    held = float(theory.first_stick_duration(s.F_0, V, s.phi, s.k_x, s.k_y))
    found = 1e3 * float(run.stick_intervals[0, 1])
    first = Number("closed form", "end of the first stick", 1e3 * held, found, 1e-9, "ms")
    return [first, *find("nakano-popov-weakening").numbers(run)]


def constant(rtol: float) -> list[Number]:
    """The same with mu = mu_0 at any speed: one stick, one slip, no oscillation."""
    slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2))
    run = st.simulate(slider, 20.0, sample_rate=10e3, rtol=rtol)
    end = float(run.final["spring_x"])
    fastest = 1e3 * crest(run.data["V_X"].values)
    return [
        Number("reference", "k_x u_x tends to", 1.9997, end, 5e-5, "N"),
        Number("closed form", "  mu_0 W cos phi", slider.F_0 * cos(slider.phi), end, 1e-9, "N"),
        Number("reference", "largest X'", 1.6124, fastest, 5e-5, "mm/s"),
        Number("reference", "sticks", 1, len(run.stick_intervals), 0),
    ]


@cache
def by_reference() -> tuple[float, float, int]:
    """Return both spring forces (N) at `BEGINNING` and the sticks until then, by the reference."""
    slider = st.presets.nakano_popov_2020()
    found = reference_run(slider, BEGINNING, rtol=1e-11)
    return slider.k_x * found.u_x[-1], slider.k_y * found.u_y[-1], len(found.sticks)


def beside_reference(rtol: float) -> list[Number]:
    """The first sticks and slips by plain Python, which shares no code with the solver."""
    run = st.simulate(st.presets.nakano_popov_2020(), BEGINNING, sample_rate=0, rtol=rtol)
    x, y, sticks = by_reference()
    return [
        Number("reference", "k_x u_x(18.5 ms)", x, float(run.final["spring_x"]), 1e-8, "N"),
        Number("reference", "k_y u_y(18.5 ms)", y, float(run.final["spring_y"]), 1e-8, "N"),
        Number("reference", "sticks", sticks, len(run.stick_intervals), 0),
    ]


CASES = (
    Case("Fig. 3", figure3),
    Case("Fig. 3, beginning", beside_reference),
    Case("Fig. 3, constant friction", constant),
)
