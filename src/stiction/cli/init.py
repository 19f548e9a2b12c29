"""``stiction init``: a commented description to start from."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from stiction.errors import StictionError


def init(path: Path = Path("slider.toml"), /, *, force: bool = False) -> None:
    """Write a commented description of the paper's apparatus, to be made yours.

    Parameters
    ----------
    path
        The file to write.
    force
        Write over a file that is there.
    """
    if path.is_dir():
        raise StictionError(f"{path} is a folder; name a file in it")
    if not path.parent.is_dir():
        raise StictionError(f"{path}: no folder {path.parent}; make it first")
    if path.exists() and not force:
        raise StictionError(f"{path} is there already; choose another name, or add --force")
    text = files("stiction.cli").joinpath("template.toml").read_text(encoding="utf-8")
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise StictionError(f"{path}: cannot be written: {error.strerror}") from None
    print(f"wrote {path}; edit it, then: stiction run {path} --output {path.with_suffix('.nc')}")
