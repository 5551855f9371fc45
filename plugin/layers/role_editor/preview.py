"""Preview of layers in their roles: counts, warnings and a picture, computed in the background."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from qgis.core import QgsFeedback, QgsTask
from qgis.PyQt.QtCore import QLineF, QPointF, QSize, pyqtSignal
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QPaintEvent, QPen, QResizeEvent
from qgis.PyQt.QtWidgets import QSizePolicy, QWidget

from ....robot_bridge.core.robotmap.model import ShapeType
from ...ui.errors import FleetError
from ...ui.glyphs import painting
from ...ui.language import tr, tr_count
from ..layer_source import ObstacleSource
from ..obstacle_layers import read_outlines
from ..road_layers import read_areas, read_centrelines
from ..roles import FURNITURE, KEEPOUT, OBSTACLE, OBSTACLE_ROLES, RAMP, ROAD_CENTRELINE, ROAD_SURFACE, STAIRS
from ..site_transform import SiteGeoreference

# --- The result of publishing a layer with a role: counts, warnings and line segments to draw ---

ESTIMATED_HEIGHT_M = 3.0
ESTIMATED_WIDTH_M = 3.5
_KINDS = (OBSTACLE, ROAD_CENTRELINE, ROAD_SURFACE, KEEPOUT)


@dataclass(frozen=True)
class LayerMeasure:
    """The measure of one layer.

    ``segments`` is (n, 4): x and y of both ends, metres in the site frame. ``warnings`` name features;
    ``refused`` is why nothing of the layer can be published.
    """

    role: str = ""
    count: int = 0
    segments: np.ndarray = field(default_factory=lambda: np.empty((0, 4)))
    warnings: Sequence[str] = ()
    refused: str = ""

    def __str__(self) -> str:
        if self.refused:
            return tr("refused")
        if not self.role:
            return ""
        parts = [_things(self.role, self.count), _segments(len(self.segments))]
        return ", ".join(parts + ([_warnings(len(self.warnings))] if self.warnings else []))


def measure_layer(
    source: ObstacleSource, site: SiteGeoreference, feedback: QgsFeedback
) -> LayerMeasure | None:
    """Return the measure of ``source`` with its role, None if cancelled; from any thread."""
    try:
        if source.role in OBSTACLE_ROLES:
            reading = read_outlines([source], site, None, ESTIMATED_HEIGHT_M, feedback)
            flights = ShapeType.STAIRS
            rows = reading.rows
            lines = [_risers(row.points) if row.shape_type is flights else _chain(row.points) for row in rows]
            solid = sum(not row.courtyard for row in rows)
            found = LayerMeasure(source.role, solid, _joined(lines), reading.warnings)
        elif source.role == ROAD_CENTRELINE:
            reading = read_centrelines([source], site, ESTIMATED_WIDTH_M, feedback)
            lines = [_chain(line.points) for line in reading.items]
            found = LayerMeasure(source.role, len(lines), _joined(lines), reading.warnings)
        else:
            reading = read_areas([source], site, source.role, feedback)
            lines = [_chain(ring) for area in reading.items for ring in area.rings]
            found = LayerMeasure(source.role, len(reading.items), _joined(lines), reading.warnings)
    except FleetError as error:
        return LayerMeasure(source.role, refused=str(error))
    return found if reading.complete else None


def measure_summary(measures: Sequence[LayerMeasure]) -> str:
    """Return the summary of all layers, in one line."""
    counted = dict.fromkeys(_KINDS, 0)
    for one in measures:
        if one.role:
            counted[one.role if one.role in counted else OBSTACLE] += one.count
    segments = sum(len(one.segments) for one in measures if one.role in OBSTACLE_ROLES)
    parts = [_things(kind, number) for kind, number in counted.items()]
    parts[0] = tr("{obstacles} of {segments}", obstacles=parts[0], segments=_segments(segments))
    refused = sum(bool(one.refused) for one in measures)
    if refused:
        parts.append(tr_count(refused, "1 layer refused", "%n layers refused"))
    return ", ".join([*parts, _warnings(sum(len(one.warnings) for one in measures))])


def _things(role: str, number: int) -> str:
    """Return the number of objects of a layer of ``role`` as text; ramps, stairs, furniture are obstacles."""
    if role == ROAD_CENTRELINE:
        return tr_count(number, "1 road", "%n roads")
    if role == ROAD_SURFACE:
        return tr_count(number, "1 surface", "%n surfaces")
    if role == KEEPOUT:
        return tr_count(number, "1 keepout", "%n keepouts")
    return tr_count(number, "1 obstacle", "%n obstacles")


def _segments(number: int) -> str:
    return tr_count(number, "1 segment", "%n segments")


def _warnings(number: int) -> str:
    return tr_count(number, "1 warning", "%n warnings")


def _chain(points: np.ndarray) -> np.ndarray:
    return np.hstack([points[:-1], points[1:]])


def _risers(points: np.ndarray) -> np.ndarray:
    return points.reshape(-1, 4)


def _joined(lines: Sequence[np.ndarray]) -> np.ndarray:
    return np.concatenate(lines) if lines else np.empty((0, 4))


# --- The preview: the segments of every layer drawn to scale, north of the site frame up ---

GROUND = QColor("#f7f8f9")
COLOURS = {
    ROAD_SURFACE: QColor("#c3c9cf"),
    ROAD_CENTRELINE: QColor("#8a949e"),
    KEEPOUT: QColor("#c1121f"),
    OBSTACLE: QColor("#1f3b4d"),
    FURNITURE: QColor("#1f3b4d"),
    STAIRS: QColor("#7b4ea3"),
    RAMP: QColor("#b5651d"),
}
"""The colour of a role's segments, in the order of drawing."""

