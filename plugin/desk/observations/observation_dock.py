"""The panel of observations: what robots saw, and its review."""

from __future__ import annotations

import numpy as np
from qgis.PyQt.QtCore import QModelIndex, Qt, QTimer
from qgis.PyQt.QtWidgets import QCheckBox, QListView, QVBoxLayout, QWidget

from ....robot_bridge.messages import ObservationReport, ReviewObservation
from ...errors import FleetError
from ...language import tr
from ..desk import Desk
from ..dock_action import ActionDock
from ..fixed_size import ElidedText
from ..live.following import show_places
from ..messages import observation_topic
from ..observation_book import is_pending
from .observation_feed import ObservationFeed
from .observation_layer import ObservationLayer
from .observation_model import ICON, NUMBER, ObservationModel
from .review_form import ReviewForm
from .thumbnails import Thumbnails

SHOW_AFTER_MS = 250
"""News of a crowd of robots are shown together."""
AROUND = 15.0
"""Metres around an observation that are shown with it."""

ROWS = 3
"""Observations that are seen at once at least."""


class ObservationDock(ActionDock):
    """Keeps list, form and layer true to what is known; :meth:`remove` undoes what it did elsewhere."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(tr("Observations"), parent)
        self.setObjectName("fleet_observation_dock")
        self._desk = desk
        self.thumbnails = Thumbnails(self)
        self.feed = ObservationFeed(desk, self.thumbnails, self)
        self.layer = ObservationLayer(desk.project, self.thumbnails)
        self.model = ObservationModel(self.thumbnails, self)
        self.head = ElidedText("fleet_observation_head")
        self.reviewed = QCheckBox(tr("Show reviewed ones, too"))
        self.reviewed.setObjectName("fleet_observation_reviewed")
        self.list = QListView()
        self.list.setObjectName("fleet_observation_list")
        self.list.setModel(self.model)
        self.list.setIconSize(ICON)
        self.list.setUniformItemSizes(True)
        self.list.setMinimumHeight(ROWS * ICON.height())
        self.form = ReviewForm()
        self._lay_out()
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.refresh)
        self._wire()
        self.refresh()

    def remove(self) -> None:
        """Take the layer out of the project and delete the pictures."""
        self._timer.stop()
        self.layer.remove()
        self.thumbnails.remove()

    def refresh(self) -> None:
        """Show what is known now."""
        chosen = self.chosen
        book = self._desk.observations
        everything = self.reviewed.isChecked()
        self.model.show(
            [one for one in book.ordered() if everything or is_pending(one) or one.observation == chosen]
        )
        if chosen is not None:
            self.choose(chosen)
        waiting = book.pending
        if not len(book):
            text = tr("No robot has told of an object or image yet.")
        else:
            text = tr("{waiting} to be reviewed", waiting=waiting) if waiting else tr("All are reviewed.")
        self.head.setText(text)
        self.setWindowTitle(
            tr("Observations ({waiting})", waiting=waiting) if waiting else tr("Observations")
        )
        self.layer.show(book, self._desk.site)
        self._show_chosen()

    @property
    def chosen(self) -> int | None:
        """The number of the observation that is looked at, None for none."""
        index = self.list.currentIndex()
        return index.data(NUMBER) if index.isValid() else None

    def choose(self, number: int) -> None:
        """Look at an observation, if it is in the list."""
        row = self.model.row_of(number)
        if row is not None:
            self.list.setCurrentIndex(self.model.index(row))

    def go_to(self, number: int) -> None:
        """Show the place of an observation on the map."""
        report = self._desk.observations.get(number)
        if report is None:
            return
        x, y = report.x, report.y
        around = np.array([(x - AROUND, y - AROUND), (x + AROUND, y + AROUND)])
        try:
            show_places(self._desk.canvas, self._desk.placement().to_map(around))
        except FleetError as error:
            self._desk.complained.emit(str(error))

    def _wire(self) -> None:
        self._desk.observations_changed.connect(self._refresh_later)
        self._desk.site_changed.connect(lambda: self._timer.start(0))
        self.thumbnails.made.connect(self.model.picture_came)
        self.thumbnails.made.connect(self._refresh_later)
        self.reviewed.toggled.connect(self.refresh)
        self.list.selectionModel().currentChanged.connect(lambda *_: self._show_chosen())
        self.list.doubleClicked.connect(lambda index: self.go_to(index.data(NUMBER)))
        self.form.place_wanted.connect(self.go_to)
        self.form.wanted.connect(self._review)
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
        # What was looked at is done: on to the next that waits.
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
        report = None if number is None else self._desk.observations.get(number)
        words = [one.label for one in self._desk.observations if one.label][-20:]
        self.form.show_report(report, words, asked=number is not None and self.feed.is_asked(number))
        file = "" if report is None else self._picture_of(report)
        self.form.show_picture(file)

    def _picture_of(self, report: ObservationReport) -> str:
        """Return the picture of an observation, or of the newest image of the same object."""
        same = [
            one for one in self._desk.observations if (one.robot, one.object) == (report.robot, report.object)
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
