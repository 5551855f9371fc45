"""What supervisors ask about the sites that a gateway may serve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class GetSites:
    """Ask for the published sites that lie beside the one that is served, and that one."""

    method: ClassVar[str] = "get_sites"


@dataclass(frozen=True)
class ChooseSite:
    """Have another site served from now on: ``site`` is the name of its folder, as in ``get_sites``."""

    method: ClassVar[str] = "choose_site"
    site: str


@dataclass(frozen=True)
class SiteOffer:
    """A folder with a published site. ``refusal`` says why it cannot be chosen, where it cannot.

    ``id``, ``name`` and ``version`` are the publication's own; None where that cannot be read.
    """

    site: str
    served: bool
    id: str | None = None
    name: str | None = None
    version: int | None = None
    refusal: str | None = None


@dataclass(frozen=True)
class Sites:
    """The sites that a gateway may serve, by the names of their folders."""

    sites: list[SiteOffer]
