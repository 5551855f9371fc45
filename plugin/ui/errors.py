"""Errors of the plugin, whose messages name subject, place and remedy; removal of parts despite errors.

Every part is removed even if another one raises.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol


class Part(Protocol):
    """A part with a method that undoes its constructor."""

    def remove(self) -> None:
        """Remove from QGIS everything that the constructor added."""


class Removal(NamedTuple):
    """A part without a class of its own, by the function that removes it."""

    remove: Callable[[], None]


def remove_all(parts: list[Part]) -> None:
    """Remove ``parts``, the last one first, and empty the list.

    :raises Exception: the first one raised by a part, after all the others are removed.
    """
    errors = []
    while parts:
        try:
            parts.pop().remove()
        except Exception as error:
            errors.append(error)
    if errors:
        raise errors[0]


class FleetError(Exception):
    """An error for the operator, with a text that can be shown unchanged.

    ``topics`` are the conditions it is about (:mod:`..control.messages`): when one has ended it is no longer
    true.
    """

    topics: tuple[Any, ...] = ()


class LibraryMissingError(FleetError):
    """A Python package that the plugin needs is missing, or too old."""


class AddressError(FleetError):
    """The gateway's URL cannot be used."""


class GatewayLinkError(FleetError):
    """The gateway could not be reached, or the server that answered is no gateway.

    ``final`` is true when another attempt cannot help before something is changed; ``wants_token`` when
    that is the token or the CA file; ``everywhere`` when it applies to all gateways of the fleet. ``ends``:
    the gateway announced its shutdown. ``at_once``: the desk ended the link, to open it again without a wait.
    """

    def __init__(
        self,
        message: str,
        *,
        final: bool = False,
        wants_token: bool = False,
        everywhere: bool = False,
        ends: bool = False,
        at_once: bool = False,
    ):
        super().__init__(message)
        self.final = final
        self.wants_token = wants_token
        self.everywhere = everywhere
        self.ends = ends
        self.at_once = at_once


class NotSentError(FleetError):
    """A request of the operator was not sent."""

    def __init__(self, message: str, topics: tuple[Any, ...] = ()):
        super().__init__(message)
        self.topics = topics


class MapTransformError(FleetError):
    """Positions of the site cannot be placed on this canvas."""


# --- Errors of layers on their way into a site ---


class LayerReadingError(FleetError):
    """A layer cannot be read as a whole: the export stops before it writes anything."""


class SiteCrsError(LayerReadingError):
    """A CRS cannot carry a site: none, geographic, not in metres, or a Mercator such as EPSG:3857."""


class LayerCrsError(LayerReadingError):
    """A layer's coordinates have no known place in the site's CRS."""


class PublicationError(FleetError):
    """A site cannot be published because of its settings, its folder or the existing publication."""


class ProfileError(FleetError):
    """A map profile cannot be read: its file, one of its keys, or one of its expressions."""


class LayerTypeError(LayerReadingError):
    """A layer cannot be opened, or holds neither lines nor polygons."""


class ExpressionError(LayerReadingError):
    """An expression for height, semantics or the outdoor flag is invalid."""
