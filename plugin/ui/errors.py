"""What can go wrong in the plugin; every message names what, where and what to do.

And parts that are removed whatever one of them raises.
"""

from __future__ import annotations

from typing import Any, Protocol


class Part(Protocol):
    """What undoes its constructor."""

    def remove(self) -> None:
        """Take out of QGIS all that the constructor has put there."""


def remove_all(parts: list[Part]) -> None:
    """Remove ``parts``, the last one first, and empty the list.

    :raises Exception: the first that one of them raised, when all the others are removed.
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
    """Something that the operator has to know, in words that can be shown as they are.

    ``topics`` are the conditions it is about (:mod:`..control.messages`): when one has ended it is not true
    any more.
    """

    topics: tuple[Any, ...] = ()


class LibraryMissingError(FleetError):
    """A Python package that the plugin needs is not there, or too old."""


class AddressError(FleetError):
    """The gateway's URL cannot be used."""


class GatewayLinkError(FleetError):
    """The gateway could not be reached, or what answered is no gateway.

    ``final`` is true when trying again cannot help before somebody changes something; ``wants_token`` when
    that is the token or the CA file; ``everywhere`` when it holds for all gateways of the fleet. ``ends``:
    the gateway says that it ends.
    """

    def __init__(
        self,
        message: str,
        *,
        final: bool = False,
        wants_token: bool = False,
        everywhere: bool = False,
        ends: bool = False,
    ):
        super().__init__(message)
        self.final = final
        self.wants_token = wants_token
        self.everywhere = everywhere
        self.ends = ends


class NotSentError(FleetError):
    """What the operator asked for was not sent."""

    def __init__(self, message: str, topics: tuple[Any, ...] = ()):
        super().__init__(message)
        self.topics = topics


class MapTransformError(FleetError):
    """Positions of the site cannot be placed on this canvas."""


# --- What can be wrong with layers on their way into a site ---


class LayerReadingError(FleetError):
    """A layer cannot be read as a whole: the export stops before it writes anything."""


class SiteCrsError(LayerReadingError):
    """A CRS cannot carry a site: none, geographic, not in metres, or a Mercator such as EPSG:3857."""


class LayerCrsError(LayerReadingError):
    """A layer's coordinates have no known place in the site's CRS."""


class PublicationError(FleetError):
    """A site cannot be published: its settings, its folder or what is there already."""


class ProfileError(FleetError):
    """A map profile cannot be read: its file, one of its keys, or one of its expressions."""


class LayerTypeError(LayerReadingError):
    """A layer cannot be opened, or holds neither lines nor polygons."""


class ExpressionError(LayerReadingError):
    """An expression for height, semantics or the outdoor flag is not one."""
