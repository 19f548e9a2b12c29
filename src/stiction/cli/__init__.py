"""The command line: each command has one file, and one line here."""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable, Sequence
from keyword import iskeyword
from typing import Any, NoReturn

import cyclopts
from rich.console import Console

import stiction
from stiction.cli.refusals import command_of, message_of, show_notices, subject_of
from stiction.cli.terminal import give_up, spell_out
from stiction.cli.tokens import join_negative_values
from stiction.errors import (
    LONGEST_MESSAGE,
    LONGEST_PATH,
    StictionError,
    in_terminal,
    visible,
    without_middle,
)
from stiction.names import entry
from stiction.text.suggestion import as_option, suggest

app = cyclopts.App(
    name="stiction",
    version=stiction.__version__,
    help=(
        "Simulate sliding systems in which the friction vector rotates (Nakano & Popov, 2020).\n\n"
        "Start with `stiction paper`, which reproduces the paper, or describe your own apparatus: "
        "write a template with `stiction init my.toml` and edit it, predict its behaviour with "
        "`stiction audit my.toml`, simulate it with `stiction run my.toml --output my.nc`, draw "
        "the result with `stiction plot my.nc --output my.png`, and analyse it with `stiction "
        "analyse my.nc`. A measured record is read by `stiction analyse data.csv`.\n\n"
        "Commands that read a description take other values: `--set phi=3deg --set V=2mm/s`. "
        "`stiction --install-completion` lets the shell complete commands and options. Each "
        "command is a function of that name in Python: `import stiction as st; st.run(...)`."
    ),
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)
# errors of writing to a standard output that is closed, full or broken
OF_OUTPUT = (errno.EPIPE, errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EBADF)
COMMANDS = (
    "paper",
    "init",
    "presets",
    "audit",
    "run",
    "explore",
    "animate",
    "listen",
    "plot",
    "analyse",
    "fit",
    "design",
    "export",
    "compare",
    "stability",
    "sweep",
    "map",
    "import",
    "check",
)
# commands in the file of another, or in a room
BESIDE = {"presets": "init", "import": "analyse"}
BESIDE |= {name: f"inference.{name}" for name in ("fit", "design")}
BESIDE |= {name: f"studies.{name}" for name in ("sweep", "map")}
BESIDE |= {name: f"live.{name}" for name in ("explore", "animate", "listen")}


def function_of(name: str) -> Callable[..., Any]:
    """Return the function of a command; one that is not there fails when it is called."""
    home, function = BESIDE.get(name, name), f"{name}_" if iskeyword(name) else name
    try:
        found: Callable[..., Any] = entry("stiction.cli.commands", home, function, "COMMANDS")
    except StictionError as error:
        reason = error

        def absent() -> NoReturn:
            """Say which line is wrong."""
            raise reason

        return absent
    return found


for _name in COMMANDS:  # light modules, which import heavy ones when called
    app.command(function_of(_name), name=_name)
app.register_install_completion_command(
    help="Let the shell (bash, zsh, fish or PowerShell) complete commands and options."
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; user errors end with one message and exit status 2."""
    spell_out()
    show_notices()
    errors = Console(stderr=True, soft_wrap=True, emoji=False)
    words = join_negative_values(sys.argv[1:] if arguments is None else arguments)
    try:
        with suggest(as_option), in_terminal():
            code = app(words, result_action="return_value", print_error=False, exit_on_error=False)
        if sys.stdout is not None:
            sys.stdout.flush()
    except cyclopts.CycloptsError as error:
        refuse(errors, "command line", f"{message_of(error)}\nsee {command_of(error)} --help")
    except StictionError as error:
        refuse(errors, subject_of(error), str(error))
    except KeyboardInterrupt:
        errors.print("interrupted; files already written are complete")
        sys.exit(130)
    except BrokenPipeError:  # the reader has closed the pipe; rich ends tables so, too
        give_up(sys.stdout)
        sys.exit(1)
    except OSError as error:
        why = error.strerror or str(error)
        if error.filename is None and error.errno not in OF_OUTPUT:
            refuse(errors, "system", f"{why}; the operating system refuses what the command needs")
        give_up(None if error.filename else sys.stdout)
        what = without_middle(str(error.filename or "standard output"), LONGEST_PATH)
        refuse(errors, "file", f"{what}: {why}; choose another, or make room")
    except RecursionError:
        refuse(errors, "command line", "an argument is nested too deeply to be read")
    except MemoryError as error:
        refuse(errors, "memory", f"there is not enough: {error}")
    except BaseException as error:
        from stiction.own_code.source import raised_in_law

        if (said := raised_in_law(error)) is None:
            raise
        refuse(errors, "friction law", said)
    sys.exit(code if isinstance(code, int) else 0)


def refuse(errors: Console, what: str, message: str) -> NoReturn:
    """Print an error in full, without a frame that would cut it, and exit with status 2."""
    try:
        errors.print(f"[red]error[/red] {what}:")
        for line in visible(message).splitlines():
            errors.print(
                f"  {without_middle(line, LONGEST_MESSAGE)}", markup=False, highlight=False
            )
    except OSError:  # nowhere to print
        give_up(sys.stderr)
    sys.exit(2)
