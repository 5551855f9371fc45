"""Errors about layers and their features."""

from __future__ import annotations

from ..ui.errors import FleetError

# --- What can be wrong with layers on their way into a site; every message says what, where and what to do


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
