"""``fleet:exportroadnetwork``: road centrelines in, the route graphs of other robots out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputFile,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterString,
)

from ....robot_bridge.core.roads import graph_export
from ....robot_bridge.core.roads.graph_export import LayoutNames
from ....robot_bridge.core.roads.lanelet2_export import lanelet2_document, lanes_of, misread_places
from ....robot_bridge.core.roads.network import Network
from ....robot_bridge.core.sites.frame import SiteFrame
from ...ui.language import tr, tr_count, tr_page
from ..common import algorithm, road_sources
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters
from ..common.map_files import MapPlace, PlacedMap
from ..common.outputs import WholeFolder
from ..common.parameters import frame_in_crs_parameters, site_frame

# --- The files of each format that ``fleet:exportroadnetwork`` writes ---

Files = dict[str, bytes]

_NOTABLE_M = 0.01
"""Position error in metres from which it is reported."""


@dataclass
class RoadNetworkExport:
    """Open roads in the site frame, and the export settings; ``warnings`` grow while files are made."""

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
        return FORMAT_WRITERS[format](self)

    @property
    def crs(self) -> str:
        """The CRS that equals the site frame, empty where it has its own origin or rotation."""
        own = self.frame.origin != (0.0, 0.0) or self.frame.rotation != 0.0
        return "" if own else self.frame.crs

    def warn(self, text: str) -> None:
        """Report ``text`` as a warning and count it."""
        self.warnings.append(text)
        self.feedback.pushWarning(text)


def _nav2(export: RoadNetworkExport) -> Files:
    error = graph_export.largest_error(export.network)
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
    return {
        f"{export.name}.geojson": graph_export.nav2_route_graph(
            export.network, export.map_id, export.crs, place
        )
    }


def _lif(export: RoadNetworkExport) -> Files:
    names = LayoutNames(export.name, export.map_id, export.vehicle_type)
    return {
        f"{export.name}.lif.json": graph_export.lif_document(
            export.network, names, datetime.now(timezone.utc)
        )
    }


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
    return {f"{export.name}.osm": lanelet2_document(lanes, export.place.to_lonlat)}


FORMAT_WRITERS: dict[str, Callable[[RoadNetworkExport], Files]] = {
    "nav2": _nav2,
    "lif": _lif,
    "lanelet2": _lanelet2,
}


# --- ``fleet:exportroadnetwork``: road centrelines in, the route graphs of other robots out ---

FORMATS, NAME, OUTPUT = "FORMATS", "NAME", "OUTPUT"
MAP_ID, VEHICLE_TYPE, KEEP_LEFT = "MAP_ID", "VEHICLE_TYPE", "KEEP_LEFT"
FORMAT_NAMES = {
    "nav2": tr("Nav2 route graph (GeoJSON)"),
    "lif": tr("VDMA LIF, for VDA 5050 (JSON)"),
    "lanelet2": tr("Lanelet2 map (OSM)"),
}


class ExportRoadNetwork(FleetAlgorithm):
    """Writes a road network as graphs used by other robots and their masters."""

    GROUP = ("roads", tr("Roads"))
    NAME = "exportroadnetwork"
    TITLE = tr("Export road network")
    SUMMARY = tr("Writes the road network as a Nav2 route graph, a VDMA LIF layout or a Lanelet2 map.")
    ICON = "export_road_network.svg"
    TAGS = (
        "road",
        "network",
        "route graph",
        "nav2",
        "ros",
        "geojson",
        "lif",
        "vdma",
        "vda 5050",
        "lanelet2",
        "autoware",
    )
    HELP = tr_page("""
    <p>Writes the network of road centrelines as other robots read it.</p>
    <p><b>Formats</b>, several at once:</p>
    <ul>
    <li><i>nav2</i>: graph for Nav2's route server (GeoJSON). Nav2 drives straight from node to node, so
    every point of a road becomes a node.</li>
    <li><i>lif</i>: VDMA's Layout Interchange Format 1.0, for masters of VDA 5050 vehicles (JSON). Roads that
    are not straight have a trajectory.</li>
    <li><i>lanelet2</i>: lanes with borders for Lanelet2 and Autoware (OSM). Traffic keeps to the right, or to
    the left on request.</li>
    </ul>
    <p>Roads that are driven both ways become two edges; one-way roads one. Closed roads are left out, and so
    are edges that lead through a polygon of the <b>areas that must not be driven through</b>. Speeds go over
    as limits.</p>
    <p>Coordinates are metres in the <b>site frame</b>, as on robot maps: <i>ORIGIN</i> and <i>ROTATION</i>,
    else as the project has it. Nav2 keeps 32 bits of a coordinate: give an origin on the site, or a warning
    says by how much places move.</p>
    <p>Existing files are replaced, each in one step, after all of them could be made.
    docs/navigation-maps.md says what is in each.</p>
    <pre>qgis_process run fleet:exportroadnetwork -- ROADS=roads.gpkg FORMATS=nav2 FORMATS=lif
    ORIGIN="640420,5193480" NAME=campus OUTPUT=graphs</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in _parameters():
            self.addParameter(parameter)
        for name in FORMAT_WRITERS:
            self.addOutput(QgsProcessingOutputFile(name.upper(), tr("File of format {name}", name=name)))
        self.addOutput(QgsProcessingOutputNumber("EDGE_COUNT", tr("Edges")))
        self.addOutput(QgsProcessingOutputNumber(road_sources.WARNING_COUNT, tr("Warnings")))

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with algorithm.shown_by_processing():
            self._source = road_sources.RoadSource(self, parameters, context)
            self._keepouts = road_sources.KeepoutAreas(self, parameters, context)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        formats = self.parameterAsEnumStrings(parameters, FORMATS, context)
        folder = Path(self.parameterAsString(parameters, OUTPUT, context))
        with algorithm.shown_by_processing(feedback):
            if not formats:
                raise ParameterError(
                    tr("FORMATS is empty: choose of {known}.", known=", ".join(FORMAT_WRITERS))
                )
            export = self._plan(parameters, context, feedback)
            if export is None:
                return {}
            made: dict[str, Files] = {}
            for number, format in enumerate(formats):
                feedback.setProgressText(tr("Making {format}", format=format))
                made[format] = export.files(format)
                feedback.setProgress(60.0 + 35.0 * (number + 1) / len(formats))
                if feedback.isCanceled():
                    return {}
            _write(made, folder, feedback)
        edges = len(export.network)
        feedback.pushInfo(tr_count(edges, "1 edge", "%n edges"))
        return {
            OUTPUT: str(folder),
            "EDGE_COUNT": edges,
            road_sources.WARNING_COUNT: len(export.warnings),
            **{format.upper(): str(folder / next(iter(files))) for format, files in made.items()},
        }

    def _plan(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> RoadNetworkExport | None:
        """Return the plan of the files to write; None if cancelled."""
        words = {name: self.parameterAsString(parameters, name, context).strip() for name in _WORDS}
        for name, word in words.items():
            if not word or (name == NAME and (Path(word).name != word or word.startswith("."))):
                raise ParameterError(
                    tr("{name} {value!r} cannot be used: give a plain word.", name=name, value=word)
                )
        reading = self._source.read(feedback)
        if reading is None:
            return None
        frame = site_frame(self, parameters, context, reading.crs)
        built = road_sources.network_of_roads(self, parameters, context, reading, feedback)
        if built is None:
            return None
        closed, warnings = self._keepouts.edges_inside(built[0], reading.crs, feedback)
        feedback.setProgress(60)
        return RoadNetworkExport(
            network=_in_frame(graph_export.open_roads(built[0], closed), frame),
            frame=frame,
            name=words[NAME],
            map_id=words[MAP_ID],
            vehicle_type=words[VEHICLE_TYPE],
            warnings=[*reading.warnings, *warnings],
            feedback=feedback,
            place=PlacedMap(MapPlace(reading.crs, frame), context.transformContext()),
            keep_left=self.parameterAsBool(parameters, KEEP_LEFT, context),
        )


_WORDS = {NAME: "roads", MAP_ID: "map", VEHICLE_TYPE: "robot"}
"""Parameters that are a word, with their defaults: names in files, the same in every language."""


def _parameters() -> list[QgsProcessingParameterDefinition]:
    roads, tolerance, *others = road_sources.road_parameters()
    rare: list[QgsProcessingParameterDefinition] = [
        *frame_in_crs_parameters(),
        QgsProcessingParameterString(MAP_ID, tr("Robots' name for the site frame"), _WORDS[MAP_ID]),
        QgsProcessingParameterBoolean(
            KEEP_LEFT, tr("Traffic keeps to the left (Lanelet2)"), defaultValue=False
        ),
        QgsProcessingParameterString(
            VEHICLE_TYPE, tr("Type of vehicle that drives here (LIF)"), _WORDS[VEHICLE_TYPE]
        ),
    ]
    return [
        roads,
        algorithm.enum_parameter(FORMATS, tr("Formats"), FORMAT_NAMES, ["nav2"], several=True),
        QgsProcessingParameterString(NAME, tr("Name of the files"), _WORDS[NAME]),
        road_sources.keepout_parameter(),
        road_sources.repair_parameter(),
        tolerance,
        *others,
        *map(algorithm.advanced, rare),
        QgsProcessingParameterFolderDestination(OUTPUT, tr("Folder")),
    ]


def _in_frame(network: Network, frame: SiteFrame) -> Network:
    return graph_export.transformed_network(
        network, frame.to_site(network.nodes), frame.to_site(network.edges.xy)
    )


def _write(made: dict[str, Files], folder: Path, feedback: QgsProcessingFeedback) -> None:
    """Write all files into the folder or none."""
    files = {name: content for part in made.values() for name, content in part.items()}
    with WholeFolder(folder, tr("The road network")) as whole:
        for name, content in files.items():
            whole.add(name, content)
        whole.publish()
    for name, content in files.items():
        feedback.pushInfo(tr("{target}: {content} bytes", target=folder / name, content=len(content)))
