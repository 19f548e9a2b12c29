"""``python -m benchmarks.explore.fuzz``: nonsense for every reader; none ends in a traceback.

Valid inputs are damaged by the byte, by the token and by the value. What reads them must take them
or raise a `stiction.StictionError`, which the command line tells in a message and exit status 2.
Deterministic in its seed. Exit status 1 if anything else was raised.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import traceback
import warnings
from collections.abc import Callable
from contextlib import chdir, redirect_stderr, redirect_stdout, suppress
from copy import deepcopy
from io import StringIO
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import h5py
import numpy as np

import stiction as st
from benchmarks.cases.record_files import read_damaged
from benchmarks.explore.draw import Draw
from stiction.cli import main as main_line
from stiction.cli.options import value as option
from stiction.comparison import read_laws
from stiction.result import file as run_file
from stiction.result.attributes import SEAL
from stiction.result.file import open_tables
from stiction.study.store.seal import seal
from stiction.text.toml import toml_text

STEPS = 200  # of a run; the solver's end is no part of what is looked at here
SECONDS = 2.0  # an input that takes longer is listed
NUMBERS = (
    0, -1, 1, 10**6, 10**9, 10**400, -(10**4000), 0.0, -0.0, 1e-320, 5e-324, 1e300, -1e300,
    1.8e308, 1e-9, 1e9, float("inf"), float("nan"), True,
)  # fmt: skip
TEXTS = (
    "", " ", "1", "1 N", "-1 mm/s", "1e400 N", "1e-400 m", "nan N", "inf s", "1 N**9999999",
    "1 N^-9", "1 N^2^9^9^9^9", "1 ((((((((m))))))))", "1 " + "(" * 5000, "1 " + "m " * 5000,
    "9" * 5000 + " N", "0." + "0" * 400 + "1 kg", "1,5 mm", "1 degC", "1 dB", "1 m/s/s", "1 %",
    "١ N", "１ N", "1_0 N", "\x1b[2J", "\x00", "{0}", "[red]", "a" * 5000, "__import__('os')",
    "coulomb", "x.py:Y", ":", "a:", "../x.py:Y", "/dev/zero:Y", "𝟙 s", "1e 5 s", "+-1 s", "0x10 s",
    "1e12 s", "1 THz", "1 s\n", "deg", "1 deg", "π rad",
)  # fmt: skip
TOKENS = (
    "=", "[", "]", "{", "}", ".", ",", '"', '"""', "'", "#", "\n", "\\", "\\u0000", "\\ud800",
    "1e400", "9" * 5000, "0x" + "f" * 5000, "[" * 5000, "{a=" * 3000, "a." * 3000, "é", "\ufeff",
    "1979-05-27T07:32:00Z", "[[x]]", "[slider]", "[axes.phi]", "inf", "nan", "true", "-", "\x1b",
    "\x00",
)  # fmt: skip
UNITS = ("kg", "N/m", "deg", "N", "m/s", "s", "Hz", "m", "um", "kN", "s/m", "rad", "N s/m", "h")
PARTS = (
    "1", "-1.5", "1e3", ".", "e", "m", "N", "s", "mm", "/", "*", "**", "^", "2", "-", "(", ")", " ",
    "·", "²", "⁻¹", "deg", "nan", "kN", "dB", "°C", "\x1b", "{", "%", "1e999",
)  # fmt: skip
PARAMETERS = ("phi", "V", "friction.mu_0", "drive.velocity.x", "run.duration", "slider", "a", ".")
KNOWN = ("normal_load", "stiffness", "drive_velocity", "mass", "zero", "time_unit", "force_unit")


def nest(depth: int) -> Any:
    """Return lists inside lists."""
    value: Any = []
    for _ in range(depth):
        value = [value]
    return value


def nonsense(draw: Draw) -> Any:
    """Return a value that hardly anything expects."""
    odd = [[], {}, [[]], [1, "a"], {"a": {"b": 1}}, [{}], {"": 0}, None]
    return draw.among(
        [
            lambda: draw.among(NUMBERS),
            lambda: draw.among(TEXTS),
            lambda: draw.decades(1e-300, 1e300),
            lambda: f"{draw.decades(1e-12, 1e12):g} {draw.among(UNITS)}",
            lambda: deepcopy(draw.among(odd)),
            lambda: nest(draw.among([3, 30, 300])),
        ]
    )()


