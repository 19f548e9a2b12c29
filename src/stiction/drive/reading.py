"""Reading of a program's pieces, tables or objects, into objects in SI, with all faults."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from stiction.arguments import is_list
from stiction.drive.pieces import LEVELS, Modulation
from stiction.errors import DescriptionError, Fault, echo
from stiction.text.toml import choose
from stiction.text.units import Kind, fault, to_si
from stiction.text.validation import faulty


def as_pieces(known: Mapping[str, type[Any]], kind: Kind) -> BeforeValidator:
    """Return the validator that reads a program of known pieces, with levels of one quantity."""

    def read(value: Any) -> tuple[Any, ...]:
        if not is_list(value):
            raise fault(f"{echo(value)} is not a list of pieces")
        made, found = [], []
        for i, each in enumerate(value):
            try:
                piece = _in_si(_piece(each, known), kind)
                if piece.duration is None and i < len(value) - 1:
                    message = "missing; only the last piece may have no end"
                    raise DescriptionError.of("piece.duration", message)
                made.append(piece)
            except DescriptionError as error:
                found += [*error.at(str(i + 1)).faults]
        if found:
            raise faulty(found)
        return tuple(made)

    return BeforeValidator(read)


def as_modulation(kind: Kind) -> BeforeValidator:
    """Return the validator that reads a modulation."""

    def read(value: Any) -> Modulation | None:
        if value is None:
            return None
        try:
            made = Modulation(**value) if isinstance(value, Mapping) else value
            if not isinstance(made, Modulation):
                raise fault(
                    f"{echo(value)} is not a modulation; it has an amplitude and a frequency"
                )
            done: Modulation = _in_si(made, kind)
        except DescriptionError as error:
            raise faulty(error.at().faults) from None
        return done

    return BeforeValidator(read)


def _piece(value: Any, known: Mapping[str, type[Any]]) -> Any:
    if isinstance(value, Mapping):
        return choose(dict(value), "piece", known)
    if type(value) not in known.values():
        raise DescriptionError.of("piece", f"{echo(value)} is none of {', '.join(known)}")
    return value


def _in_si(piece: Any, kind: Kind) -> Any:
    """Return a piece with its levels, all of one quantity, in SI."""
    levels, found = {}, []
    for name in LEVELS:
        value = getattr(piece, name, None)
        if value is not None:
            try:
                levels[name] = to_si(value, kind)
            except PydanticCustomError as error:
                found.append(Fault(f"piece.{name}", error.message()))
    if found:
        raise DescriptionError(found)
    return piece._replace(**levels)