MARGIN = 10
_EVERY = 5000


def draw_preview(
    measures: Iterable[LayerMeasure], size: QSize, ratio: float, feedback: QgsFeedback
) -> QImage | None:
    """Return a picture of ``size`` widget pixels at ``ratio`` device pixels each, None if cancelled."""
    drawn = [one for one in measures if len(one.segments)]
    image = QImage(size * ratio, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(ratio)
    image.fill(GROUND)
    if not drawn:
        return image
    order = list(COLOURS)
    drawn.sort(key=lambda one: order.index(one.role))
    placed = _placed([one.segments for one in drawn], size)
    with painting(image) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for one, segments in zip(drawn, placed, strict=True):
            painter.setPen(QPen(COLOURS[one.role], 1.2))
            for first in range(0, len(segments), _EVERY):
                if feedback.isCanceled():
                    return None
                painter.drawLines([QLineF(*row) for row in segments[first : first + _EVERY].tolist()])
        _scale_bar(painter, size, _metres_to_pixels([one.segments for one in drawn], size))
    return image


def _placed(groups: Sequence[np.ndarray], size: QSize) -> list[np.ndarray]:
    """Return the segments in pixels, without those too short to be visible."""
    low, high = _extent(groups)
    scale = _metres_to_pixels(groups, size)
    middle = (low + high) / 2
    centre = np.array([size.width() / 2, size.height() / 2])
    flip = np.array([scale, -scale])
    placed = []
    for segments in groups:
        ends = (segments.reshape(-1, 2, 2) - middle) * flip + centre
        seen = np.abs(ends[:, 1] - ends[:, 0]).max(axis=1) > 0.3
        placed.append(ends[seen].reshape(-1, 4))
    return placed


def _metres_to_pixels(groups: Sequence[np.ndarray], size: QSize) -> float:
    low, high = _extent(groups)
    width, height = np.maximum(high - low, 1.0)
    return max(min((size.width() - 2 * MARGIN) / width, (size.height() - 2 * MARGIN) / height), 1e-9)


def _extent(groups: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    boxes = [(group.reshape(-1, 2).min(axis=0), group.reshape(-1, 2).max(axis=0)) for group in groups]
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def _scale_bar(painter: QPainter, size: QSize, scale: float) -> None:
    ideal_length = 0.25 * size.width() / scale
    step = 10.0 ** np.floor(np.log10(ideal_length))
    metres = max(step * factor for factor in (1, 2, 5) if step * factor <= ideal_length)
    length, y = metres * scale, size.height() - MARGIN
    painter.setPen(QPen(QColor("#30383f"), 2))
    painter.drawLine(QLineF(MARGIN, y, MARGIN + length, y))
    painter.drawText(QPointF(MARGIN, y - 5), tr("{metres:g} m", metres=metres))


# --- Measuring of layers and drawing of the preview in the background ---

Key = object


class PreviewTask(QgsTask):
    """Measures ``sources`` one by one, then draws them together with the ``known`` ones.

    ``measured`` and ``drawn`` are emitted in the worker; Qt delivers them in the receiver's thread.
    """

    measured = pyqtSignal(object, object)
    drawn = pyqtSignal(QImage)

    def __init__(
        self,
        sources: Mapping[Key, ObstacleSource],
        known: Mapping[Key, LayerMeasure],
        site: SiteGeoreference | None,
        size: QSize,
        ratio: float,
    ):
        super().__init__(tr("Preview of the site"), QgsTask.Flag.CanCancel)
        self._sources, self._known, self._site = dict(sources), dict(known), site
        self._size, self._ratio = size, ratio
        self._feedback = QgsFeedback()
        self.left = threading.Event()
        """Set once the worker has left :meth:`run`."""

    def run(self) -> bool:
        try:
            return self._work()
        finally:
            self.left.set()

    def cancel(self) -> None:
        self._feedback.cancel()
        super().cancel()

    def _work(self) -> bool:
        for key, source in self._sources.items():
            found = measure_layer(source, self._site, self._feedback)
            if found is None or self._feedback.isCanceled():
                return False
            self._known[key] = found
            self.measured.emit(key, found)
        image = draw_preview(self._known.values(), self._size, self._ratio, self._feedback)
        if image is None:
            return False
        self.drawn.emit(image)
        return True


# --- Shows the picture of the preview ---


class PreviewView(QWidget):
    """A picture as large as the widget; ``resized`` requests one of another size."""

    resized = pyqtSignal()

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_roles_preview")
        self.setMinimumHeight(160)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.image = QImage()

    def sizeHint(self):
        return QSize(700, 330)

    def show_image(self, image: QImage) -> None:
        """Show ``image`` from now on."""
        self.image = image
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        with painting(self) as painter:
            painter.fillRect(self.rect(), GROUND)
            if not self.image.isNull():
                painter.drawImage(self.rect(), self.image)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.resized.emit()
