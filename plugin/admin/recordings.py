"""Recordings that links play on the map: on and on, paused, at another speed, from another place."""

from __future__ import annotations

from typing import Any

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import Qt, QTimer
from qgis.PyQt.QtGui import QHideEvent, QShowEvent
from qgis.PyQt.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.administration import PlaybackReport, SetPlayback
from ..control.fleet_controller import FleetController
from ..gateway_client.connection_status import ConnectionPhase
from ..help import RECORDINGS, show_help
from ..panel.connection_panel import ConnectionMenu
from ..ui.dialogs import WrappingLabel
from ..ui.language import tr
from .supervisor_dialog import DialogAction, PendingQueries

REPLAY = "replay"
"""The kind of links that play recordings."""
ASK_EVERY_MS = 1000
SLOWEST, FASTEST = 0.1, 1000.0
"""times the speed at which it was recorded."""


class RecordingsDialog(QDialog):
    """How the recording of one link is played. What is changed goes to the gateway at once."""

    def __init__(self, desk: FleetController, parent: QWidget):
        super().__init__(parent)
        self.setObjectName("fleet_recordings_dialog")
        self.setWindowTitle(tr("Recordings on the map"))
        self._desk = desk
        self._asking = PendingQueries(desk.orders, self)
        self._link = QComboBox()
        self._link.setObjectName("fleet_recordings_link")
        self._place = QSlider(Qt.Orientation.Horizontal)
        self._place.setObjectName("fleet_recordings_place")
        self._place.setPageStep(10)
        self._seconds = _seconds_field()
        self._speed = _speed_field()
        self._paused = QCheckBox(tr("&Paused"))
        self._paused.setObjectName("fleet_recordings_paused")
        self._loop = QCheckBox(tr("From the &beginning again at its end"))
        self._loop.setObjectName("fleet_recordings_loop")
        self.status = WrappingLabel(lines=2)
        self.status.setObjectName("fleet_recordings_said")
        self._timer = QTimer(self)
        self._timer.setInterval(ASK_EVERY_MS)
        self._timer.timeout.connect(self._look)
        self._lay_out()
        self._link.activated.connect(self._look)
        self._place.sliderReleased.connect(lambda: self._change(place_s=float(self._place.value())))
        self._place.actionTriggered.connect(self._step)
        self._seconds.editingFinished.connect(self._apply)
        self._speed.editingFinished.connect(self._apply)
        self._paused.clicked.connect(lambda on: self._change(paused=on))
        self._loop.clicked.connect(lambda on: self._change(loop=on))
        self._asking.refused.connect(lambda why: self.status.setText(f"✘ {why}"))
        self._numbers: dict[str, float] = {}
        """Place and speed as reported or sent last."""

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._timer.start()
        self._look()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._timer.stop()

    def _look(self, *_: object) -> None:
        """Ask how the recording is played now, or say why there is nothing to ask."""
        names = [one.link for one in self._desk.state.links.links if one.kind == REPLAY and one.up]
        if names != [self._link.itemText(row) for row in range(self._link.count())]:
            chosen = self._link.currentText()
            self._link.clear()
            self._link.addItems(names)
            self._link.setCurrentIndex(max(names.index(chosen) if chosen in names else 0, 0))
        connected = self._desk.state.link.phase is ConnectionPhase.CONNECTED
        for field in (self._place, self._seconds, self._speed, self._paused, self._loop):
            field.setEnabled(connected and bool(names))
        if not connected:
            self.status.setText(tr("The desk is not connected to a gateway. Press Connect first."))
        elif not names:
            self.status.setText(tr("No link plays a recording at this gateway."))
        else:
            self._change()

    def _change(self, **change: Any) -> None:
        name = self._link.currentText()
        words = tr("Recording of {link}", link=name)
        self._numbers.update({key: value for key, value in change.items() if key in self._numbers})
        self._asking.ask(SetPlayback(name, **change), words, self._show)

    def _apply(self) -> None:
        """Send the numbers that were typed, as far as they are others than those reported or sent last."""
        typed = {"place_s": self._seconds.value(), "speed": self._speed.value()}
        if change := {
            name: value for name, value in typed.items() if value != self._numbers.get(name, value)
        }:
            self._change(**change)

    def _step(self, action: int) -> None:
        # By a key or a click beside the handle; while that is dragged its end counts.
        if (
            not self._place.isSliderDown()
            and QSlider.SliderAction(action) != QSlider.SliderAction.SliderNoAction
        ):
            self._change(place_s=float(self._place.sliderPosition()))

    def _show(self, result: dict[str, Any]) -> None:
        names = PlaybackReport.__dataclass_fields__
        report = PlaybackReport(**{name: result[name] for name in names})
        self._numbers = {"place_s": round(report.place_s, 1), "speed": report.speed}
        self._place.setMaximum(int(report.length_s))
        self._seconds.setMaximum(report.length_s)
        if not self._place.isSliderDown():
            self._place.setValue(int(report.place_s))
        for field, value in ((self._seconds, report.place_s), (self._speed, report.speed)):
            if not field.hasFocus():
                field.setValue(value)
        self._paused.setChecked(report.paused)
        self._loop.setChecked(report.loop)
        self.status.setText(
            tr(
                "{file}: {place} s of {length} s",
                file=report.file,
                place=f"{report.place_s:.0f}",
                length=f"{report.length_s:.0f}",
            )
        )

    def _lay_out(self) -> None:
        place = QHBoxLayout()
        place.addWidget(self._place, 1)
        place.addWidget(self._seconds)
        form = QFormLayout()
        form.addRow(tr("&Link"), self._link)
        # A row of two fields has no key of its own.
        label = QLabel(tr("Pl&ace"))
        label.setBuddy(self._place)
        form.addRow(label, place)
        form.addRow(tr("&Speed"), self._speed)
        form.addRow("", self._paused)
        form.addRow("", self._loop)
        standard = QDialogButtonBox.StandardButton
        foot = QDialogButtonBox(standard.Apply | standard.Close | standard.Help)
        foot.button(standard.Apply).clicked.connect(self._apply)
        foot.rejected.connect(self.reject)
        foot.helpRequested.connect(lambda: show_help(RECORDINGS, self))
        rows = QVBoxLayout(self)
        rows.addLayout(form)
        rows.addWidget(self.status)
        rows.addWidget(foot)
        # Enter ends the typing of a number, and closes nothing.
        foot.button(standard.Apply).setDefault(True)
        self.resize(520, self.sizeHint().height())


class RecordingsAction(DialogAction):
    """The menu entry and its window."""

    def __init__(self, iface: QgisInterface, menu: str, connections: ConnectionMenu, desk: FleetController):
        super().__init__(
            iface,
            menu,
            connections,
            lambda: RecordingsDialog(desk, iface.mainWindow()),
            icon="replay.svg",
            text=tr("Recordings…"),
            name="fleet_recordings",
            tip=tr("Recordings that links play on the map: pause, speed, place"),
        )


def _seconds_field() -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setObjectName("fleet_recordings_seconds")
    field.setDecimals(1)
    field.setSuffix(tr(" s"))
    field.setKeyboardTracking(False)
    field.setAccessibleName(tr("Seconds after the beginning"))
    return field


def _speed_field() -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setObjectName("fleet_recordings_speed")
    field.setRange(SLOWEST, FASTEST)
    field.setDecimals(1)
    field.setPrefix("×")
    field.setKeyboardTracking(False)
    return field
