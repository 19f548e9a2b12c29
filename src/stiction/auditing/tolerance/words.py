"""The tolerance budget of a rig in sentences and a table."""

from __future__ import annotations

from decimal import ROUND_DOWN, Context, Decimal
from math import degrees, isnan

from stiction.auditing.tolerance.budget import Alignment, Budget, Reading
from stiction.text.quantity_text import percent
from stiction.text.sections import Section, Table
from stiction.text.units import in_words

TITLE = "How well to align"
ROWS = (  # label and unit of each reading
    ("apparent static friction, largest force", ""),
    ("apparent kinetic friction, mean", ""),
    ("creep before the first slip", "m"),
    ("transverse oscillation, up to V sin φ/ω_y", "m"),
)


def section(found: Budget) -> Section:
    """Return the budget as a section of a report."""
    low, middle, high = (in_words(end, "rad") for end in found.ends)
    static = in_words(found.aligned.static, "")
    lines = [
        limit(found.alignment),
        f"The error is relative to what this rig reads without misalignment, {static}, at the same "
        "drive, load and friction.",
        f"The misalignment is {middle}, with 95 % probability {low} to {high}. The last column "
        f"holds 95 % of {len(found.drawn)} simulated tests with parameters drawn from their "
        "priors.",
    ]
    if found.others:
        lines.append(
            f"Also uncertain, there only: {', '.join(found.others)}. In the other columns they "
            "are in the middle of their priors."
        )
    unread = int(sum(isnan(each) for each in found.drawn[:, Reading._fields.index("static")]))
    if unread:
        lines.append(f"{unread} of the tests could not be simulated to their end.")
    return Section(TITLE, lines, table(found))


def limit(found: Alignment) -> str:
    """Return how well to align, in a sentence."""
    share = percent(found.allowed)
    if not isnan(found.angle):
        angle, first = round_down(degrees(found.angle)), round_down(degrees(found.first))
        said = f"Align to better than {angle:g} deg to keep the error of mu_static below {share}."
        single = f" That is a mean: single tests are off by more from {first:g} deg on."
        return said + single * (first < angle)
    if found.least > found.allowed:
        return (
            f"Alignment to {in_words(found.until, 'rad')} is not enough to keep the error of "
            f"mu_static below {share}: it is {percent(found.least, 3)} there."
        )
    return f"An error of mu_static of {share} is not reached up to {in_words(found.until, 'rad')}."


def round_down(value: float) -> float:
    """Return a positive value, its third digit and all after it cut off.

    The largest force scatters with the phase of the transverse oscillation when the slip begins:
    more digits would differ with the smallest change of the rig.

    >>> round_down(2.397), round_down(0.0429)
    (2.3, 0.042)
    """
    return float(Decimal(value).normalize(Context(prec=2, rounding=ROUND_DOWN)))


def table(found: Budget) -> Table:
    """Return the readings without misalignment, over its range, and of all draws."""
    ends = tuple(f"at {in_words(end, 'rad')}" for end in found.ends)
    rows = []
    for i, (label, unit) in enumerate(ROWS):
        low, high = (in_words(end, unit) for end in found.intervals[:, i])
        values = (in_words(each, unit) for each in (found.aligned[i], *found.at_ends[:, i]))
        rows.append((label, *values, f"{low} to {high}"))
    return Table(("quantity", "aligned", *ends, "95 %"), rows)
