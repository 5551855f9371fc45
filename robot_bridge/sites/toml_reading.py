"""TOML from anybody, read at a cost that goes by its length; ``tomllib`` takes hours for 1 MB of dots."""

from __future__ import annotations

import re
from typing import Any

LARGEST = 256_000
"""characters; a site's settings and profiles of layers have a few thousand."""

_MOST_PARTS = 32
# tomllib goes over all parts of a dotted key for each of them: n² steps.
_LONG_KEY = re.compile(
    rf"""(?:(?<![\w-])(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){{{_MOST_PARTS}}}""", re.ASCII
)


def toml_tables(text: str) -> dict[str, Any]:
    """Return the tables in ``text``.

    :raises ValueError: naming what is wrong: no TOML, too long, or nested too deeply.
    :raises ImportError: on Python before 3.11, which has no ``tomllib``.
    """
    import tomllib

    if len(text) > LARGEST:
        raise ValueError(f"it has {len(text)} characters, more than {LARGEST}")
    if (deep := _LONG_KEY.search(text)) is not None:
        line = text.count("\n", 0, deep.start()) + 1
        raise ValueError(f"a key has more than {_MOST_PARTS} parts (line {line})")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("its arrays or tables are nested too deeply") from None
