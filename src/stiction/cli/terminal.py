"""Printing on the command line, safe from control characters and encoding errors."""

from __future__ import annotations

import codecs
import os
import sys
from contextlib import suppress
from typing import TextIO

from rich.console import Console

from stiction.errors import visible

# replacements for letters that a terminal lacks
PLAIN = {
    "µ": "u", "φ": "phi", "θ": "theta", "ψ": "psi", "ζ": "zeta", "ω": "omega", "·": " ",
    "°": " deg", "²": "^2", "³": "^3", "∞": "inf", "−": "-", "–": "-", "±": "+-", "×": "x",
    "…": "...", "≥": ">=", "≤": "<=",
}  # fmt: skip


def say(text: str, *, error: bool = False) -> None:
    """Print a text with control characters escaped, to standard error if `error`."""
    print(visible(text), file=sys.stderr if error else sys.stdout)


def note(text: str) -> None:
    """Print a line as it is on standard error as it is now, above any progress bar."""
    console = Console(stderr=True, soft_wrap=True, emoji=False)
    console.print(text, markup=False, highlight=False)


def spell_out() -> None:
    """Replace letters that the terminal's encoding lacks."""
    codecs.register_error("spelled", _spell)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="spelled")


def _spell(error: UnicodeError) -> tuple[str, int]:
    assert isinstance(error, UnicodeEncodeError)
    letters = error.object[error.start : error.end]
    return "".join(PLAIN.get(x, ascii(x)[1:-1]) for x in letters), error.end


def give_up(stream: TextIO | None) -> None:
    """Redirect a closed stream to nowhere; Python would try to write again at exit."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())  # type: ignore[union-attr]
