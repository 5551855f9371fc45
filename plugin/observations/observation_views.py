"""Observations fetched from the gateway, in a list model, and in a layer with images."""

from __future__ import annotations

from collections.abc import Set
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsApplication,
    QgsEditorWidgetSetup,
    QgsExpression,
    QgsMarkerSymbol,
    QgsProject,
    QgsProperty,
    QgsRasterMarkerSymbolLayer,
    QgsRuleBasedRenderer,
    QgsSymbolLayer,
    QgsUnitTypes,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QAbstractListModel, QModelIndex, QObject, QSize, Qt, QTemporaryDir, pyqtSignal
from qgis.PyQt.QtGui import QColor, QIcon, QPixmap

from ...robot_bridge.core.messages.administration import SiteReport
from ...robot_bridge.core.messages.records import (
    GetImage,
    GetObservations,
    ObservationReport,
    ObservationState,
    ReviewObservation,
)
from ..control.fleet_controller import FleetController
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.report_caches import ObservationCache
from ..layers.live_layers import RowLayer, escaped
from ..panel.robot_details import DecodeTask
from ..ui.errors import FleetError
from ..ui.language import date_and_time, time_of_day, tr

SIDE = 256
"""Length in pixels of the longer side of a picture."""


class Thumbnails(QObject):
    """Makes the pictures in the background, in a folder that is deleted with the plugin."""

    made = pyqtSignal(int)
    """The picture of this observation is ready."""
    failed = pyqtSignal(int)
    """The image of this observation cannot be read."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._folder = QTemporaryDir()
        self._tasks: dict[int, ThumbnailTask] = {}
        self._made: set[int] = set()

    def has(self, number: int) -> bool:
        """Return whether the picture of an observation exists or is being made."""
        return number in self._made or number in self._tasks

    def file(self, number: int) -> str:
        """Return the file of an observation's picture, empty while there is none."""
        return str(self._path(number)) if number in self._made else ""

    def make(self, number: int, answer: dict) -> bool:
        """Make a picture of the image in the gateway's ``answer``; False when it contains none."""
        image = answer.get("image")
        if not isinstance(image, str) or not self._folder.isValid():
            return False
        task = ThumbnailTask(number, image, self._path(number))
        task.ended.connect(self._ended)
        self._tasks[number] = task
        QgsApplication.taskManager().addTask(task)
        return True

    def keep(self, numbers: Set[int]) -> None:
        """Forget the pictures of all other observations; those being made of them are dropped."""
        for number in self._tasks.keys() - numbers:
            self._tasks.pop(number).cancel()
        for number in self._made - numbers:
            self._path(number).unlink(missing_ok=True)
        self._made &= numbers

    def clear(self) -> None:
        """Forget every picture."""
        self.keep(frozenset())

    def remove(self) -> None:
        """Delete the folder."""
        tasks = list(self._tasks.values())
        self.clear()
        for task in tasks:
            task.waitForFinished(1000)
        self._folder.remove()

    def _path(self, number: int) -> Path:
        return Path(self._folder.path()) / f"observation-{number}.png"

    def _ended(self, task: ThumbnailTask, done: bool) -> None:
        number = task.number
        if self._tasks.get(number) is not task:
            return
        del self._tasks[number]
        if done:
            self._made.add(number)
            self.made.emit(number)
        else:
            self.failed.emit(number)


class ThumbnailTask(DecodeTask):
    """Decodes a base64 image and writes it, reduced, to ``file``; ``number`` is that of the observation."""

    def __init__(self, number: int, text: str, file: Path):
        super().__init__(text)
        self.number = number
        self._file = file

    def run(self) -> bool:
        if not super().run() or self.isCanceled():
            return False
        smooth = Qt.TransformationMode.SmoothTransformation
        small = self.image.scaled(QSize(SIDE, SIDE), Qt.AspectRatioMode.KeepAspectRatio, smooth)
        self.image = None
        return small.save(str(self._file), "PNG")


