"""The possible changes of a source file, and a random sample of them."""

from __future__ import annotations

import ast
import hashlib
import json
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.operators.operator import Operator
from cosmic_ray.plugins import get_operator

ARITHMETIC = ("Add", "Sub", "Mul", "Div")
COMPARISONS = ("Eq", "NotEq", "Lt", "LtE", "Gt", "GtE")
# what is left out of Cosmic Ray's: bits of floats, which any run refuses; types of exceptions,
# whose messages have tests of their own
NAMES = (
    *(f"ReplaceBinaryOperator_{a}_{b}" for a in ARITHMETIC for b in ARITHMETIC if a != b),
    *(f"ReplaceBinaryOperator_Pow_{b}" for b in ("Mul", "Div")),
    *(f"ReplaceComparisonOperator_{a}_{b}" for a in COMPARISONS for b in COMPARISONS if a != b),
    "ReplaceComparisonOperator_Is_IsNot",
    "ReplaceComparisonOperator_IsNot_Is",
    "ReplaceUnaryOperator_Delete_USub",
    "ReplaceUnaryOperator_Delete_Not",
    "AddNot",
    "ReplaceTrueWithFalse",
    "ReplaceFalseWithTrue",
    "ReplaceAndWithOr",
    "ReplaceOrWithAnd",
    "ReplaceBreakWithContinue",
    "ReplaceContinueWithBreak",
    "ZeroIterationForLoop",
    "NumberReplacer",
)
EXTREMES = {"min": "max", "max": "min"}


class ReplaceExtreme(Operator):
    """The lesser in place of the greater, and the reverse."""

    def mutation_positions(self, node: Any) -> Iterator[tuple[Any, Any]]:
        """Yield where a name is one of the two."""
        if node.type == "name" and node.value in EXTREMES:
            yield node.start_pos, node.end_pos

    def mutate(self, node: Any, index: int) -> Any:
        """Put the other one in its place."""
        node.value = EXTREMES[node.value]
        return node

    @classmethod
    def examples(cls) -> tuple[()]:
        """Return none: they are for Cosmic Ray's own tests."""
        return ()


@cache
def operators() -> dict[str, Operator]:
    """Return the operators by name."""
    return {name: get_operator(f"core/{name}")() for name in NAMES} | {"Extreme": ReplaceExtreme()}


class Mutant(NamedTuple):
    """A change of one place: the file and the line in it, the operator and its occurrence there.

    `before` and `after` are the changed lines; `made_from` is a digest of the file.
    """

    path: str
    line: int
    operator: str
    occurrence: int
    before: str
    after: str
    made_from: str

    @property
    def key(self) -> tuple[str, str, str]:
        """Return what stays the same wherever the line is moved in its file."""
        return self.path, self.before, self.after


def digest(text: str) -> str:
    """Return what to know a source by."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def mutate(text: str, operator: str, occurrence: int) -> str:
    """Return the changed text of a source."""
    changed: str | None = mutate_code(text, operators()[operator], occurrence)
    assert changed is not None
    return changed


def mutant(path: str, text: str, operator: str, occurrence: int) -> Mutant:
    """Return the change with the lines in which it shows."""
    old, new = text.splitlines(), mutate(text, operator, occurrence).splitlines()
    if len(old) == len(new):
        lines = [i for i, pair in enumerate(zip(old, new, strict=True)) if pair[0] != pair[1]]
        first, last = lines[0], lines[-1]
    else:  # one that joins or splits lines
        first = next(i for i, pair in enumerate(zip(old, new, strict=False)) if pair[0] != pair[1])
        last = first
    before, after = (" ".join(x.strip() for x in y[first : last + 1]) for y in (old, new))
    return Mutant(path, first + 1, operator, occurrence, before, after, digest(text))


def places(text: str) -> list[tuple[tuple[int, int], list[tuple[str, int]]]]:
    """Return each place of a source, and its possible changes: operator and occurrence."""
    found: dict[Any, list[tuple[str, int]]] = defaultdict(list)
    seen: dict[str, int] = defaultdict(int)
    for node in ast_nodes(get_ast(text)):
        for name, operator in operators().items():
            for place in operator.mutation_positions(node):
                found[place].append((name, seen[name]))
                seen[name] += 1
    return [(place[0], found[place]) for place in sorted(found)]


def lines_of_the_compiler(text: str) -> set[int]:
    """Return the lines that do nothing in plain Python: decorators, and overloads of functions."""
    found: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        for each in getattr(node, "decorator_list", ()):
            overloads = "overload" in ast.unparse(each)
            found.update(range(each.lineno, 1 + (node if overloads else each).end_lineno))
    return found


def named_places(path: Path, text: str) -> Iterator[tuple[str, Path, list[tuple[str, int]]]]:
    """Yield each place of a source under a name that edits of other lines do not change."""
    lines, seen, compiled = text.splitlines(), Counter[str](), lines_of_the_compiler(text)
    for (line, _), ways in places(text):
        if line in compiled:
            continue
        stripped = lines[line - 1].strip()
        yield f"{path.as_posix()} {stripped} {seen[stripped]}", path, ways
        seen[stripped] += 1


def files(paths: Iterable[Path]) -> list[Path]:
    """Return the sources in files and folders."""
    found = {file for path in paths for file in ([path] if path.is_file() else path.rglob("*.py"))}
    return sorted(found)


def draw_mutants(sources: Sequence[Path], count: int, seed: int, folder: Path) -> list[Mutant]:
    """Return `count` changes at places drawn evenly, none of them twice.

    A place is drawn by a digest of its name, so that an edit changes no other part of the sample.
    The sample is stored in a folder for these sources: drawing takes a while.
    """
    texts = {path: path.read_text(encoding="utf-8") for path in sources}
    origin = digest(json.dumps([seed, count, *((str(path), texts[path]) for path in sources)]))
    kept = folder / f"sample-{origin}.json"
    if kept.exists():
        return [Mutant(*row) for row in json.loads(kept.read_text())]
    every = [place for path, text in texts.items() for place in named_places(path, text)]
    chosen = []
    for name, path, ways in sorted(every, key=lambda place: digest(f"{seed} {place[0]}"))[:count]:
        operator, occurrence = ways[int(digest(f"way {seed} {name}"), 16) % len(ways)]
        chosen.append(mutant(path.as_posix(), texts[path], operator, occurrence))
    kept.write_text(json.dumps(chosen))
    return chosen
