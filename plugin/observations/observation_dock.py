"""The panel of observations with the review form, and its menu entry."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QModelIndex, QSize, Qt, QTimer, QUrl, pyqtSignal
from qgis.PyQt.QtGui import QPixmap
from qgis.PyQt.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListView,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.records import ObservationReport, ReviewObservation
from ..control.fleet_controller import FleetController
from ..control.messages import observation_topic
from ..gateway_client.report_caches import is_pending
from ..map.overlay.scene import show_places
from ..ui.actions import ActionDock, DockAction
from ..ui.dialogs import push_button
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.steady_widgets import ElidedText, ScrollingText
from . import observation_views

WORDS = ("traffic cone", "barrier", "bin", "bench", "column", "vehicle", "object")
"""Offered besides robots' own words; anything may be entered. In English: robots read them on their maps."""
PICTURE = QSize(104, 110)
"""Greatest size of a picture in pixels, beside the fields and no higher than they are."""


STANDS = tr("It stands there: draw it on the maps that robots get from now on")
DRAWN_NOWHERE = tr("Draw it on no map")
GONE = tr("It is gone: leave it out of the maps that robots get from now on")
STAYS = tr("It is there: leave it on the maps")


class ReviewForm(QWidget):
    """Shows one observation and asks for its review: ``requested`` has the request, ``shown`` its place."""

    requested = pyqtSignal(object)
    place_requested = pyqtSignal(int)

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self._report: ObservationReport | None = None
        self.about = ScrollingText("fleet_observation_about", lines=3)
        self.picture = QLabel()
        self.picture.setObjectName("fleet_observation_picture")
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        # Reserved even without a picture: the panel would be made wider by the first one.
        self.picture.setFixedSize(PICTURE)
        self.semantics = QComboBox()
        self.semantics.setObjectName("fleet_observation_semantics")
        self.semantics.setEditable(True)
        self.semantics.lineEdit().setMaxLength(ReviewObservation.texts["semantics"])
        self.height_m = _metres("fleet_observation_height", 1000.0)
        self.radius = _metres("fleet_observation_radius", 50.0)
        self.reason = QLineEdit()
        self.reason.setObjectName("fleet_observation_reason")
        self.reason.setMaxLength(ReviewObservation.texts["reason"])
        self.reason.setPlaceholderText(tr("optional"))
        self.go = push_button("fleet_observation_go", tr("Show"), tr("Go to it on the map"))
        self.accept = push_button("fleet_observation_accept", tr("Accept"), "")
        self.reject = push_button("fleet_observation_reject", tr("Reject"), "")
        self._lay_out()
        self.go.clicked.connect(lambda: self._report and self.place_requested.emit(self._report.observation))
        self.accept.clicked.connect(lambda: self._want(accept=True))
        self.reject.clicked.connect(lambda: self._want(accept=False))
        self.show_report(None, (), pending=False)

    def show_report(self, report: ObservationReport | None, words: Iterable[str], *, pending: bool) -> None:
        """Show ``report``; ``words`` are offered as names, ``pending`` while a review is being sent.

        The operator's entries stay for as long as it is the same observation in the same state.
        """
        same = (report and (report.observation, report.state)) == (
            self._report and (self._report.observation, self._report.state)
        )
        self._report = report
        is_object = report is not None and _is_drawn(report)
        is_doubt = report is not None and report.doubts is not None
        self.accept.setToolTip(GONE if is_doubt else STANDS)
        self.reject.setToolTip(STAYS if is_doubt else DRAWN_NOWHERE)
        for field in (self.semantics, self.height_m, self.radius):
            field.setEnabled(is_object)
        self.reason.setEnabled(report is not None)
        for button in (self.accept, self.reject):
            button.setEnabled(report is not None and not pending)
        self.go.setEnabled(report is not None)
        self.about.setText("" if report is None else _about(report))
        if same:
            return
        self.semantics.clear()
        self.semantics.addItems(list(dict.fromkeys([*words, *WORDS])))
        self.semantics.setEditText(((report.semantics or report.label) if report else "") or "")
        self.height_m.setValue((report.height if report else None) or 0.0)
        self.radius.setValue((report.radius if report else None) or 0.0)
        self.reason.setText((report.reason if report else "") or "")

    def show_picture(self, file: str) -> None:
        """Show the picture in ``file``, none where that is empty; the tool tip has it in full size."""
        picture = QPixmap(file) if file else QPixmap()
        if not picture.isNull():
            picture = picture.scaled(
                PICTURE, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            )
        self.picture.setPixmap(picture)
        self.picture.setToolTip(f'<img src="{QUrl.fromLocalFile(file).toString()}">' if file else "")

    def request(self, *, accept: bool) -> ReviewObservation | None:
        """Return the review in the form, None without an observation."""
        report = self._report
        if report is None:
            return None
        details = {}
        if accept and _is_drawn(report):
            details = {
                "semantics": self.semantics.currentText().strip() or None,
                "height": self.height_m.value() or None,
                "radius": self.radius.value() or None,
            }
        reason = self.reason.text().strip() or None
        return ReviewObservation(
            report.observation, accept, reason=reason, revise=not is_pending(report), **details
        )

    def _want(self, *, accept: bool) -> None:
        request = self.request(accept=accept)
        if request is not None:
            self.requested.emit(request)

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.setContentsMargins(0, 0, 0, 0)
        form.addRow(tr("It is a"), self.semantics)
        form.addRow(tr("Height"), self.height_m)
        form.addRow(tr("Radius"), self.radius)
        form.addRow(tr("Reason"), self.reason)
        top = QHBoxLayout()
        top.addWidget(self.picture)
        top.addLayout(form, 1)
        buttons = QHBoxLayout()
        for button in (self.go, self.accept, self.reject):
            buttons.addWidget(button, 1)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(self.about)
        rows.addLayout(top)
        rows.addLayout(buttons)


