"""A kind of motion with its confidence and evidence, and their words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Literal, NamedTuple

from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    RESTING_SHARE,
    STICK_SLIP,
    TRANSITIONAL,
    TRANSVERSE,
    UNDETERMINED,
)
from stiction.text.quantity.wording import advice, in_words, percent

# Names of evidence: a checker finds one that is misspelt where others look for it
# fmt: off
Evidence = Literal[
    "cycles", "rise_share", "rest_share", "slower_share", "backward", "against", "still_share",
    "stick_share", "cycles_alike", "period_spread", "drop_spread", "natural_period",
    "drop_over_noise", "line_taken_off", "beat", "wave", "wave_period", "plateaus", "straight",
    "changed_at", "mains", "swings", "over", "last_over_first", "turns", "driven", "levels",
    "unloaded", "turned", "rests", "change", "span", "scatter", "loads_on", "wanders",
    "falls_at", "falls_by", "slips_at", "slips_by", "slips_by_error", "slips_within",
    "ends_falling_from", "ends_falling_by", "stops", "ended_early", "across", "late_share",
    "one_way", "rate_kept", "rate_over_drive", "hump", "hump_height", "fading", "fades_to",
    "hidden", "hidden_height", "quick_falls", "quick_fall", "gaps", "few_periods", "late_sticks",
    "samples_per_cycle", "unexplained", "fastest_slip", "rate_needed", "samples", "unchanging",
    "forth", "back",
]
# fmt: on
SLOWER: Final = "slower_share"  # evidence, too: of the motion itself, as an audit knows it
# Evidence of rest or creep, by the shape and the slip
SLOW_SHARES: tuple[Evidence, ...] = "rest_share", "still_share"
# Evidence of a force that goes back and forth with the drive
TO_AND_FRO: tuple[Evidence, ...] = "forth", "plateaus"
CERTAIN = 0.995  # a confidence that is written as 1.00: it leaves no room for another kind
NO_MORE = 1e-6  # a ratio that is less is nothing, up to rounding


def _whole(value: float) -> str:
    return f"{value:.0f}"


def _three_digits(value: float) -> str:
    return f"{float(f'{value:.3g}'):g}" if abs(value) > NO_MORE else "0"


def _force(value: float) -> str:
    return in_words(value, "N")


def _seconds(value: float) -> str:
    return in_words(value, "s")


def _frequency(value: float) -> str:
    return in_words(value, "Hz")


WORDS: dict[Evidence, tuple[str, Callable[[float], str]]] = {
    "cycles": ("complete cycles: {}", _whole),
    "rise_share": ("the force rises for {} of a cycle (a sine: 50 %, a sawtooth: 100 %)", percent),
    "rest_share": ("by this shape the mass rests or creeps for {} of it", percent),
    SLOWER: ("the mass is slower than the drive for {} of it", percent),
    "backward": (
        "it falls slowly and rises fast in {} of the cycles, as stick-slip with the other sign",
        percent,
    ),
    "against": ("all peaks are against the drive, by {} or more, though its zero is right", _force),
    "still_share": (
        "the slip speed stays below a tenth of the drive velocity for {} of it",
        percent,
    ),
    "stick_share": ("the mass sticks for {} of it", percent),
    "cycles_alike": ("{} of the cycles, each by itself, have this shape", percent),
    "period_spread": ("periods differ by {} of their mean", percent),
    "drop_spread": ("four fifths of the force drops differ by up to {} of their median", percent),
    "natural_period": ("a period is {} times the mass's own on its spring", _three_digits),
    "drop_over_noise": ("force drops are {} times as high as noise reaches", _three_digits),
    "line_taken_off": ("a line at {} was subtracted from the force", _frequency),
    "beat": ("two vibrations beat at {}", _frequency),
    "wave": ("a slower wave of {} from crest to trough carries the cycles", _force),
    "wave_period": ("it comes every {}", _seconds),
    "plateaus": (
        "it stays near its largest or its smallest value for {} of the time, as no vibration does: "
        "the drive goes back and forth, or the load changes in steps",
        percent,
    ),
    "straight": (
        "it rises and falls evenly, and turns at once, as no vibration does: it is within a tenth "
        "of its swing from either end for {} of the time (a sine: 41 %)",
        percent,
    ),
    "changed_at": ("at {} the cycles change", _seconds),
    "mains": ("it swings at {} as the mains do: it may be hum over another motion", _frequency),
    "swings": ("{} swings, each smaller than the last but for noise", _whole),
    "over": ("{} swings, and none for long after", _whole),
    "last_over_first": ("the last force drop is {} times the first", _three_digits),
    "turns": ("{} peaks and troughs make no complete cycle", _whole),
    "driven": ("swings that follow jumps of the drive's velocity: {}", _whole),
    "levels": ("it stays at {} levels, one after the other", _whole),
    "unloaded": ("that is until {}, and it is next to zero later", _seconds),
    "turned": (
        "that is until {}, where the drive turns or stops, or the spring begins to be unloaded",
        _seconds,
    ),
    "rests": ("friction holds it from beginning to end, for {}", _seconds),
    "change": ("the force changes by {} from beginning to end", _force),
    "span": ("it spans {}, averaged over a 32nd of the time", _force),
    "scatter": ("it scatters by {} about that", _force),
    "loads_on": (
        "it begins unloaded, changes by {}, and does not settle: the record may show one slip "
        "only, or a part of a cycle",
        _force,
    ),
    "wanders": (
        "it wanders by {}, too smoothly for noise: either friction changes, or cycles are longer "
        "than the record shows",
        _force,
    ),
    "falls_at": ("it falls quickly once, at {}", _seconds),
    "falls_by": ("by {}", _force),
    "slips_at": ("it falls quickly at {}, loaded evenly before, and as fast again after", _seconds),
    "slips_by": ("by {}", _force),
    "slips_by_error": ("within {} of that, as far as noise hides it", _force),
    "slips_within": ("within {}", _seconds),
    "ends_falling_from": ("from {} to the end it falls", _seconds),
    "ends_falling_by": ("by {} or more", _force),
    "stops": ("at the end, at {}, it rests with the drive", _seconds),
    "ended_early": ("the run ended early, at {}", _seconds),
    "across": (
        "at the end it oscillates across the drive, by {} of the drive's velocity there",
        percent,
    ),
    "late_share": ("in the last quarter of the time it spans {} of this", percent),
    "one_way": ("this change is {} of the sum of its rises and falls", percent),
    "rate_kept": ("its rate at the end is {} of that at the beginning", percent),
    "rate_over_drive": ("at the end its rate is {} of stiffness times drive velocity", percent),
    "hump": ("it vibrates at about {}, in swings of every size", _frequency),
    "hump_height": ("in the spectrum they stand {} times above the threshold", _three_digits),
    "fading": ("it vibrates at about {}, less and less", _frequency),
    "fades_to": ("at the end {} or less of that is left", percent),
    "hidden": ("it swings at {}, by its spectrum", _frequency),
    "hidden_height": ("by {} from crest to trough, in noise that hides their shape", _force),
    "quick_falls": (
        "it falls quickly {} times, and hardly ever rises so quickly, as where a mass slips",
        _whole,
    ),
    "quick_fall": ("the median of these falls is {}", _force),
    "gaps": ("{} of the time lies in gaps; without them it shows no such motion", percent),
    "few_periods": (
        "it may vibrate at about {}, or scatter: for so slow a vibration the record is too short",
        _frequency,
    ),
    "late_sticks": (
        "in the last quarter of the time the mass sticks {} times, which the samples do not show",
        _whole,
    ),
    "samples_per_cycle": ("a cycle has {} samples, too few to show it", _three_digits),
    "unexplained": (
        "the samples are too far apart to show the motion: from one to the next the force changes "
        "by up to {} of its smallest swing in a way that its rates do not explain",
        percent,
    ),
    "fastest_slip": (
        "the mass slips at up to {} times the drive's velocity, so that it is not stuck",
        _three_digits,
    ),
    "rate_needed": ("sample at {} or more", lambda value: advice(value, "Hz")),
    "samples": ("number of samples: {}, too few", _whole),
    "unchanging": ("all samples are exactly {}", _force),
    "forth": ("one way the force is about {}", _force),
    "back": ("the other way {}", _force),
}


class Regime(NamedTuple):
    """A kind of motion, with its confidence and evidence.

    Parameters
    ----------
    kind : str
        "stick-slip" (at rest, or in creep, for three quarters of a cycle or more, by the shape of
        the cycle; or for half of it or more where the slip speed is known; in a run, if it sticks
        in each cycle, however shortly),
        "transitional oscillation" (for half of it or more by the shape), "harmonic vibration" (for
        less or not at all), "transverse oscillation" (of a run, quicker than the mass can swing on
        the spring along x alone), "irregular vibration" (swings of changing period that stand out),
        "settling" (a transient that decays), "steady sliding" (no swings stand apart from the
        noise: what is smaller is not seen), "stuck" (it loads and never slips, or rests) or
        "undetermined".
    confidence : float
        0 to 1. With cycles, the likelihood that another one has the kind's shape, from their
        scatter, or from the number of those with another shape. Thus it is higher for cycles
        that are alike than for different ones, and for thirty than for three. Without cycles, it
        is less for a run that ended early, by the share of its duration that it reached.
    evidence : dict
        Numbers behind the decision; ``str(regime)`` puts them into words.
    runner_up : str
        The second most frequent kind among the cycles; empty if there is none.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="1 kHz")
    >>> found = st.analysis.classify(run)
    >>> found.kind, found.confidence > 0.9
    ('stick-slip', True)
    """

    kind: str
    confidence: float
    evidence: dict[Evidence, float]
    runner_up: str = ""

    def __repr__(self) -> str:
        """Return the kind and its confidence; ``str(regime)`` tells why."""
        other = f", perhaps {self.runner_up}" if self.runner_up else ""
        return f"<Regime: {self.kind} with confidence {self.confidence:.2f}{other}>"

    def has(self, *names: Evidence) -> bool:
        """Return whether the evidence has any of these names, which a checker knows."""
        return any(name in self.evidence for name in names)

    @property
    def loads(self) -> bool:
        """Whether the mass rests, or creeps, for most of the time in which its spring is loaded.

        Then the peaks show static friction, and the loading shows stiffness and creep. A mass that
        sticks only shortly is still slower than the drive, or faster, for most of that time.
        """
        rests = max(self.evidence.get(name, 0.0) for name in SLOW_SHARES)
        return self.kind in (STICK_SLIP, TRANSITIONAL) and rests >= RESTING_SHARE

    @property
    def rests(self) -> str:
        """How long a mass that sticks and slips rests, in words; empty if it does not stick."""
        if self.kind not in (STICK_SLIP, TRANSITIONAL):
            return ""
        if not self.loads and self.has("stick_share"):
            return f"stuck for {percent(self.evidence['stick_share'])} of a cycle"
        if self.has(SLOWER):
            share = percent(self.evidence[SLOWER])
            return f"with the mass slower than the drive for {share} of a cycle"
        slow = [self.evidence[name] for name in SLOW_SHARES if name in self.evidence]
        return f"at rest or in creep for {percent(max(slow))} of a cycle" if slow else ""

    @property
    def surely(self) -> str:
        """The kind, its confidence, and how long the mass rests, in words.

        What is undetermined has no confidence in words: that in its cycles is none in a kind.
        """
        if self.kind == UNDETERMINED:
            return f"{self.kind}, perhaps {self.runner_up}" if self.runner_up else self.kind
        other = f"; else {self.runner_up}" if self.runner_up and self.confidence < CERTAIN else ""
        rests = f", {self.rests}" if self.rests else ""
        return f"{self.kind} (confidence {self.confidence:.2f}{other}){rests}"

    @property
    def grounds(self) -> str:
        """The evidence in words."""
        # a vibration does not rest: its shape is only an estimate of that
        none = {"rest_share"} if self.kind in (HARMONIC, TRANSVERSE) else set()
        said = ((*WORDS[name], value) for name, value in self.evidence.items() if name not in none)
        return "; ".join(text.format(written(value)) for text, written, value in said)

    def __str__(self) -> str:
        """Return the kind, its confidence and the evidence in words."""
        return f"{self.surely}: {self.grounds}"
