"""The stated onset of an oscillation against linear theory, on random apparatus.

``python -m benchmarks.accuracy.onsets 100``: soft onsets over misalignment (friction that weakens
exponentially) and hard ones over damping (a Stribeck law far beyond its speed, on a damper), from
values of random number and spacing.
"""

from __future__ import annotations

import sys

import numpy as np

import stiction as st
from benchmarks.accuracy.apparatus import between
from stiction.analysis.onset import Onset, find_onset
from stiction.linear_stability import critical


def soft(random: np.random.Generator) -> tuple[Onset, float] | None:
    """Find the onset over phi of a random apparatus; None if theory has none there."""
    mu = random.uniform(0.1, 0.5)
    k_x, load = between(random, 300, 3e3), between(random, 3, 30)
    slider = st.Slider(
        mass=k_x / (2 * np.pi * between(random, 5, 20)) ** 2,
        k_x=k_x,
        k_y=k_x * between(random, 1e3, 1e4),
        phi="1 deg",
        normal_load=load,
        friction=st.ExponentialWeakening(mu, mu * random.uniform(0.6, 0.95), "10 mm/s"),
        drive=st.ConstantVelocity(between(random, 5e-4, 5e-3)),
    )
    found = critical(slider, "phi", ("1 deg", "40 deg"))
    if found.stable != (False, True):
        return None
    true = float(np.degrees(found.values[0]))
    low, high = true * random.uniform(0.5, 0.97), true * random.uniform(1.03, 1.6)
    values = np.linspace(low, high, int(random.integers(3, 8)))
    return find_onset(slider, "phi", [f"{value} deg" for value in values]), float(found.values[0])


def hard(random: np.random.Generator) -> tuple[Onset, float]:
    """Find the onset over damping where F''' < 0: beyond x^2 = 3/2 of the Stribeck speed."""
    v_s = between(random, 5e-3, 5e-2)
    law = st.laws.Stribeck(random.uniform(0.25, 0.5), random.uniform(0.1, 0.2), v_s)
    speed, load = v_s * random.uniform(1.4, 2.0), between(random, 3, 30)
    k_x = between(random, 300, 3e3)
    slider = st.Slider(
        mass=k_x / (2 * np.pi * between(random, 5, 20)) ** 2,
        k_x=k_x,
        k_y=2.0 * k_x,
        phi="0 deg",
        normal_load=load,
        friction=law,
        drive=st.ConstantVelocity(speed),
    )
    c = -law.slope(speed) * load
    shares = np.linspace(random.uniform(0.6, 0.95), random.uniform(1.02, 2.0), 5)
    return find_onset(slider, "c_x", list(c * shares)), c


def main() -> None:
    """Print, for each kind, what is found and whether the interval holds the truth."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    for kind, draw in (("soft", soft), ("hard", hard)):
        random = np.random.default_rng(1)
        kinds: dict[str, int] = {}
        missed, ratios = 0, []
        for number in range(count):
            drawn = draw(random)
            if drawn is None:
                continue
            found, true = drawn
            kinds[found.kind] = kinds.get(found.kind, 0) + 1
            if np.isfinite(found.threshold):
                error = abs(found.threshold - true)
                ratios.append(found.uncertainty / true)
                if error > found.uncertainty:
                    missed += 1
                    print(
                        f"  {kind} {number}: {found.threshold:.8g} +- {found.uncertainty:.2g}, "
                        f"truth {true:.8g}",
                        flush=True,
                    )
            if found.kind not in (kind, "not determined"):
                print(f"  {kind} {number}: called {found.kind}", flush=True)
        width = f"median uncertainty {np.median(ratios):.2g} of it" if ratios else ""
        print(f"{kind}: {kinds}, {missed} outside the stated interval; {width}", flush=True)


if __name__ == "__main__":
    main()
