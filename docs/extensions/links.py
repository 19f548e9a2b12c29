"""Link names in docstrings: ours to their pages, other projects' to their manuals.

The public names come from the package, those of others from ``others.toml``, so that the build
needs no network. Sphinx complains of every name that is found in neither.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from pkgutil import resolve_name
from types import ModuleType

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.roles import XRefRole

import stiction as st
from stiction.names import public_names as names_in_stub

ROOMS = (
    *("laws", "protocols", "results", "analysis", "theory", "linear_stability"),
    *("plotting", "presets", "testing"),
)
PARTS = Path(__file__).parent.parent / "reference" / "python" / "parts.md"
OTHERS = tomllib.loads((Path(__file__).parent.parent / "others.toml").read_text("utf-8"))


def public_names(module: ModuleType) -> list[str]:
    """Return what a room offers: the names in its stub, or else the functions and classes in it."""
    if Path(f"{module.__file__}i").exists():
        return sorted(names_in_stub(module.__name__))
    return sorted(
        name
        for name, each in vars(module).items()
        if not name.startswith("_")
        and callable(each)
        and getattr(each, "__module__", "").startswith(module.__name__)
    )


def room_of(name: str) -> ModuleType:
    """Return the session itself or a room; Sphinx, too, finds a room where a session has it."""
    module = getattr(st, name) if name else st
    sys.modules.setdefault(f"stiction.{name}".rstrip("."), module)
    return module


def session_names() -> list[str]:
    """Return the names of ``st``, without its rooms."""
    return [each for each in public_names(st) if not isinstance(getattr(st, each), ModuleType)]


def addresses() -> dict[str, str]:
    """Return the page of each public object, by every name under which a docstring may cite it."""
    found: dict[str, str] = {}
    pages: dict[int, str] = {}
    for room in ("", *ROOMS):  # what the session has, a room only shows again
        module, place = room_of(room), f".{room}".rstrip(".")
        for name in public_names(module) if room else session_names():
            each = getattr(module, name)
            page = pages.setdefault(id(each), f"stiction{place}.{name}")
            for cited in (name, f"{each.__module__}.{name}", f"stiction{place}.{name}"):
                found.setdefault(cited, page)
            found[f"st{place}.{name}"] = page
    for path in re.findall(r"^   (stiction\.\S+)$", PARTS.read_text("utf-8"), re.M):
        found |= {path: path, path.rpartition(".")[2]: path}
    return found


PAGES = addresses()


def page_of(name: str) -> str:
    """Return the documented name of an object or of its member; any other name as it is."""
    if name in PAGES:
        return PAGES[name]
    owner, _, member = name.rpartition(".")
    return f"{PAGES[owner]}.{member}" if owner in PAGES else name


def resolve(app, env, node: pending_xref, content: nodes.Element) -> nodes.Element | None:
    """Return the link of a Python name that Sphinx does not find where it stands."""
    if node.get("refdomain") != "py":
        return None
    target = str(node["reftarget"])
    if target in OTHERS:
        return nodes.reference("", "", content, internal=False, refuri=OTHERS[target])
    python = env.domains["py"]
    return python.resolve_xref(
        env, node["refdoc"], app.builder, "obj", page_of(target), node, content
    )


def name(role, rawtext, text, lineno, inliner, options=None, content=()):
    """Return a single-quoted name: a link where it can only be a public one, else code."""
    path = re.sub(r"^st\.", "stiction.", text)
    ours = path.startswith("stiction.") or (text in PAGES and re.search("_|[A-Z]", text))
    if not ours or (path not in PAGES and exists(path)):
        return [nodes.literal(rawtext, text)], []
    return XRefRole()("py:obj", rawtext, text, lineno, inliner, {}, content)


def exists(path: str) -> bool:
    """Return whether a dotted name leads to an object."""
    try:
        resolve_name(path)
    except (ImportError, AttributeError):
        return False
    return True


def as_rst(app, what, path, each, options, lines: list[str]) -> None:
    """Read what docstrings write for a terminal: formulas on lines of their own, and |s|."""
    out: list[str] = []
    formula = False
    for line in lines:
        deep = line.startswith("    ") and not line.lstrip().startswith(">>>")
        before = out[-2] if len(out) > 1 else ""
        if deep and out and not out[-1] and re.match(r"[^\s-]", before):
            if not before.endswith("::"):
                out += ["::", ""]
            formula = True
        formula = formula and (deep or not line)
        out.append(line if formula or "``" in line else line.replace("|", r"\|"))
    lines[:] = out


def leave_out(app, what, name, each, skip, options) -> bool | None:
    """Leave out members that are said already: fields of tuples, and old names."""
    said = (getattr(each, "__doc__", None) or "").startswith(("Deprecated", "Alias for field"))
    return True if said or name in ("model_config", "model_post_init") else None


def setup(app):
    """Register them, and remove the pages of names that are no longer public."""
    for page in PARTS.parent.glob("generated/*.rst"):
        if page.stem not in PAGES.values():
            page.unlink()
    app.add_role("name", name)
    app.connect("missing-reference", resolve)
    app.connect("autodoc-process-docstring", as_rst, priority=400)  # before napoleon
    app.connect("autodoc-skip-member", leave_out)
    return {"parallel_read_safe": True}