def _is_drawn(report: ObservationReport) -> bool:
    """Return whether it is drawn when it is accepted: neither an image, nor a missing object."""
    return report.media_type is None and report.doubts is None


def _about(report: ObservationReport) -> str:
    facts = {"object": report.object, "robot": report.robot, "x": report.x, "y": report.y}
    if report.doubts is not None:
        text = tr(
            "Not there any more? {robot} looks through {what} ({source}) of its map again and again, "
            "at {x:.2f}, {y:.2f} m.",
            **facts,
            what=report.label or tr("object"),
            source=report.doubts,
        )
    elif report.media_type:
        text = tr("An image of {object}, told by {robot}, at {x:.2f}, {y:.2f} m.", **facts)
    else:
        text = tr("An object: {object}, told by {robot}, at {x:.2f}, {y:.2f} m.", **facts)
    return f"{text} {_state_in_words(report)}"


def _state_in_words(report: ObservationReport) -> str:
    if is_pending(report):
        return tr("Look at it: is it of use?") if report.media_type else tr("It waits for your review.")
    state = observation_views.STATES[report.state]
    if report.reviewed_by:
        return tr(
            "State: {state}, by {by}. A new review takes the place of that.",
            state=state,
            by=report.reviewed_by,
        )
    return tr("State: {state}. A new review takes the place of that.", state=state)


def _metres(name: str, largest: float) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setObjectName(name)
    box.setRange(0.0, largest)
    box.setDecimals(2)
    box.setSingleStep(0.05)
    box.setSuffix(" m")
    box.setSpecialValueText(tr("not known"))
    return box


SHOW_AFTER_MS = 250
"""Delay by which reports of many robots are shown together."""
AROUND = 15.0
"""Metres around an observation that are shown with it."""

ROWS = 3
"""Least number of observations visible at once."""