PAGE = 500
REVIEWED = 200
"""Reviewed ones that are requested at the beginning of a link."""


class ObservationFeed(QObject):
    """Fetches all pending observations, page by page, and one image after the other.

    ``reviewed`` has the number of an observation whose review the gateway accepted, ``refused`` the number
    and the reason why it did not.
    """

    reviewed = pyqtSignal(int)
    refused = pyqtSignal(int, str)

    def __init__(self, desk: FleetController, thumbnails: Thumbnails, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._thumbnails = thumbnails
        self._was_connected = False
        self._pages: set[str] = set()
        self._reviews: dict[str, int] = {}
        self._image: tuple[str, int] | None = None
        self._without: set[int] = set()
        desk.state.link_changed.connect(self._link_changed)
        desk.orders.answered.connect(self._answered)
        desk.state.observations_changed.connect(self._observations_changed)
        desk.state.site_changed.connect(self._site_changed)
        thumbnails.failed.connect(self._without.add)

    def review(self, request: ReviewObservation) -> None:
        """Send the review of an observation to the gateway; raises NotSentError when that is impossible."""
        self._reviews[self._desk.orders.inquire(request)] = request.observation

    def awaits_answer(self, number: int) -> bool:
        """Return whether a review of this observation is being sent."""
        return number in self._reviews.values()

    def _link_changed(self) -> None:
        connected = self._desk.state.link.phase is ConnectionPhase.CONNECTED
        if connected and not self._was_connected:
            self._without.clear()
            self._ask_page(GetObservations(state=ObservationState.PENDING, limit=PAGE))
            self._ask_page(GetObservations(limit=REVIEWED))
        if not connected:
            self._image = None
        self._was_connected = connected

    def _ask_page(self, request: GetObservations) -> None:
        try:
            self._pages.add(self._desk.orders.inquire(request))
        except FleetError:
            # The link is down again: everything is requested again when it is back.
            self._pages.clear()

    def _answered(self, answer: RequestResult) -> None:
        key = answer.order.key
        if key in self._pages:
            self._pages.discard(key)
            self._receive_page(answer)
        elif self._image is not None and key == self._image[0]:
            number, self._image = self._image[1], None
            self._receive_image(number, answer)
        elif key in self._reviews:
            number = self._reviews.pop(key)
            if answer.error is None:
                self.reviewed.emit(number)
            else:
                self.refused.emit(number, answer.error)

    def _receive_page(self, answer: RequestResult) -> None:
        if answer.error is not None:
            if self._desk.state.link.phase is ConnectionPhase.CONNECTED:
                self._desk.warning.emit(tr("What robots saw is not known: {error}", error=answer.error))
            return
        found = (answer.result or {}).get("observations") or []
        if len(found) == PAGE:
            before = found[-1]["observation"]
            self._ask_page(GetObservations(state=ObservationState.PENDING, before=before, limit=PAGE))
        self._fetch_image()

    def _receive_image(self, number: int, answer: RequestResult) -> None:
        if answer.error is not None or not self._thumbnails.make(number, answer.result or {}):
            self._without.add(number)
        self._fetch_image()

    def _observations_changed(self, _numbers: list[int]) -> None:
        # The cache forgets those reviewed long ago, and a picture is a file of up to 0.2 MB.
        known = {one.observation for one in self._desk.state.observations}
        self._thumbnails.keep(known)
        self._without &= known
        self._fetch_image()

    def _fetch_image(self) -> None:
        """Request the next missing image, when no other request is under way."""
        if self._image is not None or self._desk.state.link.phase is not ConnectionPhase.CONNECTED:
            return
        number = next(
            (one.observation for one in self._desk.state.observations.ordered() if self._lacks(one)), None
        )
        if number is None:
            return
        try:
            self._image = self._desk.orders.inquire(GetImage(number)), number
        except FleetError:
            self._image = None

    def _lacks(self, report: ObservationReport) -> bool:
        number = report.observation
        return (
            report.media_type is not None and number not in self._without and not self._thumbnails.has(number)
        )

    def _site_changed(self) -> None:
        if not len(self._desk.state.observations):
            self._thumbnails.clear()
            self._without.clear()


FIELDS = (
    "observation:integer,state:string,robot:string,kind:string,object:string,label:string,height:double,"
    "radius:double,received:string,reviewed_by:string,reason:string,thumbnail:string"
)
COLOURS = {"pending": "255,179,0", "accepted": "46,125,50", "rejected": "117,117,117"}
MARKS = {"pending": "diamond", "accepted": "circle", "rejected": "cross2"}
"""A shape for each state besides its colour, for colour-blind users."""
STATES = {
    ObservationState.PENDING: tr("to be reviewed"),
    ObservationState.ACCEPTED: tr("accepted"),
    ObservationState.REJECTED: tr("rejected"),
}
PICTURES_FROM = 1000
"""The scale from which images are shown on the map itself."""
_OBJECT, _LABEL = escaped('"object"'), escaped("coalesce(\"label\", '')")
MAP_TIP = f"""
<b>[% {_OBJECT} %]</b> [% {_LABEL} %]<br>[% {{state}} %] · [% "robot" %] · [% "received" %]
[% if("thumbnail" != '', '<br><img width="220" src="file:///' || "thumbnail" || '">', '') %]
"""


class ObservationLayer:
    """The layer *Observations*, created with the first one and removed with the plugin."""

    def __init__(self, project: QgsProject, thumbnails: Thumbnails):
        self._thumbnails = thumbnails
        self._live = RowLayer(
            project, "observations", tr("Observations"), "Point", FIELDS, style_observations
        )

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none."""
        return self._live.layer

    def show(self, cache: ObservationCache, site: SiteReport | None) -> None:
        """Write every observation."""
        self._live.show([([(one.x, one.y)], self._values(one)) for one in cache], site)

    def remove(self) -> None:
        """Remove the layer from the project."""
        self._live.remove()

    def _values(self, one: ObservationReport) -> list[Any]:
        return [
            one.observation,
            one.state.value,
            one.robot,
            "image" if one.media_type else "object",
            one.object,
            one.semantics or one.label or "",
            one.height,
            one.radius,
            date_and_time(one.received_at),
            one.reviewed_by or "",
            one.reason or "",
            self._thumbnails.file(one.observation),
        ]


def style_observations(layer: QgsVectorLayer) -> None:
    """Style a layer of observations: a mark for each state, images at large scales."""
    root = QgsRuleBasedRenderer.Rule(None)
    pictures = QgsRuleBasedRenderer.Rule(_picture(), 0, PICTURES_FROM, "\"thumbnail\" != ''", tr("image"))
    root.appendChild(pictures)
    for state, colour in COLOURS.items():
        mark = {
            "name": MARKS[state],
            "color": f"{colour},230",
            "outline_color": "33,33,33" if state != "rejected" else colour,
            "outline_width": "0.5",
            "size": "4.2",
        }
        rule = QgsRuleBasedRenderer.Rule(
            QgsMarkerSymbol.createSimple(mark),
            filterExp=f"\"state\" = '{state}'",
            label=STATES[ObservationState(state)],
        )
        root.appendChild(rule)
    layer.setRenderer(QgsRuleBasedRenderer(root))
    layer.setMapTipTemplate(MAP_TIP.replace("{state}", _state_in_words()))
    layer.setDisplayExpression(f"\"object\" || ' · ' || {_state_in_words()}")
    field = layer.fields().indexFromName("thumbnail")
    shown = {
        "DocumentViewer": 1,
        "DocumentViewerHeight": 180,
        "DocumentViewerWidth": 220,
        "FileWidget": False,
    }
    layer.setEditorWidgetSetup(field, QgsEditorWidgetSetup("ExternalResource", shown))


def _state_in_words() -> str:
    """Return the expression that translates the field ``state``, which is the same in all languages."""
    words = (f"'{state.value}', {QgsExpression.quotedString(word)}" for state, word in STATES.items())
    return f'map_get(map({", ".join(words)}), "state")'


def _picture() -> QgsMarkerSymbol:
    """Return a symbol that draws the file in field ``thumbnail``, beside its place."""
    picture = QgsRasterMarkerSymbolLayer("", 16.0)
    picture.setSizeUnit(QgsUnitTypes.RenderUnit.RenderMillimeters)
    picture.setDataDefinedProperty(
        QgsSymbolLayer.Property.PropertyName, QgsProperty.fromExpression('"thumbnail"')
    )
    picture.setVerticalAnchorPoint(QgsRasterMarkerSymbolLayer.VerticalAnchorPoint.Bottom)
    symbol = QgsMarkerSymbol()
    symbol.changeSymbolLayer(0, picture)
    return symbol


NUMBER = Qt.ItemDataRole.UserRole
ICON = QSize(56, 42)


class ObservationModel(QAbstractListModel):
    """The observations in the order of review; ``reports`` are its rows."""

    def __init__(self, thumbnails: Thumbnails, parent: QObject | None = None):
        super().__init__(parent)
        self._thumbnails = thumbnails
        self._icons: dict[int, QIcon] = {}
        self.reports: list[ObservationReport] = []

    def show(self, reports: list[ObservationReport]) -> None:
        """Replace the rows."""
        if reports == self.reports:
            return
        if [one.observation for one in reports] == [one.observation for one in self.reports]:
            self.reports = reports
            self.dataChanged.emit(self.index(0), self.index(len(reports) - 1))
            return
        self.beginResetModel()
        self.reports = reports
        known = {one.observation for one in reports}
        self._icons = {number: icon for number, icon in self._icons.items() if number in known}
        self.endResetModel()

    def row_of(self, number: int) -> int | None:
        """Return the row of an observation, None when it is not shown."""
        return next((row for row, one in enumerate(self.reports) if one.observation == number), None)

    def picture_came(self, number: int) -> None:
        """Show the picture made of an observation's image."""
        row = self.row_of(number)
        if row is not None:
            self.dataChanged.emit(self.index(row), self.index(row))

    def rowCount(self, parent: QModelIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self.reports)

    def data(self, index: QModelIndex, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        one = self.reports[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return observation_text(one)
        if role == Qt.ItemDataRole.DecorationRole:
            return self._icon(one)
        if role == Qt.ItemDataRole.ToolTipRole:
            return tr(
                "Observation {number} at {x:.2f}, {y:.2f} m; double click goes there",
                number=one.observation,
                x=one.x,
                y=one.y,
            )
        return one.observation if role == NUMBER else None

    def _icon(self, one: ObservationReport) -> QIcon:
        number = one.observation
        file = self._thumbnails.file(number)
        if not file:
            return _patch(one.state.value)
        if number not in self._icons:
            self._icons[number] = QIcon(file)
        return self._icons[number]


def observation_text(one: ObservationReport) -> str:
    """Return two lines of text on an observation."""
    kind = tr("image") if one.media_type else one.semantics or one.label or tr("object")
    if one.doubts is not None:
        kind = tr("not there any more: {what}", what=one.label or one.doubts)
    state = STATES[one.state]
    if one.reviewed_by:
        state = tr("{state} by {by}", state=state, by=one.reviewed_by)
    return f"{one.object} · {kind}\n{one.robot}, {time_of_day(one.received_at)} · {state}"


def _patch(state: str) -> QIcon:
    picture = QPixmap(ICON)
    picture.fill(QColor(*(int(part) for part in COLOURS[state].split(","))))
    return QIcon(picture)
