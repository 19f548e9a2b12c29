"""Laws with state and the smoothed law, beside what their users would take, at equal accuracy."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack

from rich.progress import Progress

from benchmarks.harness.contest import contest
from benchmarks.harness.library import Library
from benchmarks.harness.row import Row, failures, matches
from benchmarks.section import Cell, Section, Table
from benchmarks.state_laws.cases import CASES, Case
from benchmarks.state_laws.peers import MARK, PEERS
from benchmarks.state_laws.peers.ours import solve
from benchmarks.state_laws.reference import Reference, largest, reference

GOAL = 10.0  # times as fast as every peer
LIMIT = 3.0  # s; for one run
BRIEF = 1e-6  # of the duration
CLOSEST = (
    "case",
    "peer",
    "settings",
    "(ms)",
    "force (N)",
    "state",
    "stiction",
    "(ms)",
    "force (N)",
    "state",
    "times as long as stiction",
)
ALL = ("case", "solver", "settings", "(ms)", "force (N)", "state", "times as long", "with")
TERMS = (
    "Errors: largest over the run, of the spring force and of the state: ln(V* theta/D_c), or N of"
    " the bristles; in Fig. 3 of the forces along x and y. Times: shortest, of whole calls without"
    " samples, compiled before, in rounds.",
    "Times as long as stiction: beside our fastest row that is at least as accurate in both; of"
    " each peer the row is listed where this is least.",
)


def run(progress: Progress, quick: bool) -> Section:
    """Compare all in each case; the quick version only in every third."""
    found: list[tuple[Case, Reference, list[Row]]] = []
    with ExitStack() as stack:
        libraries = [Library(f"{__package__}.peers.{module}", name) for module, name in PEERS]
        for library in libraries:
            stack.callback(library.end)
        cases = CASES[::3] if quick else CASES
        task = progress.add_task("compilation", total=len(cases))
        for case in cases:  # what one process compiles is on disk for all
            solve(case, BRIEF * case.times[[0, -1]], rtol=1e-3)
            progress.advance(task)
        for case in cases:
            known = reference(case)
            found.append((case, known, compare(libraries, case, known, progress)))
    closest = [line for case, _, rows in found for line in closest_rows(case, rows)]
    every = [line for case, _, rows in found for line in all_rows(case, rows)]
    return Section(
        "Laws with state, and the smoothed law",
        [Table("The closest row of each peer", CLOSEST, closest), Table("All rows", ALL, every)],
        [*verdict(closest), *TERMS, *(standing(case, known) for case, known, _ in found),
         *(f"{case.name}: {each}" for case, _, rows in found for each in failures(rows))],
    )  # fmt: skip


def compare(
    libraries: Sequence[Library], case: Case, known: Reference, progress: Progress
) -> list[Row]:
    """Return the rows of a case, with times and errors."""
    begins = case.name + MARK
    for library in libraries:
        library.limit = LIMIT  # a contest may have lowered it
    rows = contest(
        libraries,
        lambda found: largest(found, known.found),
        progress,
        times=case.times,
        repeats=3,
        budget=0.5,
        seconds=8.0,
        chosen=lambda settings: settings.startswith(begins),
    )
    return [row._replace(settings=row.settings.removeprefix(begins)) for row in rows]


def closest_rows(case: Case, rows: Sequence[Row]) -> list[tuple[Cell, ...]]:
    """Return a line for each peer: the row where we are least ahead, or furthest behind."""
    lines: list[tuple[Cell, ...]] = []
    found = matches(rows)
    for solver in dict.fromkeys(match.peer.solver for match in found):
        own = [match for match in found if match.peer.solver == solver and match.ours is not None]
        if not own:
            continue
        peer, ours, ratio = min(own, key=lambda match: match.ratio or 0.0)
        assert peer.errors is not None
        assert ours is not None
        assert ours.errors is not None
        left = (case.name, solver, peer.settings, 1e3 * peer.seconds, *peer.errors)
        lines.append((*left, ours.settings, 1e3 * ours.seconds, *ours.errors, ratio))
    return lines


def all_rows(case: Case, rows: Sequence[Row]) -> list[tuple[Cell, ...]]:
    """Return a line for each row that came to an end."""
    beside = {id(match.peer): match for match in matches(rows)}
    lines: list[tuple[Cell, ...]] = []
    for row in rows:
        if row.errors is not None:
            match = beside.get(id(row))
            ours = (
                (match.ratio, match.ours.settings if match.ours else "none") if match else ("", "")
            )
            numbers = (1e3 * row.seconds, *row.errors)
            lines.append((case.name, row.solver, row.settings, *numbers, *ours))
    return lines


def verdict(closest: Sequence[tuple[Cell, ...]]) -> list[str]:
    """Say of each peer over which range of ratios we are ahead or behind."""
    said = []
    for solver in dict.fromkeys(str(line[1]) for line in closest):
        ratios = [float(line[-1]) for line in closest if line[1] == solver]
        reached = sum(ratio >= GOAL for ratio in ratios)
        said.append(
            f"{solver} takes {min(ratios):.3g} to {max(ratios):.3g} times as long as stiction where"
            f" it comes closest, {GOAL:g} times or more in {reached} of {len(ratios)} cases."
        )
    return said


def standing(case: Case, known: Reference) -> str:
    """Say how far the reference can be trusted."""
    force, state = known.looser
    how = f"differs by {force:.1e} and {state:.1e}"
    return f"{case.name}: LSODA at ten times the reference's tolerance {how}."
