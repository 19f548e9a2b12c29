"""A value in an SI unit as it stands in a sentence: with the digits that its error allows."""

from __future__ import annotations

import re
from math import ceil, floor, inf, isfinite, isinf, isnan, log10

from stiction.text.quantity.prefix import DIGITS, suited_unit

LARGE = 1e6  # a number below it is written without a power of ten
ROUNDING = 1e-12  # relative: what many sums of floating-point numbers are off by
LEAST_ERROR = 1e-30  # SI units: a smaller one only keeps a divisor from zero
ALL = 1e-6  # a share that is less is none, and one that lacks less is the whole
SLIGHT = 1e-3  # of a value: an error that is less is not worth a word
MEASURABLE = 1e-12  # m, a hundredth of an atom: no instrument follows a mass so closely


def percent(share: float, digits: int = 2) -> str:
    """Return a share in per cent as text; one below the whole is not rounded up to it.

    Examples
    --------
    >>> percent(0.974), percent(0.9953), percent(0.0036), percent(1.0), percent(1.25)
    ('97 %', '99.5 %', '0.36 %', '100 %', '125 %')
    """
    shown, rest = 100.0 * share, 100.0 * (1.0 - share)
    if abs(share) < ALL:
        return "0 %"
    if 100.0 * ALL < rest < 0.5 * 10.0 ** (2 - digits):
        decimals = -floor(log10(rest))  # down to the first digit of the rest
        return f"{floor(shown * 10.0**decimals) / 10.0**decimals:.{decimals}f} %"
    digits = max(digits, len(f"{abs(shown):.0f}"))
    return f"{float(f'{shown:.{digits}g}'):g} %"


def in_words(value: float, unit: str, digits: int = DIGITS) -> str:
    """Return a value in an SI unit as text with a suitable prefix; an angle in degrees.

    Of a length that no instrument can measure, only that is said.

    Examples
    --------
    >>> in_words(3.49e-5, "m"), in_words(0.0174533, "rad"), in_words(float("nan"), "N")
    ('34.9 µm', '1 deg', 'none')
    >>> in_words(4e-14, "m")
    '< 1 pm'
    >>> in_words(0.0123456, "kg", 6), in_words(0.02, "1/s")
    ('12.3456 g', '0.02 1/s')
    """
    if isnan(value):
        return "none"
    if isinf(value):
        return "∞" if value > 0.0 else "-∞"
    if unit == "m" and 0.0 < abs(value) < MEASURABLE:
        return "< 1 pm"
    return _plainly(value, unit, f".{digits}g", digits)


def _plainly(value: float, unit: str, form: str, digits: int) -> str:
    """Return a finite value in a suitable unit, in so many digits of a form, without a power."""
    size, name = suited_unit(value, unit, digits)
    shown = format(value / size, form).rstrip(".")
    if "e+" in shown and abs(float(shown)) < LARGE:
        shown = f"{float(shown):.0f}"
    plain = re.sub(r"e([+-])0*", lambda power: f"e{power[1].strip('+')}", shown)
    return f"{plain} {name}".rstrip()


def advice(value: float, unit: str) -> str:
    """Return a least value that is advised, in two digits: rounded up, so that it suffices.

    >>> advice(5033.0, "Hz"), advice(0.0624, "s"), advice(0.1 + 0.2, "Hz")
    ('5.1 kHz', '63 ms', '300 mHz')
    """
    size = 10.0 ** (floor(log10(value)) - 1)
    return in_words(ceil(value / size * (1.0 - ROUNDING)) * size, unit)


def span(low: float, high: float, unit: str, digits: int = DIGITS) -> str:
    """Return two values in an SI unit as text, with the unit once where both have the same.

    >>> span(2285.0, 2315.0, "N/m"), span(900.0, 1100.0, "N/m"), span(0.2, 0.3, "")
    ('2.285 to 2.315 kN/m', '900 N/m to 1.1 kN/m', '0.2 to 0.3')
    """
    begin, end = (in_words(value, unit, digits) for value in (low, high))
    number, _, name = begin.partition(" ")
    return f"{number if end.endswith(f' {name}') else begin} to {end}"


def interval(low: float, high: float, middle: float, unit: str) -> str:
    """Return an interval in one unit, its ends to two digits of their distance from its middle.

    >>> interval(2.257e-8, 0.03983, 0.018, "rad"), interval(2285.31, 2315.2, 2300.4, "N/m")
    ('0 to 2.3 deg', '2.285 to 2.315 kN/m')
    >>> interval(3.04e-3, 0.02987, 0.0101, "m/s"), interval(0.2, 0.3, 0.2, "")
    ('3.0 to 30 mm/s', '0.2 to 0.3')
    >>> interval(2252.71, 2261.44, 2260.0, "N/m"), interval(-1.2e-3, 4e-3, 1e-3, "N")
    ('2.253 to 2.261 kN/m', '-1.2 to 4.0 mN')
    """
    errors = middle - low, high - middle
    size, name = suited_unit(max(abs(low), abs(high)), unit)
    if not all(0.0 < error < inf for error in errors) or max(abs(low), abs(high)) >= LARGE * size:
        return span(low, high, unit)
    ends = []
    for end, error in zip((low, high), errors, strict=True):
        digit = first_decimal(error / size) + 1
        shown = round(float(f"{end / size:.{DIGITS}g}"), digit)
        digit = min(digit, DIGITS - 1 - floor(log10(abs(shown)))) if shown else 0
        ends.append(f"{shown + 0.0:.{max(digit, 0)}f}")  # no -0
    return f"{' to '.join(ends)} {name}".rstrip()


