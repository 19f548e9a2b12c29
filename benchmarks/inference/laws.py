"""Calibration of fits of other laws: how often intervals hold the truth, of records not seen.

``python -m benchmarks.inference.laws``: for one rig with each of several laws, every coefficient
and what else is uncertain, 1000 simulations and 300 further records: coverage of 95 % intervals,
and how many records are called unlike. Records have 20 cycles, friction that differs by 0.1 % to
5 % from cycle to cycle, and noise of 0.2 % of the friction force at rest. It takes three minutes on
two cores.
"""

from __future__ import annotations

import argparse

from benchmarks.inference.fits import compare
from stiction.inference.fit import plan_for
from stiction.inference.learning.calibration import learn_or_read
from stiction.inference.observation import Conditions, Noise
from stiction.inference.rig import Rig
from stiction.inference.simulated.library import build

TEXT = """
[slider]
mass = "0.3 kg"
k_x = "3 +- 0.06 kN/m"
k_y = "2 MN/m"
phi = {low = "0.3 deg", high = "4 deg", scale = "log"}
normal_load = "6 N"

[drive]
velocity = "2 mm/s"

[friction]
"""
LAWS = {
    "stribeck": """
mu_s = {low = 0.37, high = 0.5}
mu_c = {low = 0.2, high = 0.36}
v_s = {low = "5 mm/s", high = "50 mm/s", scale = "log"}
c = "0.1 +- 0.05 s/m"
""",
    "two-exponentials": """
mu_inf = {low = 0.2, high = 0.3}
mu_1 = {low = 0.05, high = 0.15}
mu_2 = {low = 0.05, high = 0.15}
v_1 = "10 mm/s"
v_2 = "100 mm/s"
""",
    "coulomb": """
mu_0 = {low = 0.2, high = 0.5}
mu_static = {low = 0.25, high = 0.55}
""",
    "exponential-weakening": """
mu_0 = {low = 0.35, high = 0.5}
mu_inf = {low = 0.2, high = 0.34}
v_f = {low = "3 mm/s", high = "50 mm/s", scale = "log"}
[friction.anisotropy]
ratio = {low = 0.6, high = 1.6}
""",
}
CHANNELS = ("force",), ("force", "force_across")
CYCLES, PER_CYCLE, CYCLE = 20, 200, 0.25
NOISE = 0.002


def run(law: str, channels: tuple[str, ...], count: int, unseen: int) -> list[str]:
    """Return the lines of a report on one law."""
    rig = Rig.from_toml(f'{TEXT}law = "{law}"{LAWS[law]}')
    noise = dict.fromkeys(channels, Noise(NOISE * rig.slider.F_0))
    conditions = Conditions(
        2e-3, rig.slider.normal_load, 0.0, CYCLE / PER_CYCLE, CYCLES, CYCLE, noise
    )
    plan = plan_for(rig, [conditions])
    known, others = build(plan, count, None), build(plan, unseen, None, seed=1)
    found = compare(known, learn_or_read(known.features, known.scores), others, others.features)
    lines = [f"{law}, {' and '.join(channels)}: {len(others.scores)} records, "
             f"{found.unlike:.1%} called unlike"]  # fmt: skip
    for i, name in enumerate(found.names):
        lines.append(f"  {name:20s} {found.inside[:, i].mean():.1%} hold the truth")
    return lines


def main() -> None:
    """Print coverage by law and channels."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--simulations", type=int, default=1000)
    parser.add_argument("--records", type=int, default=300)
    given = parser.parse_args()
    for law in LAWS:
        for channels in CHANNELS:
            print(*run(law, channels, given.simulations, given.records), sep="\n", flush=True)


if __name__ == "__main__":
    main()
