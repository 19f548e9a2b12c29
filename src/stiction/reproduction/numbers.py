"""Every number that the paper states, beside the computed one, and their table.

A stated number agrees if the computed one rounds to it: the tolerance is half a unit
of the last printed digit. Where the paper says "almost" or "practically", the entry
names the bound. The last part compares this software with the project's reference
values for the set-valued solution (two independent methods), to the digits given there.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import pi, radians, sin
from pathlib import Path

import numpy as np

from stiction import theory
from stiction.presets import Number as Number
from stiction.presets import find
from stiction.storage.files import whole
from stiction.system.slider import Slider
from stiction.text.sections import Section, Table
from stiction.trajectory import Trajectory

HEADER = ("where", "what", "stated", "computed", "deviation", "tolerance", "unit", "verdict")


def numbers(run: Trajectory, constant: Trajectory) -> list[Number]:
    """Return all numbers.

    Parameters
    ----------
    run : Trajectory
        Fig. 3's system over 5 s, sampled at 10 kHz or more.
    constant : Trajectory
        The same with constant friction mu_0, over 10 s.
    """
    return [
        *from_theory(run.slider),
        *from_simulation(run),
        *of_creep(run),
        *find("nakano-popov-weakening").numbers(run),
        *find("nakano-popov-constant").numbers(constant),
    ]


def from_theory(slider: Slider) -> list[Number]:
    """Return the numbers that follow from the parameters alone."""
    s, V = slider, slider.motion.rate(0.0)[0]
    omega_y = float(theory.natural_frequency(s.k_y, s.mass))
    A = theory.damping_number_of(s, V)
    zeta = float(theory.damping_ratio(A, s.phi))
    wide = radians(10)
    A_wide = theory.damping_number_of(s, V, wide)
    least = float(theory.damping_ratio(A_wide, wide))
    return [
        Number("Results", "stiffness anisotropy k_y/k_x", 1e4, s.k_y / s.k_x, 0.5),
        Number("Fig. 4", "natural frequency omega_y/2pi", 1.0, omega_y / 2e3 / pi, 0.05, "kHz"),
        Number("Eq. (10)", "zeta = A at theta = 90 deg", 3.6e3, A, 50),
        Number("Eq. (10)", "zeta at theta = phi = 1 deg", 1.9e-2, zeta, 5e-4),
        Number("Fig. 5", "times that zeta crosses 1, phi = 1 deg", 1, int(zeta < 1 < A), 0),
        Number("Fig. 5", "times that zeta crosses 1, phi = 10 deg", 0, int(least < 1 < A_wide), 0),
    ]


def from_simulation(run: Trajectory) -> list[Number]:
    """Return the numbers that the paper reads off its simulation."""
    from stiction.analysis.creep.first_slip import first_slip_time
    from stiction.analysis.motion.rest import stuck_share

    d, slider = run.data, run.slider
    time, slip = d["time"].values, first_slip_time(run)
    stick = (time > 0.05) & (time < 0.9 * slip)
    first = run.stick_intervals[0, 1]
    outset = (time > first) & (time < first + 1e-3)
    early = (time > 0.05) & (time < 0.1)
    drop = 100 * (1 - d["friction"].values[stick].min() / slider.F_0)
    ridge = _ridge(run, 0.1, 0.3) / 1e3
    late = _ridge(run, slip - 0.15, slip - 0.05) / 1e3
    return [
        Number(
            "Results",
            "psi as sliding starts ('almost 90', to 2)",
            90,
            float(d["psi"].values[outset].max()),
            2,
            "deg",
        ),
        Number("Results", "drop of F in stick ('constant', to 2 %)", 0, float(drop), 2, "%"),
        Number(
            "Eq. (9)",
            "mean k_y u_y at the start of creep over F_0",
            1,
            float(d["spring_y"].values[early].mean() / slider.F_0),
            0.005,
        ),
        Number(
            "Results",
            "time at full stop until first slip ('never')",
            0,
            100 * stuck_share(first, slip, run.stick_intervals),
            0,
            "%",
            finding=True,
        ),
        Number("Fig. 4", "frequency at the start of the stick phase", 1.0, ridge, 0.05, "kHz"),
        Number("Fig. 4", "lower frequency before slip (1: yes)", 1, late < 0.9 * ridge, 0),
        Number(
            "Results",
            "largest k_x u_x over F_0 ('until', to 1 %)",
            1,
            float(d["spring_x"].values[time < slip + 0.1].max() / slider.F_0),
            0.01,
        ),
    ]


def _ridge(run: Trajectory, start: float, end: float) -> float:
    """Return the frequency (Hz) of the strongest transverse oscillation between two times (s)."""
    part = run.data["v_y"].sel(time=slice(start, end)).values
    rate = 1 / float(run.samples["time"][1] - run.samples["time"][0])
    power = np.abs(np.fft.rfft((part - part.mean()) * np.hamming(len(part)), 1 << 15))
    frequency = np.fft.rfftfreq(1 << 15, 1 / rate)
    band = frequency > 200
    return float(frequency[band][power[band].argmax()])


def of_creep(run: Trajectory) -> list[Number]:
    """Compare Eq. (7) with the simulation, and Eq. (8) with Eq. (7)."""
    from stiction.analysis.creep.first_slip import mean_creep_velocity

    s, V = run.slider, run.slider.motion.rate(0.0)[0]
    l_x = s.F_0 / s.k_x
    mean = mean_creep_velocity(run)
    simulated = float(mean.interp(time=1.0))
    exact = float(theory.creep_velocity(1.0, V, s.phi, l_x))
    return [
        Number(
            "Eq. (7)", "creep at 1 s, simulated over Eq. (7), to 1 %", 1, simulated / exact, 0.01
        ),
        Number(
            "Eq. (8)",
            "corrected, over Eq. (7) at 1 s, to order phi",
            1,
            float(theory.creep_velocity_approximation(1.0, V, s.phi, l_x)) / exact,
            sin(s.phi),
        ),
        Number(
            "Eq. (8)",
            "as printed, over Eq. (7) at 1 s, to order phi",
            1,
            float(theory.creep_velocity_as_printed(1.0, V, s.phi, l_x)) / exact,
            sin(s.phi),
            finding=True,
        ),
    ]


@dataclass(frozen=True)
class NumberTable:
    """Numbers beside the stated ones.

    Parameters
    ----------
    numbers : sequence of Number
        The numbers in order.
    """

    numbers: Sequence[Number]

    @property
    def agrees(self) -> bool:
        """Whether no number is wrong."""
        return all(number.verdict != "WRONG" for number in self.numbers)

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The cells as text, one tuple a number."""
        return [
            (
                n.where,
                n.what,
                f"{n.stated:.11g}",
                f"{n.computed:.9g}",
                f"{n.deviation:+.1e}",
                f"{n.tolerance:.1e}",
                "" if n.unit == "1" else n.unit,
                n.verdict,
            )
            for n in self.numbers
        ]

    @property
    def section(self) -> Section:
        """The table as a part of a report, with the line that counts the verdicts."""
        return Section("The paper's numbers", [self.summary], Table(HEADER, self.rows))

    @property
    def text(self) -> str:
        """The table in plain text, with a line that counts the verdicts."""
        rows = [HEADER, *self.rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(HEADER))]
        lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) for row in rows]
        lines.insert(1, "  ".join("-" * width for width in widths))
        return "\n".join(line.rstrip() for line in [*lines, "", self.summary])

    @property
    def summary(self) -> str:
        """One line, how many of the numbers agree and which do not."""
        kinds = {
            "of the paper's numbers": [n for n in self.numbers if n.where != "reference"],
            "reference values of this project": [n for n in self.numbers if n.where == "reference"],
        }
        parts = [
            f"{sum(n.verdict == 'agrees' for n in part)} of {len(part)} {whose} agree"
            for whose, part in kinds.items()
            if part
        ]
        findings = [n for n in self.numbers if n.verdict == "finding"]
        if findings:
            named = ", ".join(f"{n.where} {n.what.strip()}" for n in findings)
            count = "1 is a finding" if len(findings) == 1 else f"{len(findings)} are findings"
            parts.append(f"{count}: {named}")
        wrong = [n.what.strip() for n in self.numbers if n.verdict == "WRONG"]
        if wrong:
            parts.append(f"wrong: {', '.join(wrong)}")
        return "; ".join(parts)

    @property
    def markdown(self) -> str:
        """The table in Markdown."""
        lines = [f"| {' | '.join(row)} |" for row in [HEADER, *self.rows]]
        lines.insert(1, f"|{' --- |' * len(HEADER)}")
        return "\n".join([*lines, "", self.summary])

    def save(self, folder: Path) -> list[Path]:
        """Write ``numbers.txt``, ``.md`` and ``.json`` to `folder`; return their paths."""
        entries = [
            asdict(n)
            | {"computed": float(n.computed), "deviation": float(n.deviation)}
            | {"verdict": n.verdict}
            for n in self.numbers
        ]
        texts = {".txt": self.text, ".md": self.markdown, ".json": json.dumps(entries, indent=2)}
        for suffix, text in texts.items():
            with whole(folder / f"numbers{suffix}") as part:
                part.write_text(text + "\n", encoding="utf-8")
        return [folder / f"numbers{suffix}" for suffix in texts]