def times(ratio: float, digits: int = 2) -> str:
    """Return how many times something is another.

    >>> times(163.2), times(0.0341), times(1.2345, 3)
    ('160 times', '0.034 times', '1.23 times')
    """
    return f"{in_words(ratio, '1', digits)} times"


def first_decimal(value: float) -> int:
    """Return at which decimal a value has its first digit, as it is rounded to one.

    >>> first_decimal(0.0021), first_decimal(0.0098), first_decimal(30.0)
    (3, 2, -1)
    """
    return -floor(log10(float(f"{value:.1g}")))


def with_error(value: float, error: float, unit: str) -> str:
    """Return a value and its standard error in one unit, to the first digit of the error.

    Without an error above zero, or beyond that of rounding, return the value alone.

    Examples
    --------
    >>> with_error(0.97763, 0.0048, "N"), with_error(6.2e-5, 6e-7, "m/s"), with_error(2.0, 0.0, "N")
    ('978 ± 5 mN', '62.0 ± 0.6 µm/s', '2 N')
    >>> with_error(1.31e9, 8.2e8, "1/s²")
    '(1.3 ± 0.8)e9 1/s²'
    >>> with_error(0.0, 7e-151, "N/s")
    '0 N/s'
    """
    if not max(ROUNDING * abs(value), LEAST_ERROR) < error < inf or not isfinite(value):
        return in_words(value, unit)
    size, power, name = _scale(max(abs(value), error), unit)
    shown = float(f"{error / size:.1g}")
    digit = first_decimal(shown)
    rounded, decimals = round(value / size, digit) + 0.0, max(0, digit)  # no -0
    both = f"{rounded:.{decimals}f} ± {shown:.{decimals}f}"
    return f"{f'({both}){power}' if power else both} {name}".rstrip()


def in_digits(value: float, unit: str, digits: int) -> str:
    """Return a value in words, all of whose digits are known: its last zeros, too.

    Examples
    --------
    >>> in_digits(24.04, "s", 3), in_digits(0.1002, "", 2), in_digits(0.14, "N", 3)
    ('24.0 s', '0.10', '140 mN')
    """
    said = in_words(value, unit, digits)
    known = isfinite(value) and value != 0.0 and not said.startswith("<")
    return _plainly(value, unit, f"#.{digits}g", digits) if known else said


def to_error(value: float, error: float, unit: str) -> str:
    """Return a value to the first digit of its standard error, in no more digits than others.

    Examples
    --------
    >>> to_error(24.04, 0.21, "s"), to_error(0.13982, 1.4e-3, "N"), to_error(0.13982, 1e-9, "N")
    ('24.0 s', '140 mN', '139.8 mN')
    >>> to_error(3.0, 20.0, "N"), to_error(0.0, 0.1, "N"), to_error(1.5, float("nan"), "N")
    ('3 N', '0 N', '1.5 N')
    """
    if not 0.0 < error < inf or not isfinite(value) or value == 0.0:
        return in_words(value, unit)
    digits = first_decimal(error) + floor(log10(abs(value))) + 1
    return in_digits(value, unit, min(max(digits, 1), DIGITS))


def _scale(largest: float, unit: str) -> tuple[float, str, str]:
    """Return the size of the unit to write, a power of ten to write behind a number, and the unit.

    Only a large number of a unit without prefixes needs the power.
    """
    size, name = suited_unit(largest, unit)
    if largest / size < LARGE:
        return size, "", name
    power = floor(log10(largest / size))
    return size * 10.0**power, f"e{power}", name


def at_least(bound: float, error: float, unit: str) -> str:
    """Return a lower bound, rounded down to the first digit of its error, and not down to zero.

    One that is not above zero bounds nothing.

    Examples
    --------
    >>> at_least(1.10593, 7e-4, "N/s"), at_least(9377.0, 2100.0, "1/s²"), at_least(-0.1, 1.0, "N/s")
    ('≥ 1.1059 N/s', '≥ 9000 1/s²', 'not determined')
    >>> at_least(9.7, 9.6, "N/s"), at_least(0.7, 0.1, "N/s"), at_least(1.31e9, 2e8, "1/s²")
    ('≥ 9 N/s', '≥ 700 mN/s', '≥ 1.3e9 1/s²')
    """
    if not bound > 0.0:
        return "not determined"
    size, power, name = _scale(bound, unit)
    shown, smallest = bound / size, max(error, ROUNDING * bound) / size
    digit = max(first_decimal(smallest), -floor(log10(shown)))
    steps = floor(round(shown * 10.0**digit, 6))  # 0.7 is 6.999... times 0.1
    lower, decimals = steps / 10.0**digit, max(0, digit)
    return f"≥ {lower:.{decimals}f}{power} {name}".rstrip()
