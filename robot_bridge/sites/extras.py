"""What else an obstacle has to say, as one field of a layer: a JSON object of texts, or nothing."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache

from ..core.decoding import DecodingError, decode_json
from .errors import LayerError


def extras_text(extras: Mapping[str, str]) -> str:
    """Return ``extras`` as they stand in the field ``ext``, such as ``{"h": "est"}``; nothing for none."""
    return _text(tuple(extras.items())) if extras else ""


@lru_cache(maxsize=1000)
def _text(extras: tuple[tuple[str, str], ...]) -> str:
    """Return what :func:`extras_text` does; a city has few different ones."""
    return json.dumps(dict(extras), ensure_ascii=False)


def extras_of(text: str | None, where: str) -> dict[str, str]:
    """Return the extras in the field ``ext``; ``where`` names its file, layer and feature.

    :raises LayerError: when it is no JSON object of texts.
    """
    try:
        found = decode_json(text) if text else {}
    except DecodingError:
        found = None
    if not isinstance(found, dict) or not all(isinstance(value, str) for value in found.values()):
        raise LayerError(
            f"{where}: its ext is {str(text)[:80]!r}, and not a JSON object of texts such as "
            '{"h": "est"}. Correct or empty it, or publish the site again.'
        )
    return found
