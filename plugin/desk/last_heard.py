"""How long ago anything was heard of a robot, in words."""

from __future__ import annotations

from ..language import tr


def age_in_words(seconds: float) -> str:
    """Return an age as in ``12.3 s``, ``5 min``, ``2.0 h`` or ``3.0 d``."""
    if seconds < 99.95:
        return f"{seconds:.1f} s"
    if seconds < 3570:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h" if seconds < 48 * 3600 else f"{seconds / 86400:.1f} d"


def heard_in_words(state: str, seconds: float, link: object) -> str:
    """Return a robot's ``state``, how long ago it was heard, and how it is connected."""
    return tr("{state}, last heard {age} ago over {link}", state=state, age=age_in_words(seconds), link=link)
