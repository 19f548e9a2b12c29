"""From a user's text to a module, and from a law or function to the statements that define it."""

from __future__ import annotations

import ast
import builtins
import copyreg
import hashlib
import inspect
import linecache
import re
import sys
import threading
import tokenize
from collections.abc import Iterator
from functools import lru_cache
from importlib.abc import InspectLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from traceback import extract_tb
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple

from stiction.errors import one_line

_running = threading.RLock()  # a text may read a description whose law is a text


class Text(NamedTuple):
    """Python text: its name, e.g. ``laws/mylaw.py``, and its content."""

    name: str
    text: str


class TextLoader(InspectLoader):
    """Loader of a module from a text, which it stores as it was when run."""

    def __init__(self, text: Text, path: str) -> None:
        """Store a text, and the path that tracebacks show."""
        self.text, self.path = text, path

    def get_source(self, fullname: str) -> str:
        """Return the text."""
        return self.text.text

    def get_code(self, fullname: str) -> CodeType:
        """Return the compiled text."""
        return self.source_to_code(self.text.text, self.path)


def read(path: Path) -> str:
    """Return the text of a Python file, in the encoding that it declares.

    Raises
    ------
    OSError, SyntaxError, UnicodeDecodeError
        If it cannot be read.
    """
    with tokenize.open(path) as file:
        return _end_last_line(file.read())


def module_name(text: Text) -> str:
    """Return a module name that contains a hash of the text: an edited text gets a new one."""
    stem = re.sub(r"\W", "_", Path(text.name).stem)
    digest = hashlib.sha256(text.text.encode()).hexdigest()[:16]
    return f"stiction_law_{stem}_{digest}"


def module_of(text: Text, path: str) -> ModuleType:
    """Run a text once, and return its module.

    Raises
    ------
    Exception
        Whatever the text raises.
    """
    with _running:  # otherwise another thread would get a module that has not all its names yet
        name = module_name(text)
        return sys.modules.get(name) or _run(text, path, name)


