"""Excerpt of a script: the statements that define one name."""

from __future__ import annotations

import ast
from collections.abc import Iterator


def excerpt(text: str, name: str) -> str:
    """Return the top-level statements that define a name and everything it refers to.

    The result is empty if the text does not define the name. The rest of a script, its runs and
    figures, is left out.

    >>> print(excerpt("from math import exp, pi\\ndef f(): return exp(1)\\nprint(f())", "f"))
    from math import exp, pi
    def f(): return exp(1)
    """
    try:
        statements = ast.parse(text).body
    except SyntaxError:
        return ""
    defining: dict[str, list[ast.stmt]] = {}
    for statement in statements:
        for bound in _bound(statement):
            defining.setdefault(bound, []).append(statement)
    if name not in defining:
        return ""
    wanted, names = list(defining.get("*", [])), [name]
    while names:
        for statement in defining.get(names.pop(), []):
            if statement not in wanted:
                wanted.append(statement)
                names += [node.id for node in ast.walk(statement) if isinstance(node, ast.Name)]
    lines = text.splitlines()
    return "\n".join(_lines(lines, statement) for statement in statements if statement in wanted)


def _bound(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement binds; ``*`` if it may bind or change any name."""
    match statement:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.ImportFrom(module="__future__"):
            yield "*"
        case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
            for alias in aliases:
                yield alias.asname or alias.name.split(".")[0]
        case ast.Assign(targets=targets):
            for target in targets:
                yield from (n.id for n in ast.walk(target) if isinstance(n, ast.Name))
        case ast.AnnAssign(target=ast.Name(id=name)):
            yield name


def _lines(lines: list[str], statement: ast.stmt) -> str:
    decorators = getattr(statement, "decorator_list", [])
    start = min([statement.lineno, *(each.lineno for each in decorators)])
    return "\n".join(lines[start - 1 : statement.end_lineno])
