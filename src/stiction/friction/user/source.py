"""The text in which a user's law stands: from a text to a module, from a law to its text."""

from __future__ import annotations

import copyreg
import hashlib
import inspect
import linecache
import re
import sys
import tokenize
from collections.abc import Iterator
from importlib.abc import InspectLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, NamedTuple

from stiction.friction.user.excerpt import excerpt


class Text(NamedTuple):
    """Python text: what it is called, e.g. ``laws/mylaw.py``, and what it says."""

    name: str
    text: str


class TextLoader(InspectLoader):
    """Makes a module of a text, and keeps the text as it was when it was run."""

    def __init__(self, text: Text, path: str) -> None:
        """Take a text, and the path of its file to show in tracebacks."""
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
        return _ended(file.read())


def module_name(text: Text) -> str:
    """Return the name of a text's module: after its content, so that an edited one is new."""
    stem = re.sub(r"\W", "_", Path(text.name).stem)
    digest = hashlib.sha256(text.text.encode()).hexdigest()[:16]
    return f"stiction_law_{stem}_{digest}"


def module_of(text: Text, path: str) -> ModuleType:
    """Run a text, unless that has been done, and return its module.

    Raises
    ------
    Exception
        Whatever the text raises.
    """
    name = module_name(text)
    if name in sys.modules:
        return sys.modules[name]
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
            copyreg.pickle(kind, _reduced)  # another process does not know the module
    return module


def _reduced(law: Any) -> tuple[Any, ...]:
    kind = type(law)
    loader = vars(sys.modules[kind.__module__])["__loader__"]
    return _remade, (loader.text, loader.path, kind.__qualname__, tuple(law))


def _remade(text: Text, path: str, name: str, values: tuple[Any, ...]) -> Any:
    return member(module_of(text, path), name)._make(values)


def member(module: ModuleType, name: str) -> Any:
    """Return what a module calls by a name, or None; nothing of the module is run for it."""
    found: Any = module
    for part in name.split("."):
        found = inspect.getattr_static(found, part, None)
    return found


def text_of(kind: type) -> Text | None:
    """Return the text that defines a law; of a script or a notebook, the parts that it needs.

    None if it cannot be had, or if the file has changed since it was imported.
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
        text = _ended(inspect.getsource(module))
        return Text(Path(file).name, text) if _defines(text, kind, file) else None
    except (OSError, TypeError, SyntaxError):
        return None


def _defines(text: str, kind: type, file: str) -> bool:
    """Return whether a text has the methods of a class as they are, line for line."""
    there: set[CodeType] = set()
    codes = [compile(text, file, "exec", dont_inherit=True)]
    while codes:
        inner = [each for each in codes.pop().co_consts if isinstance(each, CodeType)]
        there.update(inner)
        codes += inner
    return all(code in there for code in _codes(kind) if code.co_filename == file)


def _codes(kind: type) -> Iterator[CodeType]:
    """Yield the code of a class's methods."""
    for value in vars(kind).values():
        code = getattr(getattr(value, "__func__", value), "__code__", None)
        if code is not None:
            yield code


def _from_script(kind: type) -> Text | None:
    """Return what a law in a script, a notebook or a prompt is made of, if that can be had."""
    for file in (code.co_filename for code in _codes(kind)):
        found = excerpt("".join(linecache.getlines(file)), kind.__qualname__.split(".")[0])
        if found:
            name = Path(file).name if Path(file).is_file() else "notebook.py"
            return Text(name, _ended(found))
    return None


def _ended(text: str) -> str:
    """Return a text with a line's end at its end, as `inspect` gives it."""
    return text if text.endswith("\n") else f"{text}\n"
