"""Notices of the package on standard error, and faults of the command line in words."""

from __future__ import annotations

import logging
import re
from inspect import getdoc

from cyclopts import App, CycloptsError, MissingArgumentError, UnknownOptionError
from cyclopts.exceptions import UnknownCommandError, UnusedCliTokensError

from stiction.cli.options import CommandError
from stiction.cli.terminal import note
from stiction.cli.tokens import is_negative
from stiction.errors import DescriptionError, ResultError, StictionError, echo

EXAMPLE = re.compile(r"Example:\s+(.+?)\.?\s*$", re.S)  # at the end of the help of an option
BLANKS = 'put a value that holds blanks in quotation marks, as in "2 mm/s", or take it out'
SHOWN_COMMAND = re.compile(r"^ +(stiction .+)$", re.M)  # in the help of a command


def message_of(error: CycloptsError) -> str:
    """Return the message of an error; where this package has no words for it, the library's."""
    match error:
        case MissingArgumentError():
            return _missing(error)
        case UnusedCliTokensError(unused_tokens=[first, *_]):
            return f"{echo(first)} is one argument too many; {BLANKS}"
        case UnknownCommandError(unused_tokens=[first, *_], app=App() as app):
            from stiction.text.validation import unknown_name

            return unknown_name("command", first, [x for x in app if not x.startswith("-")])
        case UnknownOptionError(token=token) if is_negative(token.value or token.keyword or ""):
            return (
                f"{echo(token.value or token.keyword)} begins with a hyphen, as an option does; "
                'join a value below zero to its option: --zero="-3 mN"'
            )
    return str(error)


def subject_of(error: StictionError) -> str:
    """Return the subject of an error, for the head of its message.

    A record, a result, a study and what is written are all files.

    >>> subject_of(ResultError("a.csv: no such file")), subject_of(StictionError("give either"))
    ('file', 'stiction')
    """
    if isinstance(error, CommandError):
        return "command line"
    if isinstance(error, DescriptionError):
        return "description"
    return "file" if isinstance(error, ResultError) else "stiction"


def command_of(error: CycloptsError) -> str:
    """Return the command that was called."""
    return " ".join(["stiction", *(error.command_chain or ())])


def _missing(error: MissingArgumentError) -> str:
    """Return the missing argument, and an example."""
    assert error.argument is not None
    name = error.argument.name
    words = (word.partition("=")[0] for word in error.root_input_tokens or ())
    typed = next((word for word in words if word in error.argument.names), None)
    if typed is None:
        rule = f"{name} is missing"
    else:
        count, _ = error.argument.token_count()
        rule = f"{typed} needs {'a value' if count < 2 else f'{count} values'}"
    example = _example(error, name)
    return f"{rule}; write for example: {example}" if example else rule


def _example(error: MissingArgumentError, name: str) -> str:
    """Return the example in an option's help; for another argument, the command's example."""
    if not name.startswith("-"):
        shown = SHOWN_COMMAND.search(getdoc(error.target) or "")
        return shown[1] if shown else ""
    assert error.app is not None
    known = error.app.assemble_argument_collection(parse_docstring=True)
    words = next((x.parameter.help or "" for x in known if x.name == name), "")
    found = EXAMPLE.search(words)
    return " ".join(found[1].split()) if found else ""


class Notices(logging.Handler):
    """Print each notice on its own line, above any progress bar."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a notice."""
        note(record.getMessage())


def show_notices() -> None:
    """Show notices from now on."""
    log = logging.getLogger("stiction")
    if not any(isinstance(each, Notices) for each in log.handlers):
        log.addHandler(Notices())
    log.setLevel(logging.INFO)
