"""What an operator wants of the ways that *Route on roads* leads."""

from __future__ import annotations

from dataclasses import dataclass

from ..language import tr


@dataclass(frozen=True)
class WayWishes:
    """The shortest way along all roads, unless something else is wanted.

    ``surfaces`` names those that may be used, none of them: all. ``least_width`` is what a road must have,
    in metres, beside the width of the site's robots. ``avoid_reserved`` leaves out the roads on which other
    robots' tasks lead.
    """

    fastest: bool = False
    surfaces: tuple[str, ...] = ()
    least_width: float = 0.0
    avoid_reserved: bool = False

    def in_words(self) -> list[str]:
        """Return what is wanted beyond the shortest way, a text for each."""
        words = []
        if self.fastest:
            words.append(tr("the fastest way"))
        if self.avoid_reserved:
            words.append(tr("off the roads of other robots"))
        if self.surfaces:
            words.append(tr("only on {surfaces}", surfaces=", ".join(self.surfaces)))
        if self.least_width:
            words.append(tr("roads at least {metres:g} m wide", metres=self.least_width))
        return words


SHORTEST = WayWishes()


def surfaces_of(text: str) -> tuple[str, ...]:
    """Return the names of surfaces in ``text``, which has commas between them, each once."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
