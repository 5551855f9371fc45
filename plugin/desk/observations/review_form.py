"""What an operator makes of one observation: its word on the map, height, radius, and why."""

from __future__ import annotations

from collections.abc import Iterable

from qgis.PyQt.QtCore import QSize, Qt, QUrl, pyqtSignal
from qgis.PyQt.QtGui import QPixmap
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.messages import ObservationReport, ReviewObservation
from ...language import tr
from ..fixed_size import ScrollingText
from ..observation_book import is_pending
from ..push_button import push_button
from .observation_layer import STATES

WORDS = ("traffic cone", "barrier", "bin", "bench", "column", "vehicle", "object")
"""Offered besides what robots said; anything may be written. In English: robots read them on their maps."""
PICTURE = QSize(104, 110)
"""Pixels that a picture fills at most, beside the fields and no higher than they are."""


STANDS = tr("It stands there: draw it on the maps that robots get from now on")
DRAWN_NOWHERE = tr("Draw it on no map")
GONE = tr("It is gone: leave it out of the maps that robots get from now on")
STAYS = tr("It is there: leave it on the maps")


class ReviewForm(QWidget):
    """Shows one observation and asks for its review: ``wanted`` has the request, ``shown`` its place."""

    wanted = pyqtSignal(object)
    place_wanted = pyqtSignal(int)

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self._report: ObservationReport | None = None
        self.about = ScrollingText("fleet_observation_about", lines=3)
        self.picture = QLabel()
        self.picture.setObjectName("fleet_observation_picture")
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        # Kept free where there is none: the panel would be made wider by the first one that is looked at.
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
        self.go.clicked.connect(lambda: self._report and self.place_wanted.emit(self._report.observation))
        self.accept.clicked.connect(lambda: self._want(accept=True))
        self.reject.clicked.connect(lambda: self._want(accept=False))
        self.show_report(None, (), asked=False)

    def show_report(self, report: ObservationReport | None, words: Iterable[str], *, asked: bool) -> None:
        """Show ``report``; ``words`` are offered for what it is, ``asked`` while a review is on its way.

        What the operator has written stays for as long as it is the same observation in the same state.
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
            button.setEnabled(report is not None and not asked)
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
        """Show the picture in ``file``, none where that is empty; the tool tip has it as large as it is."""
        picture = QPixmap(file) if file else QPixmap()
        if not picture.isNull():
            picture = picture.scaled(
                PICTURE, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            )
        self.picture.setPixmap(picture)
        self.picture.setToolTip(f'<img src="{QUrl.fromLocalFile(file).toString()}">' if file else "")

    def request(self, *, accept: bool) -> ReviewObservation | None:
        """Return the review as it stands in the form, None without an observation."""
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
            self.wanted.emit(request)

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
    """Tell whether it is drawn when it is accepted: it is no image, and nothing that is missing."""
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
    state = STATES[report.state]
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
