"""Which keys of a JSON object a message has fields for, and which it has not."""

from __future__ import annotations

import dataclasses
import functools
import types
import typing
from collections.abc import Iterator
from typing import Any

from .checks import MessageError

_SHOWN = 40
"""characters of a key that is refused."""


def known_fields(kind: type, values: dict[str, Any]) -> dict[str, Any]:
    """Return those of ``values`` that ``kind`` has fields for: a newer gateway may tell more."""
    names = _names(kind)
    return {name: value for name, value in values.items() if name in names}


def unknown_keys(kind: type, values: dict[str, Any]) -> Iterator[str]:
    """Yield what the dataclass ``kind``, and those that it holds, have no fields for, as ``tasks[2].colour``.

    Values of a wrong type are passed over.
    """
    for path, _holder in _unknown(kind, values, ""):
        yield path


def refuse_unknown_keys(kind: type, values: dict[str, Any]) -> None:
    """Raise MessageError for the first key in ``values`` that ``kind`` has no field for.

    What is passed over may have been what mattered most, such as the CRS of a place.
    """
    for path, holder in _unknown(kind, values, ""):
        names = ", ".join(field.name for field in dataclasses.fields(holder)) or "none"
        raise MessageError(
            f"{path} is no parameter here; known are: {names}. Leave it out or correct its name"
        )


def _unknown(kind: type, values: Any, path: str) -> Iterator[tuple[str, type]]:
    if not isinstance(values, dict):
        return
    if not values.keys() <= _names(kind):
        for name in values.keys() - _names(kind):
            yield f"{path}{_shown(name)}", kind
    for name, (inner, many) in _inner(kind).items():
        value = values.get(name)
        if many and isinstance(value, (list, tuple)):
            for number, one in enumerate(value):
                yield from _unknown(inner, one, f"{path}{name}[{number}].")
        elif not many:
            yield from _unknown(inner, value, f"{path}{name}.")


def _shown(name: object) -> str:
    text = str(name)
    text = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
    return text if text.isidentifier() else repr(text)


@functools.cache
def _names(kind: type) -> frozenset[str]:
    return frozenset(field.name for field in dataclasses.fields(kind))


@functools.cache
def _inner(kind: type) -> dict[str, tuple[type, bool]]:
    """Return the fields of ``kind`` that hold a dataclass, or (``True``) a list of them."""
    hints = typing.get_type_hints(kind)
    found = {}
    for field in dataclasses.fields(kind):
        hint = hints[field.name]
        for one in typing.get_args(hint) if isinstance(hint, types.UnionType) else (hint,):
            many = typing.get_origin(one) in (list, tuple)
            holds = typing.get_args(one)[0] if many else one
            if dataclasses.is_dataclass(holds) and isinstance(holds, type):
                found[field.name] = (holds, many)
    return found
