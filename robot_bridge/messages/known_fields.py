"""What of a JSON object a message has a field for: a newer gateway may tell more."""

from __future__ import annotations

import dataclasses
import functools
from typing import Any


def known_fields(kind: type, values: dict[str, Any]) -> dict[str, Any]:
    """Return those of ``values`` that the dataclass ``kind`` has fields for."""
    names = _names(kind)
    return {name: value for name, value in values.items() if name in names}


@functools.cache
def _names(kind: type) -> frozenset[str]:
    return frozenset(field.name for field in dataclasses.fields(kind))
