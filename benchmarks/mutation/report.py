"""The outcome of mutants by room, and the list of survivors."""

from __future__ import annotations

import tomllib
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from .mutants import Mutant

KNOWN = Path(__file__).with_name("equivalent.toml")
KINDS = ("killed", "timeout", "survived", "unreached")

Key = tuple[str, str, str]


def equivalent() -> dict[Key, str]:
    """Return the mutants that were looked at and do what the code does, with the reason."""
    rows = tomllib.loads(KNOWN.read_text(encoding="utf-8")).get("mutant", [])
    return {(row["file"], row["before"], row["after"]): row["why"] for row in rows}


def report(rows: Sequence[Mapping[str, Any]], known: Mapping[Key, str]) -> int:
    """Print what came of the mutants; return how many have survived and are not equivalent."""
    console, counts, left = Console(width=160), defaultdict(Counter), []
    for row in rows:
        mutant, kind = Mutant(*row["mutant"]), row["outcome"]
        room = Path(mutant.path).parent.as_posix()
        for name in (room, "all"):
            counts[name]["drawn"] += 1
            counts[name][kind] += 1
        if kind in ("survived", "unreached"):
            if mutant.key in known:
                counts[room]["equivalent"] += 1
                counts["all"]["equivalent"] += 1
            else:
                left.append((kind, mutant))
    for kind, mutant in left:
        console.print(f"{kind} {mutant.path}:{mutant.line} ({mutant.operator})", style="bold")
        console.print(f"  - {mutant.before}\n  + {mutant.after}", markup=False, highlight=False)
    headings = ("drawn", *KINDS, "equivalent")
    table = Table("room", *headings, "left", box=box.SIMPLE)
    for name in sorted(counts, key=lambda each: (each == "all", each)):
        each = counts[name]
        alive = each["survived"] + each["unreached"] - each["equivalent"]
        table.add_row(
            name, *(str(each[kind]) for kind in headings), f"{alive} ({alive / each['drawn']:.1%})"
        )
    console.print(table)
    return len(left)
