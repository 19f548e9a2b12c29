"""``python -m benchmarks``: accuracy and speed, beside other solvers."""

from __future__ import annotations

import argparse
from importlib import import_module
from pathlib import Path
from time import perf_counter

from rich.console import Console
from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn

from benchmarks.report import save, show

# each module has run(progress, quick) -> Section
PARTS = {
    "precision": "precision.diagram",
    "multiscale": "speed.multiscale",
    "ensembles": "ensembles.comparison",
    "state-laws": "state_laws.comparison",
    "verification": "accuracy.verification",
    "calibration": "accuracy.calibration",
    "conservation": "accuracy.conservation",
    "scaling": "speed.scaling",
    "roofline": "speed.roofline",
    "startup": "speed.startup",
    "studies": "speed.studies",
}


def main() -> None:
    """Run the parts asked for and report them."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=PARTS, help="parts to run")
    parser.add_argument("--quick", action="store_true", help="a shortened version of each")
    parser.add_argument("--out", type=Path, default=Path("benchmark-results"), help="directory")
    options = parser.parse_args()
    console = Console()
    columns = (*Progress.get_default_columns()[:2], MofNCompleteColumn(), TimeElapsedColumn())
    sections = {}
    start = perf_counter()
    for name in options.only:
        with Progress(*columns, console=console) as progress:
            part = import_module(f".{PARTS[name]}", __package__)
            sections[name] = part.run(progress, options.quick)
        show(console, sections[name])
        save(options.out, sections, perf_counter() - start)
    console.print(f"Written to {options.out}: results.md, results.json and the figures")


if __name__ == "__main__":
    main()
