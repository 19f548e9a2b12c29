"""The requests of a page, by name, and the answers: heads and arrays.

An answer comes in parts, each better than the one before; ``check`` ends it when nobody waits for
it any more. A new request is a function here and a line in `ANSWERS`.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping
from math import copysign, degrees, log10
from typing import TYPE_CHECKING, Any

import numpy as np

import stiction
from stiction.comparison import comparable, exchange_law
from stiction.errors import StictionError, echo
from stiction.explorer import motion, spectrum
from stiction.explorer.decimation import columns_of, extremes
from stiction.explorer.exports import NAMES, export
from stiction.explorer.form import form, units
from stiction.explorer.motion import Check, Reply
from stiction.explorer.protocols import names, protocol
from stiction.explorer.source import Opened
from stiction.friction import LAWS
from stiction.linear_stability.linear import growth_at, growth_rate
from stiction.media.sound import RATE, SHORTEST_SOUND, audible_speed, rate_at
from stiction.presets import PRESETS, find
from stiction.system.description import Description
from stiction.system.parameter import change_unchecked
from stiction.text.quantity.wording import in_words

if TYPE_CHECKING:
    from stiction.study.view.view import View

Request = Mapping[str, Any]
WIDEST = 8192  # columns of a screen
LOUDEST = 60.0  # s of sound
ANGLES = (0.1, 90.0)  # of misalignment, deg
DECADES = 3  # of the drive's velocity, to each side of its present one
LEVELS = ((12, 12), (24, 24), (48, 48))  # cells, from coarse to fine


def answer(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the answers to a request.

    Raises
    ------
    StictionError
        If it cannot be answered; a `DescriptionError` has every fault.
    """
    known = ANSWERS.get(str(request.get("do")))
    if known is None:
        raise StictionError(f"{echo(request.get('do'))} is unknown; known: {', '.join(ANSWERS)}")
    yield from known(opened, request, check)