def damage_tree(draw: Draw, tree: Any) -> Any:
    """Return nested tables with some values replaced, taken away, moved or called otherwise."""
    tree = deepcopy(tree)
    for _ in range(draw.among([1, 1, 2, 4])):
        places = [*_places(tree)]
        if not places:
            break
        owner, key = draw.among(places)
        if draw.chance(0.6):
            owner[key] = nonsense(draw)
        elif draw.chance(0.3):
            other, its = draw.among(places)
            owner[key] = deepcopy(other[its])
        elif isinstance(owner, dict) and draw.chance(0.5):
            owner[str(draw.among(TEXTS))[:80]] = owner.pop(key)
        else:
            owner.pop(key)
    return tree


def _places(owner: Any) -> Any:
    for key in list(owner) if isinstance(owner, dict) else range(len(owner)):
        yield owner, key
        if isinstance(owner[key], dict | list) and owner[key]:
            yield from _places(owner[key])


def damage_bytes(draw: Draw, content: bytes) -> bytes:
    """Return bytes with some flipped, cut out, doubled or with a token put in."""
    for _ in range(draw.among([1, 1, 2, 5, 20])):
        at, to = sorted(int(draw.between(0, len(content) + 1)) for _ in range(2))
        head, middle, tail = content[:at], content[at:to], content[to:]
        byte, token = bytes([int(draw.between(0, 256))]), draw.among(TOKENS)
        content = draw.among(
            [
                head + byte + content[at + 1 :],
                head + middle[20:] + tail,
                head + middle[:1000] + middle + tail,
                head + token.encode("utf-8", "replace") + middle + tail,
            ]
        )
    return content


# --- what is valid to begin with ------------------------------------------------------------------

PAPERS = st.presets.nakano_popov_2020()
PROGRAM = st.protocols.DriveProgram(
    velocity="1 mm/s",
    program=[
        st.protocols.Ramp("2 mm/s", "1 s"),
        st.protocols.Hold("1 s"),
        st.protocols.Harmonic("1 mm/s", "5 Hz", "10 deg"),
    ],
    across=st.protocols.Modulation("0.1 mm/s", "50 Hz"),
)
LOAD = st.protocols.LoadProgram(
    program=[st.protocols.Step("1 N", "1 s"), st.protocols.Constant()], repeat=1
)
LAWS = (
    PAPERS.friction,
    st.Coulomb(mu_0=0.2, mu_static=0.3),
    st.laws.Table(v=[0.0, "1 mm/s", "1 m/s"], mu=[0.3, 0.2, 0.1]),
    st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 300.0, 0.4),
    st.laws.Anisotropic(st.Coulomb(mu_0=0.2), ratio=1.5, angle="10 deg"),
)
SETTINGS = st.Settings(duration="50 ms", sample_rate="1 kHz")
DESCRIPTIONS = [
    st.Description(PAPERS.replace(friction=law), st.Initial(u_x="1 um"), SETTINGS) for law in LAWS
]
DESCRIPTIONS.append(DESCRIPTIONS[0]._replace(slider=PAPERS.replace(drive=PROGRAM, load=LOAD)))
STUDY = st.Study(
    base=DESCRIPTIONS[0],
    axes={
        "phi": st.Grid("1 deg", "10 deg", 3),
        "drive.velocity": st.Values(["1 mm/s", "2 mm/s"]),
        "friction.mu_0": st.Sobol(0.2, 0.3, 3, along="phi"),
    },
    measures=["regime", "peak_force"],
)


# --- the readers ----------------------------------------------------------------------------------


def description_text(draw: Draw, folder: Path) -> None:
    """A description in TOML, damaged in any way; what can be read is run."""
    described = draw.among(DESCRIPTIONS)
    if draw.chance(0.5):
        tables = damage_tree(draw, described.to_dict())
        content = _toml(tables).encode("utf-8", "replace")
    else:
        content = damage_bytes(draw, described.to_toml().encode())
    path = folder / "a.toml"
    path.write_bytes(content)
    try_description(st.Description.from_toml(path))


