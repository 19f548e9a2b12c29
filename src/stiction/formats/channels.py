"""The channels of a record: their names in files, and their stored units."""

from __future__ import annotations

import re
from typing import NamedTuple


class Channel(NamedTuple):
    """A channel: its meaning, its SI unit, an example of another unit, and its usual names.

    `names` matches a column's whole name, in lower case with spaces for ``_`` and ``-``.
    """

    meaning: str
    unit: str
    example: str
    names: re.Pattern[str]


def _channel(meaning: str, unit: str, example: str, names: str) -> Channel:
    return Channel(meaning, unit, example, re.compile(names))


# of a column in lower case; `t`, `Zeit` and the like as instruments in use write them
CHANNELS = {
    "time": _channel(
        "time",
        "s",
        "ms",
        r"(test |elapsed |total |run(ning)? |step |sample )?time( stamp)?( \d+)?|t|timestamp|zeit|"
        r"(mess|prüf|versuchs)zeit|temps|tiempo|tempo|x value|x values|seconds|date ?time|uhrzeit",
    ),
    "force": _channel(
        "force along the drive",
        "N",
        "mN",
        r"(friction(al)?|tangential|shear|spring|pull(ing)?|drag|horizontal|x) force( x)?|"
        r"force( x)?|"
        r"f|f ?[xtrf]|f ?fr(ic)?|ft?|kraft|kraft x|reib(ungs)?kraft|zugkraft|tangentialkraft|"
        r"force along.*|load ?cell|spring x|friction(al)?|fuerza|forza|force de frottement|"
        r"(force|effort) tangentiel(le)?|f(ue|o)rza (tangen[cz]iale?|de fricci[oó]n|di attrito)",
    ),
    "force_across": _channel(
        "force across the drive",
        "N",
        "mN",
        r"f ?y|(transverse|y|cross|side) force|force (across.*|y)|kraft y|querkraft|spring y",
    ),
    "load": _channel(
        "normal load",
        "N",
        "N",
        r"f ?[nz]|(normal|vertical|z|contact) (force|load)|force z|normal|kraft z|"
        r"normal(kraft|last)|load|last|w|(force|effort|charge) normale?|f(ue|o)rza normale?|"
        r"carga|carico",
    ),
    "position": _channel(
        "displacement of the mass",
        "m",
        "um",
        r"(mass|slider|pin|sample|block|specimen|probe) (position|displacement|travel|x)",
    ),
    "drive_position": _channel(
        "displacement of the drive",
        "m",
        "um",
        r"(drive|stage|actuator|motor|crosshead|traverse|table|ram|spindle|antrieb|tisch) ?"
        r"(position|displacement|travel|stroke|weg|x)|stage|actuator|crosshead|"
        r"(load ?point|lp)( (position|disp|displ|displacement|travel))?|lpd",
    ),
    "slip_speed": _channel("slip speed", "m/s", "mm/s", r"(slip|sliding|slider) (speed|velocity)"),
}
OWN = ("spring x", "spring y")  # of results, which have the friction force beside them
RATIO = re.compile(
    r"(apparent |kinetic )?(mu|µ|μ|cof|f/(mg|w|n|fn)|ft/fn|fx/fz|friction coefficient|"
    r"coefficient of friction|coef friction|reib(ungs)?(zahl|wert|koeffizient))( x)?"
)
# a length that may be either displacement: it is used only where the user says which
LENGTH = re.compile(
    r"x|pos|position|((shear|slip|horizontal|lateral|tangential|total) )?(disp|displ|displacement)|"
    r"travel|stroke|weg|verschiebung|course|d[eé]placement|desplazamiento|spostamento|"
    r"lvdt( \d+)?|slip"
)


def plain(name: str) -> str:
    """Return a column's name as the patterns expect it."""
    return " ".join(re.sub(r"[_\-.:()\[\]]+", " ", name.lower()).split())
