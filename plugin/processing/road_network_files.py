"""The files of each format that ``fleet:exportroadnetwork`` writes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timezone

from qgis.core import QgsProcessingFeedback

from ...robot_bridge.roads.exporters.lanelet2 import lanelet2
from ...robot_bridge.roads.exporters.lanes import lanes_of, misread_places
from ...robot_bridge.roads.exporters.lif import LayoutNames, lif
from ...robot_bridge.roads.exporters.nav2_route_graph import largest_error, nav2_route_graph
from ...robot_bridge.roads.network import Network
from ...robot_bridge.sites.frame import SiteFrame
from ..language import tr
from .errors import ParameterError
from .map_place import PlacedMap

Files = dict[str, bytes]

_NOTABLE_M = 0.01
"""An error of places that is said."""


@dataclass
class RoadNetworkExport:
    """Open roads in the site frame, and what to make of them; ``warnings`` grow while files are made."""

    network: Network
    frame: SiteFrame
    name: str
    map_id: str
    vehicle_type: str
    warnings: list[str]
    feedback: QgsProcessingFeedback
    place: PlacedMap
    keep_left: bool = False

    def files(self, format: str) -> Files:
        """Return names and contents of the files of a format; the first is the one to open.

        :raises RoadsError: when the format cannot hold these roads.
        """
        return FORMATS[format](self)

    @property
    def crs(self) -> str:
        """The CRS that the site frame is, empty where it has an origin or a rotation of its own."""
        own = self.frame.origin != (0.0, 0.0) or self.frame.rotation != 0.0
        return "" if own else self.frame.crs

    def warn(self, text: str) -> None:
        """Say ``text`` and count it."""
        self.warnings.append(text)
        self.feedback.pushWarning(text)


def _nav2(export: RoadNetworkExport) -> Files:
    error = largest_error(export.network)
    if error >= _NOTABLE_M:
        export.warn(
            tr(
                "Nav2 keeps 32 bits of a coordinate, which here moves nodes by up to {metres:.2f} m: give "
                "ORIGIN, a place of the site, for robots and their maps alike.",
                metres=error,
            )
        )
    frame = export.frame
    place = (
        {"crs": frame.crs, "origin": list(frame.origin), "rotation": frame.rotation} if frame.crs else None
    )
    return {f"{export.name}.geojson": nav2_route_graph(export.network, export.map_id, export.crs, place)}


def _lif(export: RoadNetworkExport) -> Files:
    names = LayoutNames(export.name, export.map_id, export.vehicle_type)
    return {f"{export.name}.lif.json": lif(export.network, names, datetime.now(timezone.utc))}


def _lanelet2(export: RoadNetworkExport) -> Files:
    if export.place.is_local:
        raise ParameterError(
            tr(
                "Lanelet2 needs longitudes and latitudes, and the CRS of the roads has no place on the "
                "Earth: give the layer its CRS, or leave lanelet2 out."
            )
        )
    lanes = lanes_of(export.network, export.keep_left)
    misread = misread_places(lanes)
    if misread:
        x, y = misread[0]
        export.warn(
            tr(
                "Lanelet2 reads lanes the wrong way round where corners are tighter than lanes are wide: "
                "{count} here, the first at ({x:.2f}, {y:.2f}). Draw the roads there smoother, or give them "
                "less width.",
                count=len(misread),
                x=x,
                y=y,
            )
        )
    return {f"{export.name}.osm": lanelet2(lanes, export.place.to_lonlat)}


FORMATS: dict[str, Callable[[RoadNetworkExport], Files]] = {"nav2": _nav2, "lif": _lif, "lanelet2": _lanelet2}