def description_json(draw: Draw, folder: Path) -> None:
    """A description as results have it."""
    described = draw.among(DESCRIPTIONS)
    if draw.chance(0.5):
        text = json.dumps(damage_tree(draw, described.to_dict()))
    else:
        text = damage_bytes(draw, described.to_json().encode()).decode("utf-8", "replace")
    try_description(st.Description.from_json(text))


def study_text(draw: Draw, folder: Path) -> None:
    """A study in TOML."""
    study = st.Study.from_dict(damage_tree(draw, {**STUDY.to_dict()}))
    if study.layout.runs < 100:
        study.description(tuple(size - 1 for size in study.layout.shape))


def change_values(draw: Draw, folder: Path) -> None:
    """Values that ``--set`` gives."""
    text = draw.among([str(nonsense(draw)), draw.among(TEXTS), draw.among(TOKENS)])
    described = draw.among(DESCRIPTIONS)
    st.Description.from_toml(described.to_toml(), {draw.among(PARAMETERS): option(text)})


def try_description(described: st.Description) -> None:
    """Run what could be read, for a few steps, if its code is there already."""
    law, drive = type(described.slider.law), type(described.slider.motion)
    other = described.run.multiscale or described.run.regularisation or described.slider.load
    if law is type(PAPERS.friction) and drive is st.ConstantVelocity and not other:
        from stiction.simulation import run

        coarse = described.run.model_copy(update={"sample_rate": 0.0})
        run(described._replace(run=coarse), max_steps=STEPS).data.load()


def _toml(tables: Any) -> str:
    """Return tables as TOML, as far as they can be written."""
    kept = {name: each for name, each in tables.items() if isinstance(each, dict)}
    text = toml_text(kept)
    return text.replace("None", '"None"')


class Wrong(NamedTuple):
    """What an input was that ended otherwise than it may."""

    reader: str
    number: int
    error: str
    seconds: float


def record(draw: Draw, folder: Path) -> None:
    """Arrays of a load cell."""
    count = draw.among([0, 1, 2, 3, 5, 50, 400])
    time = np.arange(count) * draw.among([1e-3, 1e-9, 1.0, 1e-300, 1e90])
    force: Any = 1.0 + 0.2 * (time * 10.0 % 1.0)
    for _ in range(draw.among([0, 1, 2, 3])):
        time, force = (
            _spoil_array(draw, each) if draw.chance(0.5) else each for each in (time, force)
        )
    more: dict[str, Any] = {
        name: nonsense(draw) if draw.chance(0.5) else draw.decades(1e-9, 1e9)
        for name in KNOWN
        if draw.chance(0.15)
    }
    if draw.chance(0.2):
        more[draw.among(["position", "slip_speed"])] = _spoil_array(draw, force)
    str(st.analyse(st.Record(time=time, force=force, **more)))


def record_file(draw: Draw, folder: Path) -> None:
    """The file of a measured record, in any format."""
    read_damaged(draw, folder, damage_bytes)


