"""The paper, end to end: simulate, draw, and compare every number with the stated one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal, NamedTuple

from matplotlib.figure import Figure

from stiction import presets
from stiction.errors import StictionError, echo
from stiction.friction.laws import Coulomb
from stiction.plotting.page.save import save
from stiction.progress.audience import with_progress
from stiction.reproduction.creep import creep, zero_slip
from stiction.reproduction.figures import figure3, figure4, figure5, schematic
from stiction.reproduction.first_look import first_look
from stiction.reproduction.numbers import NumberTable, numbers
from stiction.simulation import simulate
from stiction.storage.files import make_folder, usable_folder
from stiction.text.sections import Section, as_text
from stiction.trajectory import Trajectory

DURATION, RATE = 5.0, 10e3  # Fig. 3's time axis; Fig. 4 needs some samples a transverse period
RTOL = 1e-11  # every digit of the reference values
STEPS = False  # for `multiscale`: a map saves nothing at this tolerance, and takes time to compile
WINDOW = (0.500, 0.504)  # four transverse periods in the middle of the first stick phase
FINE_RATE = 1e6


class Reproduction(NamedTuple):
    """The paper, computed again.

    Parameters
    ----------
    files : list of Path
        The files written: figures and tables.
    table : NumberTable or None
        Every number beside the stated one; None if only one figure was requested.
    """

    files: list[Path]
    table: NumberTable | None

    @property
    def agrees(self) -> bool:
        """Whether no number is wrong."""
        return self.table is None or self.table.agrees

    def __str__(self) -> str:
        """Return the numbers as text."""
        return as_text(self.tables())

    def tables(self) -> list[Section]:
        """Return the numbers as a table, with a sentence that counts the verdicts."""
        return [] if self.table is None else [self.table.section]


@with_progress("simulating and drawing")
def paper(
    output: str | Path = "paper-output",
    figure: Literal[3, 4, 5] | None = None,
    *,
    progress: Callable[[float], None] | None = None,
) -> Reproduction:
    """Reproduce Nakano & Popov (2020): its figures, and its numbers beside the computed ones.

    Parameters
    ----------
    output : str or Path, optional
        The folder to write to, made if it does not exist.
    figure : {3, 4, 5}, optional
        Only this figure; by default all of them, and the table.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Reproduction
        The written files, and the table.

    Raises
    ------
    StictionError
        If the folder cannot be made.

    Examples
    --------
    >>> import stiction as st
    >>> [path.name for path in st.paper("figures", figure=5).files]
    ['figure-5.png', 'figure-5.pdf']
    """
    written, table = reproduce(Path(output), figure, progress or (lambda fraction: None))
    return Reproduction(written, table)


def reproduce(
    folder: Path, figure: int | None, report: Callable[[float], None]
) -> tuple[list[Path], NumberTable | None]:
    """Write the paper's figures and numbers to `folder`; see `paper`."""
    usable_folder(folder)
    make_folder(folder)
    if figure not in (None, 3, 4, 5):
        raise StictionError(f"figure must be 3, 4 or 5, is {echo(figure)}")
    slider = presets.nakano_popov_2020()
    if figure == 5:
        return save(figure5(slider), folder / "figure-5"), None
    run = simulate(
        slider,
        DURATION,
        sample_rate=RATE,
        rtol=RTOL,
        multiscale=STEPS,
        progress=lambda fraction: report(0.3 * fraction),
    )
    drawings: dict[str, Callable[[], Figure]] = {
        "first-look": lambda: first_look(run),
        "figure-1-and-2": lambda: schematic(slider),
        "figure-3": lambda: figure3(run),
        "figure-4": lambda: figure4(run),
        "figure-5": lambda: figure5(slider),
        "beyond-zero-slip": lambda: zero_slip(finely(run), WINDOW),
        "beyond-creep": lambda: creep(run),
    }
    if figure is not None:
        drawings = {f"figure-{figure}": drawings[f"figure-{figure}"]}
    written: list[Path] = []
    for done, (name, draw) in enumerate(drawings.items(), start=1):
        written += save(draw(), folder / name)
        report(0.3 + 0.6 * done / len(drawings))
    if figure is not None:
        return written, None
    constant = slider.replace(friction=Coulomb(mu_0=slider.law.coefficient(0.0)))
    steady = simulate(constant, 2 * DURATION, sample_rate=RATE, rtol=RTOL, multiscale=STEPS)
    table = NumberTable(numbers(run, steady))
    report(1.0)
    return [*written, *table.save(folder)], table


def finely(run: Trajectory) -> Trajectory:
    """Repeat the window of zero slip from a sample of `run`, finely sampled."""
    start, end = WINDOW
    return simulate(
        run.slider,
        end - start,
        sample_rate=FINE_RATE,
        rtol=RTOL,
        multiscale=STEPS,
        initial=run.state(start),
    )