def start(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the page's initial data: its form, its menus, and the system that it opens."""
    study = None if opened.study is None else study_map(opened)
    head = {
        "version": stiction.__version__,
        "preset": opened.preset,
        "units": units(),
        "form": form({name: type(each) for name, each in opened.own.items()}),
        "protocols": names(),
        "presets": [{"name": name, "shows": each.shows} for name, each in PRESETS.items()],
        "tables": tables_of(opened.description),
        "origin": opened.origin if opened.measured is not None else "",
        "study": None if study is None else study[0],
    }
    yield head, {} if study is None else study[1]


def tables_of(description: Description) -> dict[str, Any]:
    """Return the tables of a description as its file has them, each quantity with its unit."""
    return tomllib.loads(description.to_toml())


def description_in(opened: Opened, request: Request) -> Description:
    """Return the description in a request."""
    tables = request.get("tables")
    return opened.read(tables if isinstance(tables, Mapping) else {})


def columns(request: Request) -> int:
    """Return how many columns of pixels a page has."""
    return min(max(int(request.get("columns", 600)), 16), WIDEST)


def run(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the whole run, and the parameters in SI, which set the page's sliders."""
    description = description_in(opened, request)
    title, changed = opened.title(description, request.get("origin"))
    about = {"title": title, "changed": changed, "values": description.to_dict()}
    for head, arrays in motion.run(description, columns(request), check):
        yield {**head, **about}, arrays


def zoom(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the curves of a window of a run."""
    description = description_in(opened, request)
    window = motion.window_of(description, request.get("window"))
    yield from motion.zoom(description, window, columns(request), check)


def fine(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the samples about a time."""
    time, width = float(request["time"]), float(request["width"])
    yield from motion.fine(description_in(opened, request), time, width, check)


def measured_curves(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the measured curves in a window of a run, s."""
    if opened.measured is None:
        return
    low, high = (float(each) for each in request["window"])
    start, end = (float(each) for each in request["run"])
    times, origin = opened.measured_during((start, end))
    places, starts = columns_of(times, (low, high), columns(request))
    drawn = {
        name: extremes(values, starts) for name, values in opened.measured.items() if name != "time"
    }
    head = {"window": (low, high), "origin": origin, "columns": columns(request)}
    yield head, {"column": places.astype(np.float32), **drawn}


def stability(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield maps of the stability of steady sliding."""
    yield from stability_map(description_in(opened, request), check)


def spectrogram(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the spectrogram of the transverse rate: amplitudes (m/s), frequency by time."""
    yield spectrum.spectrogram(description_in(opened, request), check)


def sound(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the transverse rate v_y (m/s) as sound, as slow and deep as it can be heard.

    ``speed`` is time in the run over time in the sound, as of `stiction.listen`.
    """
    description = description_in(opened, request)
    low, high = motion.span(description)
    speed = audible_speed(description)
    high = min(high, low + LOUDEST * speed)
    if (high - low) / speed < SHORTEST_SOUND:
        lasts, least = in_words(high - low, "s"), in_words(SHORTEST_SOUND * speed, "s")
        raise StictionError(f"a run of {lasts} is too short to be heard; let it last {least}")
    count = int((high - low) / speed * RATE)
    times = low + np.arange(count, dtype=np.float64) * (speed / RATE)
    values = rate_at(description, times, progress=lambda _: check())
    if not values.any():
        raise StictionError("no sound: nothing oscillates along y in this run")
    yield {"rate": RATE, "start": low, "speed": speed}, {"sound": values.astype(np.float32)}


def preset(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the tables of a published system."""
    yield {"tables": tables_of(find(str(request["name"])).make())}, {}


def law(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the tables with another friction law, comparable with the present one."""
    description, name = description_in(opened, request), str(request["name"])
    own = opened.own
    if name not in LAWS and name not in own:
        raise StictionError(f"no law {echo(name)}; known: {', '.join((*LAWS, *own))}")
    other = own[name] if name in own else comparable(LAWS[name], description)
    yield {"tables": tables_of(exchange_law(description, other))}, {}


def test(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the tables with a friction test by its name."""
    table, name = str(request["table"]), str(request["name"])
    yield {"tables": tables_of(protocol(description_in(opened, request), table, name))}, {}


def pick(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield the tables of one run of the study."""
    yield {"tables": tables_of(opened.run_at(dict(request["at"])))}, {}


def file(opened: Opened, request: Request, check: Check) -> Iterator[Reply]:
    """Yield a file to download."""
    kind = str(request.get("kind"))
    if kind not in NAMES:
        raise StictionError(f"no export {echo(kind)}; known: {', '.join(NAMES)}")
    name, content = export(description_in(opened, request), kind, check)
    yield {"name": name}, {"content": np.frombuffer(content, np.uint8)}


def study_map(opened: Opened) -> Reply:
    """Return the map of a study: the colour of each run as in its figure, and their meaning."""
    from stiction.plotting.shades import (
        COLORS,
        NO_RESULT,
        NO_VALUE,
        kind_codes,
        kind_shades,
        legend_of,
        measure_shades,
        present_kinds,
    )
    from stiction.study.view.mapping import measure_in_unit
    from stiction.study.view.view import REGIME, choose_measures, kinds

    view = opened.study
    assert view is not None
    (name,) = choose_measures(view, ())[:1]
    head: dict[str, Any] = {"axes": study_axes(view), "kinds": None, "bar": None}
    if name == REGIME:
        named = kinds(view.data)
        shades, values = kind_shades(), kind_codes(named)
        head |= {"measure": name, "missing": NO_RESULT}
        head["kinds"] = [(legend_of(each), COLORS[each]) for each in present_kinds(named)]
    else:
        values, words = measure_in_unit(view.data, name)
        shades = measure_shades(values)
        head |= {"measure": words, "missing": NO_VALUE}
        head["bar"] = {"limits": shades.limits, "log": shades.log}
    return head, {"map": shades.rgba(values), "bar": shades.bar}


def study_axes(view: View) -> list[dict[str, Any]]:
    """Return name, values and unit of each dimension of a map."""
    axes = []
    for dim in map(str, view.data["status"].dims):
        known = view.study.coordinates.get(dim)
        values = np.arange(view.data.sizes[dim]) if known is None else known.values
        unit = "" if known is None else known.unit
        axes.append({"dim": dim, "values": values.tolist(), "unit": unit})
    return axes


ANSWERS: dict[str, Callable[[Opened, Request, Check], Iterator[Reply]]] = {
    "start": start,
    "run": run,
    "zoom": zoom,
    "fine": fine,
    "measured": measured_curves,
    "stability": stability,
    "spectrogram": spectrogram,
    "sound": sound,
    "preset": preset,
    "law": law,
    "protocol": test,
    "pick": pick,
    "export": file,
}


def stability_map(description: Description, check: Check) -> Iterator[Reply]:
    """Yield maps of the growth rate (1/s), rows of velocity by columns of angle, each finer.

    Raises
    ------
    StictionError
        If there is no steady sliding.
    """
    slider = description.slider
    side = copysign(1.0, slider.phi)
    middle = round(log10(abs(slider.motion.velocity) or 1e-3))
    way = copysign(1.0, slider.motion.velocity)
    low, high = 10.0 ** (middle - DECADES), 10.0 ** (middle + DECADES)
    growth_rate(slider)  # or say why there is none
    for across, up in LEVELS:
        angles = np.radians(middles(*ANGLES, across)) * side
        speeds = middles(low, high, up) * way
        found = np.full((up, across), np.nan, np.float32)
        for row, speed in enumerate(speeds):
            driven = change_unchecked(slider, "drive.velocity", float(speed))
            for column, angle in enumerate(angles):
                check()
                found[row, column] = growth_at(driven, "phi", float(angle))
        head = {"angles": ANGLES, "speeds": (low, high), "own": degrees(abs(slider.phi))}
        yield head, {"growth": found}


def middles(low: float, high: float, count: int) -> np.ndarray:
    """Return the middles of cells of equal ratio."""
    edges = np.geomspace(low, high, count + 1)
    found: np.ndarray = np.sqrt(edges[1:] * edges[:-1])
    return found