def _spoil_array(draw: Draw, values: Any) -> Any:
    """Return an array that is not what it was."""
    odd = draw.among([0.0, np.nan, np.inf, -1.0, 1e300, 1e99, 5e-324, 1.0])
    if not isinstance(values, np.ndarray):
        return nonsense(draw)
    few = np.array([draw.chance(0.1) for _ in range(values.size)], bool)
    return draw.among(
        [
            lambda: np.full(np.shape(values), odd),
            lambda: np.where(few.reshape(np.shape(values)), odd, values) if _plain(values) else odd,
            lambda: values[::-1] if np.ndim(values) else values,
            lambda: np.sort(values) if _plain(values) else values,
            lambda: np.asarray(values)[: len(values) // 2] if np.ndim(values) else values,
            lambda: np.arange(values.size).astype("datetime64[s]"),
            lambda: np.asarray(values).astype(str),
            lambda: np.asarray(values).astype(complex) if _plain(values) else values,
            lambda: np.round(values) if _plain(values) else values,
            lambda: np.asarray(values) * 1e-60 if _plain(values) else values,
            lambda: np.atleast_2d(values),
            lambda: list(values) if np.ndim(values) else values,
            lambda: nonsense(draw),
        ]
    )()


def _plain(values: Any) -> bool:
    return isinstance(values, np.ndarray) and values.dtype.kind == "f"


def result(draw: Draw, folder: Path) -> None:
    """The file of a run, damaged inside: numbers, types, attributes, names."""
    path = folder / "a.nc"
    whole = _result(folder)
    path.write_bytes(whole)
    if draw.chance(0.25):
        checksum = whole.rindex(run_file.MARK)  # of the whole file: others write none
        path.write_bytes(damage_bytes(draw, whole[: draw.among([checksum, len(whole)])]))
    else:
        with h5py.File(path, "r+") as file:
            for _ in range(draw.among([1, 1, 2, 4])):
                _spoil(draw, file)
        if draw.chance(0.8):
            reseal(path)
    run = st.load(path)
    str(run), run.data.load(), run.sticks.load()
    if draw.chance(0.5):
        str(st.analyse(run))


def reseal(path: Path) -> None:
    """Have a result's checksums fit what is in it, as who changes it on purpose would."""
    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
        samples, sticks, _ = open_tables(path)
        seal = run_file.seal_tables({"samples": samples, "sticks": sticks})
        with h5py.File(path, "r+") as file:
            file.attrs[SEAL] = seal
    run_file.sign(path)


def _result(folder: Path, kept: dict[str, bytes] = {}) -> bytes:  # noqa: B006
    if "run" not in kept:
        kept["run"] = st.run(DESCRIPTIONS[0]).save(folder / "whole.nc").read_bytes()
    return kept["run"]


def _spoil(draw: Draw, file: h5py.File) -> None:
    columns = [name for name in [*file, "sticks/stick_start"] if name in file]
    name = draw.among(columns)
    if name == "sticks" or draw.chance(0.3):
        owner = file if draw.chance(0.7) else file[name]
        its = [key for key in owner.attrs if not key.startswith(("_Net", "REF", "DIM", "CLASS"))]
        if its:
            _put(owner.attrs, draw.among(its), draw)
        return
    values = file[name][()]
    new = _spoil_array(draw, values)
    new = new if isinstance(new, np.ndarray) and new.dtype.kind in "fic" else np.array([b"text"])
    if new.shape == values.shape and new.dtype.kind == values.dtype.kind:
        file[name][...] = new
    else:
        del file[name]
        if draw.chance(0.7):
            file[name] = new


def _put(attributes: Any, key: str, draw: Draw) -> None:
    value = nonsense(draw)
    if key == "description" and draw.chance(0.7):
        value = json.dumps(damage_tree(draw, DESCRIPTIONS[0].to_dict()))
    try:
        attributes[key] = value
    except (TypeError, ValueError, OSError, OverflowError):
        if key in attributes:
            del attributes[key]


def store(draw: Draw, folder: Path) -> None:
    """A study's store, damaged inside: what its files say, and which are there."""
    import shutil

    path, whole = folder / "a.zarr", _whole_store(folder)
    shutil.rmtree(path, ignore_errors=True)
    shutil.copytree(whole, path)
    files = sorted(each for each in path.rglob("*") if each.is_file())
    for _ in range(draw.among([1, 1, 2])):
        file = draw.among(files)
        files.remove(file)  # one that is torn can be read no more
        if draw.chance(0.15):
            file.unlink()
        elif file.name == "zarr.json" and draw.chance(0.7):
            file.write_text(json.dumps(damage_tree(draw, json.loads(file.read_text()))))
        else:
            file.write_bytes(damage_bytes(draw, file.read_bytes()))
    if draw.chance(0.7):  # sealed again, as who damages it on purpose would
        with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
            seal(path)
    with suppress(st.StictionError):
        st.open_study(path)
    with suppress(st.StictionError):
        st.map(path)
    st.sweep(STUDY, path)


def _whole_store(folder: Path) -> Path:
    whole = folder / "whole.zarr"
    if not whole.exists():
        st.sweep(STUDY, whole)
    return whole


def quantity(draw: Draw, folder: Path) -> None:
    """A number with its unit."""
    text = "".join(draw.among(PARTS) for _ in range(int(draw.decades(1, 60))))
    text = draw.among(
        [f"1 {text}", text, damage_bytes(draw, b"1 kN s/m").decode("utf-8", "replace")]
    )
    st.Settings(duration=text)


def laws(draw: Draw, folder: Path) -> None:
    """Laws that ``--law`` gives."""
    inline = f"{{law = {draw.among(TEXTS)!r}, mu_0 = {draw.among(TOKENS)}}}"
    text = draw.among(
        [str(nonsense(draw)), draw.among(TOKENS), inline, f"{draw.among(TEXTS)}.toml"]
    )
    read_laws(DESCRIPTIONS[0], [text if draw.chance(0.7) else nonsense(draw)])


LINES = (
    ("stability", "{toml}", "--over", "phi", "--between", "1 deg", "5 deg"),
    ("stability", "{toml}", "--over", "k_x, k_y"),
    ("stability", "{toml}", "--set", "phi=2deg", "--set", "V=1"),
    ("map", "{store}", "--of", "peak_force", "--at", "phi=1 deg", "-o", "{out}.png"),
    ("sweep", "{toml}", "-o", "{out}.zarr", "--refine", "phi=1 deg", "--threads", "1"),
    ("export", "{nc}", "-o", "{out}.csv"),
    ("plot", "{nc}", "-o", "{out}.svg"),
    ("init", "{out}.toml"),
    ("analyse", "{nc}", "-o", "{out}"),
)


def command(draw: Draw, folder: Path) -> None:
    """A command line with an argument that is none of its own."""
    (folder / "whole.toml").write_text(DESCRIPTIONS[0].to_toml())
    (folder / "whole.nc").write_bytes(_result(folder))
    _whole_store(folder)
    files = {kind: str(folder / f"whole.{kind}") for kind in ("toml", "nc")}
    files |= {"store": str(folder / "whole.zarr"), "out": str(folder / "out")}
    line = [part.format(**files) for part in draw.among(LINES)]
    for _ in range(draw.among([1, 1, 2])):
        at = int(draw.between(1, len(line)))
        text = str(draw.among([nonsense(draw), draw.among(TOKENS), f"phi={draw.among(TEXTS)}"]))
        line[at] = text.replace("\x00", "0").replace("/", "_")  # nothing outside the folder
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()), chdir(folder):
        _call(line)
    if left := [*folder.rglob("*.part")]:
        raise ValueError(f"half a file is left behind: {left[0].name}")


