"""Pending commands made from typed coordinates and from features selected in a layer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from qgis.core import (
    QgsAbstractGeometry,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsFeatureRequest,
    QgsGeometry,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
    QgsWkbTypes,
)
from qgis.gui import QgsProjectionSelectionWidget
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.queues import LONGEST_PATH, LONGEST_QUEUE
from ..control.coordinates import read_site_place
from ..control.fleet_controller import FleetController
from ..control.pending_command import CONE, ROUTE, TARGETS, PendingCommand, Point
from ..layers.geometry import SAGITTA_M
from ..layers.site_transform import check_transform, datum_transform
from ..ui.errors import FleetError
from ..ui.glyphs import WRONG_STYLE
from ..ui.language import tr
from ..ui.scheduling import STALLED_AFTER, ReadingThread, StalledError, Steps

WGS84 = "EPSG:4326"


class CoordinatesDialog(QDialog):
    """Stays open: each press of the button, or Enter, sets the place; this dialog never sends anything."""

    chosen = pyqtSignal(float, float)
    """A place in the site frame."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_coordinates_dialog")
        self.setWindowTitle(tr("Coordinates"))
        self.setMinimumWidth(460)
        self._desk = desk
        self._place: Point | None = None
        self._text = QLineEdit()
        self._text.setObjectName("fleet_coordinates_text")
        self._text.setPlaceholderText("48.2083, 16.3725")
        self._crs = QgsProjectionSelectionWidget()
        self._crs.setObjectName("fleet_coordinates_crs")
        self._crs.setCrs(QgsCoordinateReferenceSystem(WGS84))
        self._status = QLabel()
        self._status.setObjectName("fleet_coordinates_told")
        self._status.setWordWrap(True)
        self._status.setTextFormat(Qt.TextFormat.PlainText)
        self._status.setMinimumHeight(4 * self._status.fontMetrics().lineSpacing())
        self._status.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        self._set = QPushButton(tr("Set on the map"))
        self._set.setObjectName("fleet_coordinates_set")
        self._lay_out()
        # Only within the dialog: otherwise Enter would press another button once that had the focus.
        self._set.setDefault(True)
        self._text.textChanged.connect(self._read)
        self._crs.crsChanged.connect(self._read)
        self._set.clicked.connect(self._choose)
        desk.state.site_changed.connect(self._read)
        self._read()

    def ask(self) -> None:
        """Raise the dialog with its text selected, so that typing replaces it."""
        self.show()
        self.raise_()
        self.activateWindow()
        self._text.setFocus()
        self._text.selectAll()

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.addRow(tr("&Coordinates"), self._text)
        form.addRow(tr("C&RS"), self._crs)
        buttons = QDialogButtonBox()
        buttons.addButton(self._set, QDialogButtonBox.ButtonRole.ApplyRole)
        buttons.addButton(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        rows = QVBoxLayout(self)
        rows.addLayout(form)
        rows.addWidget(self._status)
        rows.addWidget(buttons)

    def _read(self, *_: object) -> None:
        self._place = None
        self._status.setStyleSheet("")
        try:
            self._status.setText(self._in_words())
        except FleetError as error:
            self._status.setText(str(error))
            if self._text.text().strip():
                self._status.setStyleSheet(WRONG_STYLE)
        self._set.setEnabled(self._place is not None)

    def _in_words(self) -> str:
        """Read the coordinates entered and return a description of the place.

        :raises FleetError: when they are no place, or there is no site yet.
        """
        crs = self._crs.crs()
        site_crs = self._desk.site_to_canvas.transform().site_crs
        context = self._desk.project.transformContext()
        path = datum_transform(crs, site_crs, context).in_words()
        if not self._text.text().strip():
            order = tr("latitude, longitude") if crs.isGeographic() else tr("x, y")
            return tr("Write {order} in {crs}.\n{path}", order=order, crs=crs.authid(), path=path)
        self._place = read_site_place(self._text.text(), crs, self._desk.state.site, context)
        site = tr("{x:.2f}, {y:.2f} m on the site", x=self._place[0], y=self._place[1])
        ((east, north),) = self._desk.site_to_canvas.transform().frame.to_crs([self._place])
        return tr(
            "{site}; {east:.2f}, {north:.2f} in {crs}.\n{path}",
            site=site,
            east=east,
            north=north,
            crs=site_crs.authid(),
            path=path,
        )

    def _choose(self) -> None:
        if self._place is not None:
            self.chosen.emit(*self._place)


NAME_FIELDS = ("id", "name", "label")


class LayerCommandError(FleetError):
    """A layer contains nothing that a draft could be made of."""


def command_from_layer(layer: QgsVectorLayer | None, desk: FleetController) -> Steps[PendingCommand]:
    """Make an unchecked draft for the selected robot of the features selected in ``layer``, or of all.

    One point is a cone target, several points are several of them, one line is a route.

    :raises FleetError: naming what is wrong with the layer, the selection or the robot.
    """
    robot = desk.selection.last
    if robot is None:
        raise LayerCommandError(
            tr("No robot is selected. Select the one that the draft is for, then try again.")
        )
    if not isinstance(layer, QgsVectorLayer) or not layer.isValid() or not layer.isSpatial():
        raise LayerCommandError(
            tr("No layer of points or lines is active. Click one in the Layers panel, then try again.")
        )
    kind = layer.geometryType()
    if kind == QgsWkbTypes.GeometryType.PolygonGeometry:
        raise LayerCommandError(
            tr(
                "The layer {layer} holds polygons: take a layer of points (targets) or lines (a route).",
                layer=layer.name(),
            )
        )
    meant = LayerFacts(layer.name(), layer.crs())
    features = yield from _features(layer, meant.name)
    if kind == QgsWkbTypes.GeometryType.PointGeometry:
        return _targets(meant, features, robot, desk)
    return _route(meant, features, robot, desk)


class LayerFacts(NamedTuple):
    """Facts about a layer that may be gone when its features have been read."""

    name: str
    crs: QgsCoordinateReferenceSystem


class _FeatureReader:
    """Reads the features with the ids in ``chosen``, or as many of a layer as a queue accepts; counts all."""

    def __init__(self, layer: QgsVectorLayer, chosen: Sequence[int]):
        self._source = QgsVectorLayerFeatureSource(layer)
        self._request = QgsFeatureRequest(list(chosen)) if chosen else QgsFeatureRequest()
        self._most = len(chosen) or LONGEST_QUEUE

    def read(self, go_on: Callable[[], bool]) -> tuple[list[QgsFeature], int]:
        first: list[QgsFeature] = []
        count = 0
        for feature in self._source.getFeatures(self._request):
            count += 1
            if count <= self._most:
                first.append(feature)
            if not go_on():
                break
        return first, count


def _features(layer: QgsVectorLayer, name: str) -> Steps[list[QgsFeature]]:
    chosen = layer.selectedFeatureIds()
    thread = ReadingThread(_FeatureReader(layer, chosen))
    thread.start()
    try:
        features, count = yield from thread.result()
    except StalledError as error:
        raise LayerCommandError(
            tr(
                "The layer {layer} has not answered for {seconds:g} s, so no draft was made of it. Bring its "
                "server or drive back and try again.",
                layer=name,
                seconds=STALLED_AFTER,
            )
        ) from error
    if not chosen and count > LONGEST_QUEUE:
        raise LayerCommandError(
            tr(
                "The layer {layer} has {count} features and a queue takes {longest_queue}: select "
                "those that are meant.",
                layer=name,
                count=count,
                longest_queue=LONGEST_QUEUE,
            )
        )
    if chosen:
        features.sort(key=_age)
    found = [one for one in features if not one.geometry().isNull() and not one.geometry().isEmpty()]
    if not found:
        raise LayerCommandError(tr("The layer {layer} has no feature with a place to go to.", layer=name))
    return found


def _age(feature: QgsFeature) -> tuple[bool, int]:
    """Return a key that sorts features by age: QGIS returns selected ones in any order.

    Those not saved yet have numbers below zero, counted downwards.
    """
    return feature.id() < 0, abs(feature.id())


def _targets(
    layer: LayerFacts, features: Sequence[QgsFeature], robot: str, desk: FleetController
) -> PendingCommand:
    places, names = [], []
    for feature in features:
        # Held in a variable, since its vertices do not keep it alive.
        geometry = _moved(feature, layer, desk)
        for vertex in geometry.vertices():
            places.append((vertex.x(), vertex.y()))
            names.append(_name(feature))
    if len(places) > LONGEST_QUEUE:
        raise LayerCommandError(
            tr(
                "The layer {layer} has {places} points selected and a queue takes {longest_queue}: select "
                "fewer.",
                layer=layer.name,
                places=len(places),
                longest_queue=LONGEST_QUEUE,
            )
        )
    points = _in_site(places, desk)
    if len(points) == 1:
        return PendingCommand(robot, CONE, points)
    return PendingCommand(robot, TARGETS, points, names=tuple(names))


def _route(
    layer: LayerFacts, features: Sequence[QgsFeature], robot: str, desk: FleetController
) -> PendingCommand:
    if len(features) != 1:
        raise LayerCommandError(
            tr(
                "A route is one line, and {features} of the layer {layer} are meant: select one.",
                features=len(features),
                layer=layer.name,
            )
        )
    maximum = QgsAbstractGeometry.SegmentationToleranceType.MaximumDifference
    geometry = _moved(features[0], layer, desk)
    line = geometry.constGet().segmentize(SAGITTA_M, maximum)
    if line.partCount() != 1:
        raise LayerCommandError(
            tr(
                "The line that is selected in {layer} has {parts} parts, and a robot cannot leap from "
                "one to the next: make it one line.",
                layer=layer.name,
                parts=line.partCount(),
            )
        )
    places = [(vertex.x(), vertex.y()) for vertex in line.vertices()]
    if not 2 <= len(places) <= LONGEST_PATH:
        raise LayerCommandError(
            tr(
                "The line has {places} vertices; a route takes 2 to {longest_path}: simplify it first.",
                places=len(places),
                longest_path=LONGEST_PATH,
            )
        )
    return PendingCommand(robot, ROUTE, _in_site(places, desk), legs=(1,) * len(places))


def _moved(feature: QgsFeature, layer: LayerFacts, desk: FleetController) -> QgsGeometry:
    """Return a feature's geometry in the site's CRS."""
    if not layer.crs.isValid():
        raise LayerCommandError(
            tr(
                "The layer {layer} has no CRS, so nobody knows where its points are. Set it in the layer's "
                "properties.",
                layer=layer.name,
            )
        )
    geometry = QgsGeometry(feature.geometry())
    way = QgsCoordinateTransform(
        layer.crs, desk.site_to_canvas.transform().site_crs, desk.project.transformContext()
    )
    try:
        check_transform(way)
        geometry.transform(way)
    except QgsCsException as error:
        raise LayerCommandError(
            tr(
                "Feature {id} of {layer} has no place in the site's CRS ({error}). Leave it out, or correct "
                "the layer's CRS.",
                id=feature.id(),
                layer=layer.name,
                error=error,
            )
        ) from error
    return geometry


def _in_site(places: Sequence[Point], desk: FleetController) -> tuple[Point, ...]:
    in_site = desk.site_to_canvas.transform().frame.to_site(np.array(places, dtype=np.float64))
    if not np.isfinite(in_site).all():
        raise LayerCommandError(
            tr("A coordinate of what is selected is no number. Correct it, or leave it out.")
        )
    return tuple((float(x), float(y)) for x, y in in_site)


def _name(feature: QgsFeature) -> str:
    for field in NAME_FIELDS:
        index = feature.fields().lookupField(field)
        value = feature.attribute(index) if index >= 0 else None
        if isinstance(value, (str, int)) and str(value).strip():
            return str(value).strip()[:128]
    return str(feature.id())
