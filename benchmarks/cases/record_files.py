"""Files of measured records, valid and damaged, for the fuzzing of their readers."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from scipy import io

import stiction as st
from benchmarks.explore.draw import Draw

TIME = 0.01 * np.arange(40)
FORCE = 1.0 + 0.1 * (TIME * 10.0 % 1.0)
SAID = ("ms", "force=mN", "2", "1=s", "=", "g", "3", "x", "-1 N", "2.5 N/V", "\x1b[2J", "")
LVM = (
    "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tOne\n"
    "***End_of_Header***\t\n\nChannels\t1\nSamples\t40\nY_Unit_Label\tN\nX0\t0,0\nDelta_X\t0,01\n"
    "***End_of_Header***\t\nX_Value\tKraft\tComment\n"
)


@cache
def valid_files() -> tuple[tuple[str, bytes], ...]:
    """Return a small valid file of each format, by name."""
    rows = [(f"{t:.3f}", f"{f:.3f}") for t, f in zip(TIME, FORCE, strict=True)]
    plain = "Recipe: 5 N, 3\nSamples: 40\n" + "\n".join(map(",".join, [("t [s]", "F [N]"), *rows]))
    comma = "\r\n".join(
        ";".join(x).replace(".", ",") for x in [("Zeit", "Kraft"), ("s", "g"), *rows]
    )
    blocks = "\n\n".join([f"# 12:03:0{k}\n{plain}" for k in range(3)])
    labview = LVM + "\n".join("\t".join(x).replace(".", ",") for x in rows)
    npz, mat = BytesIO(), BytesIO()
    np.savez(npz, time_s=TIME, force_N=FORCE)
    io.savemat(mat, {"run": {"time": TIME, "force": FORCE, "units": {"time": "s", "force": "N"}}})
    hdf = BytesIO()
    with h5py.File(hdf, "w") as file:
        for name, values, unit in (("time", TIME, "s"), ("force", FORCE, "N")):
            file[name] = values
            file[name].attrs["units"] = unit
    texts = {"a.csv": plain, "b.csv": comma, "c.txt": blocks, "d.lvm": labview}
    binary = {"e.npz": npz, "f.mat": mat, "g.h5": hdf}
    return (
        *((name, text.encode()) for name, text in texts.items()),
        *((name, buffer.getvalue()) for name, buffer in binary.items()),
    )


def read_damaged(draw: Draw, folder: Path, damage: Callable[[Draw, bytes], bytes]) -> None:
    """Read a damaged file with something said about it, perhaps with a TOML file beside it."""
    files = valid_files()
    # a damaged HDF5 file is read in a process of its own, which takes long
    name, content = draw.among([x for x in files if x[0] != "g.h5" or draw.chance(0.1)])
    path = folder / name
    path.write_bytes(damage(draw, content))
    said: dict[str, Any] = {
        name: draw.among(SAID) for name in ("time", "force", "load", "wrap") if draw.chance(0.2)
    }
    beside = path.with_suffix(".toml")
    beside.unlink(missing_ok=True)
    if draw.chance(0.2):
        beside.write_bytes(damage(draw, b'[columns]\nforce = "2=mN"\n[sensors.force]\ngain = 2\n'))
    try:
        for each in st.read_records(path, **said):
            str(each.origin)
    finally:
        beside.unlink(missing_ok=True)