def _call(line: list[str]) -> None:
    try:
        main_line(line)
    except SystemExit as end:
        if end.code not in (0, 1, 2):
            raise ValueError(f"exit status {end.code}") from end


READERS: dict[str, Callable[[Draw, Path], None]] = {
    each.__name__: each
    for each in (
        description_text, description_json, study_text, change_values,
        record, record_file, result, store, quantity, laws, command,
    )
}  # fmt: skip


def look(name: str, seed: int, number: int, folder: Path) -> Wrong | None:
    """Feed one input to a reader; return what was wrong, if anything was."""
    begun = perf_counter()
    place = sorted(READERS).index(name)
    said = ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            READERS[name](Draw(seed, number * len(READERS) + place), folder)
    except st.StictionError as error:
        said = "" if str(error).strip() else "an error without a word"
        faults = getattr(error, "faults", [])
        said = said or "".join("a fault without a path" for each in faults if not each.path)
    except Exception:
        said = traceback.format_exc()
    seconds = perf_counter() - begun
    return Wrong(name, number, said, seconds) if said or seconds > SECONDS else None


def main() -> int:
    """Feed the inputs that are asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.fuzz", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--inputs", type=int, default=1000, help="how many, of all readers")
    parser.add_argument("--reader", choices=READERS, action="append", help="only these")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="one input of each reader")
    options = parser.parse_args()
    readers = options.reader or list(READERS)
    numbers = range(options.inputs // len(readers)) if options.only is None else [options.only]
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        for name in readers:
            seen = [look(name, options.seed, number, Path(folder)) for number in numbers]
            found = [each for each in seen if each is not None]
            raised = [each for each in found if each.error]
            print(f"{name}: {len(numbers)} inputs, {len(raised)} wrong", flush=True)
            for each in found:
                last = each.error.strip().splitlines()[-1:] or ["slow"]
                print(f"  number {each.number}, {each.seconds:.1f} s: {last[0][:200]}")
                if options.only is not None:
                    print(each.error)
            wrong += raised
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