class ObservationDock(ActionDock):
    """Updates list, form and layer; :meth:`remove` undoes what it did elsewhere."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(tr("Observations"), "fleet_observation_dock", parent)
        self._desk = desk
        # Even while it is closed observations get a layer, and a number in the panel's title.
        self.thumbnails = observation_views.Thumbnails(self)
        self.feed = observation_views.ObservationFeed(desk, self.thumbnails, self)
        desk.state.observations_changed.connect(self.build)

    def _build(self) -> None:
        desk = self._desk
        self.layer = observation_views.ObservationLayer(desk.project, self.thumbnails)
        self.model = observation_views.ObservationModel(self.thumbnails, self)
        self.head = ElidedText("fleet_observation_head")
        self.reviewed = QCheckBox(tr("Show reviewed ones, too"))
        self.reviewed.setObjectName("fleet_observation_reviewed")
        self.list = QListView()
        self.list.setObjectName("fleet_observation_list")
        self.list.setModel(self.model)
        self.list.setIconSize(observation_views.ICON)
        self.list.setUniformItemSizes(True)
        self.list.setMinimumHeight(ROWS * observation_views.ICON.height())
        self.form = ReviewForm()
        self._lay_out()
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.refresh)
        self._wire()
        self.refresh()

    def remove(self) -> None:
        super().remove()
        self.thumbnails.remove()

    def _remove_parts(self) -> None:
        self._timer.stop()
        self.layer.remove()

    def refresh(self) -> None:
        """Show the current observations."""
        chosen = self.chosen
        cache = self._desk.state.observations
        everything = self.reviewed.isChecked()
        self.model.show(
            [one for one in cache.ordered() if everything or is_pending(one) or one.observation == chosen]
        )
        if chosen is not None:
            self.choose(chosen)
        waiting = cache.pending
        if not len(cache):
            text = tr("No robot has told of an object or image yet.")
        else:
            text = tr("{waiting} to be reviewed", waiting=waiting) if waiting else tr("All are reviewed.")
        self.head.setText(text)
        self.setWindowTitle(
            tr("Observations ({waiting})", waiting=waiting) if waiting else tr("Observations")
        )
        self.layer.show(cache, self._desk.state.site)
        self._show_chosen()

    @property
    def chosen(self) -> int | None:
        """The number of the selected observation, None for none."""
        index = self.list.currentIndex()
        return index.data(observation_views.NUMBER) if index.isValid() else None

    def choose(self, number: int) -> None:
        """Select an observation, if it is in the list."""
        row = self.model.row_of(number)
        if row is not None:
            self.list.setCurrentIndex(self.model.index(row))

    def show_on_map(self, number: int) -> None:
        """Show the place of an observation on the map."""
        report = self._desk.state.observations.get(number)
        if report is None:
            return
        x, y = report.x, report.y
        around = np.array([(x - AROUND, y - AROUND), (x + AROUND, y + AROUND)])
        try:
            show_places(self._desk.canvas, self._desk.site_to_canvas.transform().to_map(around))
        except FleetError as error:
            self._desk.warning.emit(str(error))

    def _wire(self) -> None:
        self._desk.state.observations_changed.connect(self._refresh_later)
        self._desk.state.site_changed.connect(lambda: self._timer.start(0))
        self.thumbnails.made.connect(self.model.picture_came)
        self.thumbnails.made.connect(self._refresh_later)
        self.reviewed.toggled.connect(self.refresh)
        self.list.selectionModel().currentChanged.connect(lambda *_: self._show_chosen())
        self.list.doubleClicked.connect(lambda index: self.show_on_map(index.data(observation_views.NUMBER)))
        self.form.place_requested.connect(self.show_on_map)
        self.form.requested.connect(self._review)
        self.feed.reviewed.connect(self._reviewed)
        self.feed.refused.connect(self._refused)

    def _refresh_later(self, *_: object) -> None:
        if not self._timer.isActive():
            self._timer.start(SHOW_AFTER_MS)

    def _review(self, request: ReviewObservation) -> None:
        topic = observation_topic(request.observation)
        self._desk.messages.end(topic)
        try:
            self.feed.review(request)
        except FleetError as error:
            text = tr(
                "Observation {observation} was NOT reviewed: {error}",
                observation=request.observation,
                error=error,
            )
            self._desk.report_failure(text, topic)
        self._show_chosen()

    def _reviewed(self, number: int) -> None:
        # The reviewed one is done: continue with the next one pending.
        if number == self.chosen and not self.reviewed.isChecked():
            row = self.list.currentIndex().row()
            others = [*self.model.reports[row + 1 :], *reversed(self.model.reports[:row])]
            following = next((one.observation for one in others if is_pending(one)), None)
            self.list.setCurrentIndex(QModelIndex())
            if following is not None:
                self.choose(following)
        self.refresh()

    def _refused(self, number: int, why: str) -> None:
        text = tr("Observation {number} was not reviewed: {why}", number=number, why=why)
        self._desk.report_failure(text, observation_topic(number))
        self._show_chosen()

    def _show_chosen(self) -> None:
        number = self.chosen
        report = None if number is None else self._desk.state.observations.get(number)
        words = [one.label for one in self._desk.state.observations if one.label][-20:]
        self.form.show_report(report, words, pending=number is not None and self.feed.awaits_answer(number))
        file = "" if report is None else self._picture_of(report)
        self.form.show_picture(file)

    def _picture_of(self, report: ObservationReport) -> str:
        """Return the picture of an observation, or of the newest image of the same object."""
        same = [
            one
            for one in self._desk.state.observations
            if (one.robot, one.object) == (report.robot, report.object)
        ]
        numbers = [report.observation, *sorted((one.observation for one in same), reverse=True)]
        return next((file for file in map(self.thumbnails.file, numbers) if file), "")

    def _lay_out(self) -> None:
        body = QWidget()
        rows = QVBoxLayout(body)
        rows.setContentsMargins(8, 6, 8, 8)
        rows.addWidget(self.head)
        rows.addWidget(self.list, 1)
        rows.addWidget(self.reviewed)
        rows.addWidget(self.form)
        self.setWidget(body)
        self.setFocusProxy(self.list)
        self.list.setFocusPolicy(Qt.FocusPolicy.StrongFocus)


class ObservationsAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: FleetController):
        super().__init__(
            iface,
            menu,
            ObservationDock(desk, iface.mainWindow()),
            icon="observations.svg",
            text=tr("Observations"),
            name="fleet_observations",
            tip=tr("Objects and images that robots told of, to be accepted for the maps or rejected"),
        )
