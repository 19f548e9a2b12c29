"""A commented description as a starting point."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from stiction.errors import StictionError
from stiction.storage.files import whole


def init(path: str | Path = "slider.toml", *, force: bool = False) -> Path:
    """Write a commented description of the paper's apparatus to adapt; return its path.

    Parameters
    ----------
    path : str or Path, optional
        The file to write.
    force : bool, optional
        Whether to overwrite an existing file.

    Raises
    ------
    StictionError
        If the file exists, or cannot be written.
    """
    target = Path(path)
    if target.is_dir():
        raise StictionError(f"{target} is a folder; name a file in it")
    if not target.parent.is_dir():
        raise StictionError(f"{target}: no folder {target.parent}; make it first")
    if target.exists() and not force:
        raise StictionError(f"{target} is there already; choose another name, or force it")
    text = files("stiction").joinpath("template.toml").read_text(encoding="utf-8")
    with whole(target) as part:
        part.write_text(text, encoding="utf-8")
    return target