def _run(text: Text, path: str, name: str) -> ModuleType:
    """Run a text as a module of this name."""
    spec = spec_from_loader(name, TextLoader(text, path), origin=path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    module.__file__ = path
    sys.modules[name] = module  # before it runs, as an import would
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    for kind in vars(module).values():
        if inspect.isclass(kind) and kind.__module__ == name and issubclass(kind, tuple):
            copyreg.pickle(kind, _reduce)  # another process does not have the module
    return module


def _reduce(law: Any) -> tuple[Any, ...]:
    kind = type(law)
    loader = vars(sys.modules[kind.__module__])["__loader__"]
    return _remake, (loader.text, loader.path, kind.__qualname__, tuple(law))


def _remake(text: Text, path: str, name: str, values: tuple[Any, ...]) -> Any:
    return member(module_of(text, path), name)._make(values)


def raised_in_law(error: BaseException) -> str | None:
    """Return the error in a user's law and its place; None if it came from elsewhere.

    Machine code names the file that it was compiled from, which another folder may have had.
    """
    modules = [vars(each) for each in list(sys.modules.values()) if isinstance(each, ModuleType)]
    laws = {_base(m["__file__"]): m["__file__"] for m in modules if _is_of_text(m)}
    others = {m.get("__file__") for m in modules if not _is_of_text(m)}
    frames = [each for each in extract_tb(error.__traceback__) if each.filename not in others]
    inside = [each for each in frames if _base(each.filename) in laws]
    if not inside:
        return None
    place = f"{laws[_base(inside[-1].filename)]}, line {inside[-1].lineno}"
    return f"{place}: {one_line(error)}; correct it there"


def _is_of_text(module: dict[str, Any]) -> bool:
    return isinstance(module.get("__loader__"), TextLoader)


def _base(file: str) -> str:
    """Return the name of a file without its folder, or the marks of a stored text."""
    return Path(file.strip("<>")).name


def member(module: ModuleType, name: str) -> Any:
    """Return an object of a module by name, or None; runs no code of the module."""
    found: Any = module
    for part in name.split("."):
        found = inspect.getattr_static(found, part, None)
    return found


def text_of(kind: type | FunctionType) -> Text | None:
    """Return the text that defines it; from a script or notebook, only the parts it needs.

    None if the text is unavailable, or the file has changed since it was imported.
    """
    module = sys.modules.get(kind.__module__)
    if module is None or "<locals>" in kind.__qualname__:
        return None
    loader = vars(module).get("__loader__")
    if isinstance(loader, TextLoader):
        return loader.text
    if kind.__module__ == "__main__":
        return _from_script(kind)
    try:
        file = inspect.getsourcefile(module) or ""
        text = _end_last_line(inspect.getsource(module))
        return Text(Path(file).name, text) if _defines(text, kind, file) else None
    except (OSError, TypeError, SyntaxError):
        return None


def _defines(text: str, kind: type | FunctionType, file: str) -> bool:
    """Return whether a text contains a function, or the methods of a class, line for line."""
    there: set[CodeType] = set()
    codes = [compile(text, file, "exec", dont_inherit=True)]
    while codes:
        inner = [each for each in codes.pop().co_consts if isinstance(each, CodeType)]
        there.update(inner)
        codes += inner
    return all(code in there for code in _codes(kind) if code.co_filename == file)


def _codes(kind: type | FunctionType) -> Iterator[CodeType]:
    """Yield the code of a function, or of a class's methods."""
    for value in [kind] if isinstance(kind, FunctionType) else vars(kind).values():
        code = getattr(getattr(value, "__func__", value), "__code__", None)
        if code is not None:
            yield code


def _from_script(kind: type | FunctionType) -> Text | None:
    """Return the text of it in a script, a notebook or a prompt, if available."""
    for file in (code.co_filename for code in _codes(kind)):
        found = excerpt("".join(linecache.getlines(file)), kind.__qualname__.split(".")[0])
        if found:
            name = Path(file).name if Path(file).is_file() else "notebook.py"
            return Text(name, _end_last_line(found))
    return None


def _end_last_line(text: str) -> str:
    """Return a text with a final newline, as `inspect` does."""
    return text if text.endswith("\n") else f"{text}\n"


def excerpt(text: str, name: str) -> str:
    """Return the top-level statements that define a name and everything it refers to.

    The result is empty if the text does not define the name. The rest of a script, its runs and
    figures, is left out.

    >>> print(excerpt("from math import exp, pi\\ndef f(): return exp(1)\\nprint(f())", "f"))
    from math import exp, pi
    def f(): return exp(1)
    """
    defining = bindings(text)
    if name not in defining:
        return ""
    wanted, names = list(defining.get("*", [])), [name]
    while names:
        for statement in defining.get(names.pop(), []):
            if statement not in wanted:
                wanted.append(statement)
                names += [node.id for node in ast.walk(statement) if isinstance(node, ast.Name)]
    lines, wanted = text.splitlines(), sorted(wanted, key=lambda each: each.lineno)
    return "\n".join(_lines(lines, statement) for statement in wanted)


@lru_cache(maxsize=64)
def bindings(text: str) -> dict[str, list[ast.stmt]]:
    """Return the top-level statements that bind each name of a text; none of a faulty text."""
    try:
        statements = ast.parse(text).body
    except SyntaxError:
        return {}
    found: dict[str, list[ast.stmt]] = {}
    for statement in statements:
        for bound in _bound(statement):
            found.setdefault(bound, []).append(statement)
    return found


def definition(text: str, name: str) -> str | None:
    """Return the lines of the last statement that binds a name; None if the text does not."""
    statements = bindings(text).get(name)
    return _lines(text.splitlines(), statements[-1]) if statements else None


def missing_names(text: str) -> list[str]:
    """Return the names that a text uses and does not define: it was cut out of a larger one.

    >>> missing_names("import math\\ndef f(x): return math.exp(x) + offset + len(str(x))")
    ['offset']
    """
    nodes = [*ast.walk(ast.parse(text))]
    names = [node for node in nodes if isinstance(node, ast.Name)]
    known = {node.id for node in names if isinstance(node.ctx, ast.Store)}
    known.update(dir(builtins), ("__file__",))
    for node in nodes:
        match node:
            case (
                ast.arg(arg=name)
                | ast.ExceptHandler(name=str(name))
                | ast.MatchAs(name=str(name))
                | ast.MatchStar(name=str(name))
                | ast.MatchMapping(rest=str(name))
            ):
                known.add(name)
            case ast.ImportFrom(names=[ast.alias(name="*")]):
                return []  # whatever it lacks may come from there
            case ast.FunctionDef() | ast.ClassDef() | ast.Import() | ast.ImportFrom():
                known.update(_bound(node))
    return sorted({node.id for node in names} - known)


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
