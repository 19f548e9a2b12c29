"""Sections of sentences and tables, the parts of reports on a page or terminal."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple

from stiction.names import draw, own_picture

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


class Table(NamedTuple):
    """Headings and rows of text."""

    headings: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    def sides(self) -> list[Literal["left", "right"]]:
        """Return the side at which each column is aligned: bare numbers at the right."""
        columns = list(zip(*self.rows, strict=True)) or [()] * len(self.headings)
        return ["right" if all(map(_is_number, cells)) else "left" for cells in columns]

    def to_dataframe(self) -> pd.DataFrame:
        """Return the table as a pandas data frame, its cells as text."""
        import pandas as pd

        return pd.DataFrame(list(self.rows), columns=list(self.headings))


def _is_number(text: str) -> bool:
    """Return whether a cell is a bare number, or a placeholder for one."""
    try:
        float(text)
    except ValueError:
        return text == "none"
    return True


class Section(NamedTuple):
    """A part of a report: title, sentences, and perhaps a table."""

    title: str
    sentences: list[str]
    table: Table | None = None

    def __str__(self) -> str:
        """Return the section as plain text."""
        lines = [self.title, *(f"  {sentence}" for sentence in self.sentences)]
        return "\n".join([*lines, *(table_lines(self.table) if self.table else ())])


class Report:
    """A report of sections, which text and notebooks show."""

    def tables(self) -> list[Section]:
        """Return the sections of sentences and tables."""
        raise NotImplementedError

    def __str__(self) -> str:
        """Return the report as text."""
        return as_text(self.tables())

    def _repr_html_(self) -> str:
        figure = own_picture(self) if hasattr(self, "plot") else ""
        return as_html(self.tables()) + figure


class SectionReport(Report):
    """A report of one section, with a figure."""

    _figure: ClassVar[str]  # its name in `stiction.plotting`

    @property
    def figure(self) -> str:
        """Name of its figure in `stiction.plotting`."""
        return self._figure

    @property
    def section(self) -> Section:
        """The report in words and as a table."""
        raise NotImplementedError

    @property
    def answer(self) -> str:
        """Its result in a sentence."""
        return self.section.sentences[0]

    def tables(self) -> list[Section]:
        """Return the section, as reports of several do."""
        return [self.section]

    def plot(self, ax: Any = None) -> Axes:
        """Draw the figure that `stiction.plotting` has for it."""
        drawn: Axes = draw(self._figure, self, ax)
        return drawn


def table_lines(table: Table) -> list[str]:
    """Return a table as lines of text with aligned columns."""
    rows = [table.headings, *table.rows]
    widths = [max(len(row[at]) for row in rows) for at in range(len(table.headings))]
    lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    return [f"  {line}".rstrip() for line in lines]


def as_text(parts: Iterable[Section]) -> str:
    """Return a report as plain text."""
    return "\n\n".join(map(str, parts))


def join_units(text: str) -> str:
    """Return a text whose numbers keep their unit, and a "~" or ">" before them, on the same line.

    So does a product of symbols with subscripts.

    >>> join_units("about ~ 2 N for k_x u_x")
    'about ~\xa02\xa0N for k_x\xa0u_x'
    """
    together = r"(?<=\d) (?=\S)| (?=s/m\b)|(?<=[~>]) (?=\d)|(?<=\b\w_\w) (?=\w_\w\b)"
    return re.sub(together, "\N{NO-BREAK SPACE}", text)


# a letter with a subscript, which is not a part of a name: friction.D_c, k_x=2, 'a_1', a_1.nc
SYMBOL = re.compile(
    r"(?<![\w.;=\\-])([A-Za-z\u0370-\u03ff])_([A-Za-z0-9]{1,2}|star|inf|static)"
    r"(?![\w=(\[&]|[.-]\w)"
)


def html(text: str) -> str:
    """Return a text as HTML: commands in grave accents as code, symbols, numbers with their units.

    >>> html("See `stiction audit` & co. of 2 N, and k_y.")
    'See <code>stiction audit</code> &amp; co. of 2\xa0N, and k<sub>y</sub>.'
    """
    told = re.split("`([^`]+)`", escape(join_units(text)))
    told[::2] = [SYMBOL.sub(r"\1<sub>\2</sub>", each) for each in told[::2]]
    told[1::2] = [f"<code>{each}</code>" for each in told[1::2]]
    return "".join(told)


def cell_html(text: str) -> str:
    """Return a table's cell as HTML; a symbol at its beginning is a name, and stays as typed.

    >>> cell_html("k_y"), cell_html("stiffness k_y")
    ('k_y', 'stiffness k<sub>y</sub>')
    """
    return escape(join_units(text)) if SYMBOL.match(text) else html(text)


def as_html(parts: Iterable[Section]) -> str:
    """Return a report as HTML, for a notebook."""
    lines = []
    for part in parts:
        lines.append(f"<h4>{html(part.title)}</h4>")
        lines += [f"<p>{html(sentence)}</p>" for sentence in part.sentences]
        if part.table is not None:
            lines.append(table_html(part.table))
    return "\n".join(lines)


def table_html(table: Table) -> str:
    """Return a table as HTML, each cell with its side: a notebook puts all of them at the right.

    >>> table_html(Table(("sticks",), [("12",)])).split("<td ")[1]
    'style="text-align: right">12</td></tr></tbody></table>'
    """
    sides = table.sides()

    def line(tag: str, cells: Sequence[str]) -> str:
        inside = zip(cells, sides, strict=True)
        made = (
            f'<{tag} style="text-align: {side}">{cell_html(cell)}</{tag}>' for cell, side in inside
        )
        return f"<tr>{''.join(made)}</tr>"

    body = "".join(line("td", row) for row in table.rows)
    return f"<table><thead>{line('th', table.headings)}</thead><tbody>{body}</tbody></table>"


def first_sentence(text: str) -> str:
    """Return the first sentence of a text.

    >>> first_sentence("The force falls by 1.5 N. Analyse each part.")
    'The force falls by 1.5 N.'
    """
    return re.split(r"(?<=\.) ", text, maxsplit=1)[0]


def first_clause(text: str) -> str:
    """Return the first clause of a sentence, without its remedy or reason.

    >>> first_clause("The force drifts by 1.5 N/s: analyse its parts.")
    'The force drifts by 1.5 N/s'
    """
    return re.split(r"[.:;](?: |$)", text, maxsplit=1)[0]
