"""Decisions of supervisors while the fleet runs: the site served, recordings played, robots removed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QHideEvent, QIcon, QKeySequence, QShowEvent
from qgis.PyQt.QtWidgets import (
    QAction,
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QMessageBox,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages import administration
from ...robot_bridge.core.messages.administration import sites_report
from ...robot_bridge.core.messages.links import PlaybackReport, SetPlayback
from ...robot_bridge.core.messages.safety import RobotState
from ..control.fleet_controller import FleetController
from ..gateway_client.connection_status import ConnectionPhase
from ..gateway_client.state_words import part_in_words
from ..help import RECORDINGS, SITES, show_help
from ..panel.connection_panel import ConnectionMenu
from ..panel.robot_table import RobotTableView
from ..ui.actions import ICONS
from ..ui.dialogs import QuestionDialog, WrappingLabel, confirm
from ..ui.language import first_of, tr, tr_count
from ..ui.tables import TextModel
from .supervisor_dialog import DialogAction, PendingQueries, SupervisorDialog, fit_columns, why_not

# --- Choice of the published site that is served ---

SITE_COLUMNS = (tr("Site"), tr("Folder"), tr("Version"), tr("State"))
SERVED = tr("served now")
READY = tr("can be chosen")


class SiteModel(TextModel):
    """One row for each site."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(SITE_COLUMNS, site_cells, parent)


def site_cells(offer: administration.SiteOffer) -> tuple[str, ...]:
    """Return the texts of a site in the columns."""
    version = "–" if offer.version is None else str(offer.version)
    return offer.name or "–", offer.site, version, state_in_words(offer)


def state_in_words(offer: administration.SiteOffer) -> str:
    """Return whether a site is served, or can be, or why not."""
    return SERVED if offer.served else offer.refusal or READY


def confirm_site_choice(
    offer: administration.SiteOffer, parent: QWidget, then: Callable[[], object]
) -> QMessageBox:
    """Show the consequences of serving a site for robots; ``then`` is called when confirmed."""
    name = offer.name or offer.site
    texts = (
        tr(
            "Every robot is sent the map of {site} ({folder}), every desk shows it, and it is served "
            "until another one is chosen, also by a gateway that is started anew.",
            site=name,
            folder=offer.site,
        ),
        tr(
            "No robot is stopped: commands and queues go on in the same metres, whatever roads and "
            "keepouts the new site has there. Stop robots first where that matters."
        ),
    )
    yes = ("fleet_site_confirm", tr("Serve this site"))
    box = confirm(parent, "fleet_site_question", "\n\n".join(texts), yes, tr("Cancel"), then)
    box.setWindowTitle(tr("Serve {site}?", site=name))
    box.setTextFormat(Qt.TextFormat.PlainText)
    return box


SITE_LIST = tr("Sites")
WIDEST_SITE = ("0" * 24, "sample_site_00", "0000", READY)


class SiteChoiceDialog(SupervisorDialog):
    """A row for each site."""

    def __init__(self, desk: FleetController, parent: QWidget):
        super().__init__(desk, SiteModel(), "fleet_sites_dialog", tr("Which site is served"), SITES, parent)
        self._button("fleet_site_serve", tr("&Serve this site…"), self._choose, for_row=True)
        self._button("fleet_sites_refresh", tr("Re&fresh"), self.refresh, for_row=False)
        fit_columns(self.view, WIDEST_SITE)
        # The reason why a site cannot be chosen takes several lines.
        self.view.setWordWrap(True)
        self.view.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        desk.state.site_changed.connect(self._site_changed)
        self._lay_out()

    def _ask_rows(self) -> None:
        self._listing.ask(administration.GetSites(), SITE_LIST, self._receive_sites)

    def _key(self, row: administration.SiteOffer) -> str:
        return row.site

    def _can_change(self, row: administration.SiteOffer) -> bool:
        return not row.served and row.refusal is None

    def _receive_sites(self, result: dict[str, Any]) -> None:
        offers = sites_report(result).sites
        self._show_rows(offers)
        self._show_once_known(tr_count(len(offers), "1 site", "%n sites"))

    def _choose(self) -> None:
        offer = self.selected()
        self._open(confirm_site_choice(offer, self, lambda: self._serve(offer)))

    def _serve(self, offer: administration.SiteOffer) -> None:
        name = offer.name or offer.site
        self._ask(
            administration.ChooseSite(offer.site),
            tr("Serve {site}", site=name),
            lambda _result: self._changed(tr("{site} is served now.", site=name)),
        )

    def _site_changed(self) -> None:
        # Also when another supervisor chose.
        if self.isVisible() and self._desk.state.site is not None:
            self._ask_rows()


class SiteChoiceAction(DialogAction):
    """The menu entry and its window."""

    def __init__(self, iface: QgisInterface, menu: str, connections: ConnectionMenu, desk: FleetController):
        super().__init__(
            iface,
            menu,
            connections,
            lambda: SiteChoiceDialog(desk, iface.mainWindow()),
            icon="sites.svg",
            text=tr("Site…"),
            name="fleet_site_choice",
            tip=tr("Which of the published sites the gateway serves; takes a supervisor"),
        )


# --- Recordings that links play: in a loop, paused, at another speed, from another position ---

REPLAY = "replay"
"""The kind of links that play recordings."""
ASK_EVERY_MS = 1000
SLOWEST, FASTEST = 0.1, 1000.0
"""Factors of the speed at which it was recorded."""


class RecordingsDialog(QDialog):
    """Playback of the recording of one link. Changes are sent to the gateway at once."""

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
        self._timer.timeout.connect(self._query)
        self._lay_out()
        self._link.activated.connect(self._query)
        self._place.sliderReleased.connect(lambda: self._change(place_s=float(self._place.value())))
        self._place.actionTriggered.connect(self._step)
        self._seconds.editingFinished.connect(self._apply)
        self._speed.editingFinished.connect(self._apply)
        self._paused.clicked.connect(lambda on: self._change(paused=on))
        self._loop.clicked.connect(lambda on: self._change(loop=on))
        self._asking.refused.connect(lambda why: self.status.setText(f"✘ {why}"))
        self._numbers: dict[str, float] = {}
        """Position and speed as reported or sent last."""

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._timer.start()
        self._query()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._timer.stop()

    def _query(self, *_: object) -> None:
        """Query the playback of the recording, or show why there is none to query."""
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
        """Send the numbers that were typed, where they differ from those reported or sent last."""
        typed = {"place_s": self._seconds.value(), "speed": self._speed.value()}
        if change := {
            name: value for name, value in typed.items() if value != self._numbers.get(name, value)
        }:
            self._change(**change)

    def _step(self, action: int) -> None:
        # By a key or a click beside the handle; while that is dragged only its release counts.
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
        # A row of two fields has no access key of its own.
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


# --- Removal of robots that are gone from every desk: choice, confirmation, outcome ---

GONE = (RobotState.LOST, RobotState.OFFLINE)
LONGEST_REASON = 200
MOST_NAMES = 8
NAME_LINES = 3
"""Lines reserved in the dialog for names, so that another choice moves no button."""


class RemovalDialog(QuestionDialog):
    """Asks which robots to remove, ``selected`` ones or ``all_gone``, and why; Enter removes none."""

    confirmed = pyqtSignal(list, str)
    """The names of the robots, and the reason."""

    def __init__(self, selected: Sequence[str], all_gone: Sequence[str], parent: QWidget):
        super().__init__(
            "fleet_removal",
            tr("Remove robots that are gone?"),
            ("fleet_removal_confirm", tr("Remove")),
            is_safe=True,
            parent=parent,
        )
        chosen = tr_count(len(selected), "the selected one", "the %n selected ones")
        everyone = tr_count(
            len(all_gone), "the only one that is lost or offline", "all %n that are lost or offline"
        )
        choices = [(chosen, list(selected))] if selected else []
        self._which = self.add_choice(
            tr("&Robots"), [*choices, (everyone, list(all_gone))], "fleet_removal_which"
        )
        self._names = self.add_text(" ", lines=NAME_LINES)
        self._names.setObjectName("fleet_removal_names")
        self._which.currentIndexChanged.connect(self._name_them)
        self._name_them()
        self.add_text(
            tr(
                "They go from every desk. What is in their queues is removed, what they were told and have "
                "not done has failed; what they did stays stored."
            )
        )
        self.add_text(
            tr(
                "None is stopped by that. One that comes back is told to abort what it still does, and is a "
                "new robot."
            )
        )
        self._why = self.add_reason(tr("Why, for the log"), LONGEST_REASON, "fleet_removal_reason")
        self.lay_out()
        self.accepted.connect(
            lambda: self.confirmed.emit(self._which.currentData(), self._why.text().strip())
        )

    def _name_them(self, *_: object) -> None:
        self._names.setText(_in_words(self._which.currentData()))


class RobotRemoval:
    """An entry of ``menu``, of ``connections`` and of the robots' table. :meth:`remove` undoes the
    constructor.
    """

    def __init__(
        self,
        iface: QgisInterface,
        menu: str,
        connections: ConnectionMenu,
        desk: FleetController,
        table: RobotTableView,
    ):
        self._iface, self._menu, self._connections = iface, menu, connections
        self._desk, self._table = desk, table
        self._asking = PendingQueries(desk.orders, table)
        self._asking.refused.connect(desk.failed)
        self._question: RemovalDialog | None = None
        """The dialog that is open."""
        self.action = QAction(
            QIcon(str(ICONS / "remove_robots.svg")), tr("Remove robots…"), iface.mainWindow()
        )
        self.action.setObjectName("fleet_remove_robots")
        self.action.setToolTip(tr("Take robots that are lost or offline off every desk; takes a supervisor"))
        self.action.triggered.connect(self.ask)
        self._here = QAction(self.action.icon(), self.action.text(), table)
        self._here.setObjectName("fleet_remove_robots_here")
        self._here.setShortcut(QKeySequence(QKeySequence.StandardKey.Delete))
        self._here.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
        self._here.triggered.connect(self.ask)
        table.addAction(self._here)
        table.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        iface.addPluginToMenu(menu, self.action)
        connections.offer(self.action)

    def ask(self) -> None:
        """Ask which robots to remove, or show why none can be."""
        gone = self._gone()
        why = why_not(self._desk.state.link) or ("" if gone else tr("No robot is lost or offline."))
        if why:
            self._desk.warning.emit(tr("No robot was removed: {why}", why=why))
            return
        if part := part_in_words(self._desk.state.robots):
            self._desk.warning.emit(f"{part} {tr('Others cannot be chosen here.')}")
        chosen = set(self._desk.selection.robots)
        dialog = RemovalDialog([name for name in gone if name in chosen], gone, self._iface.mainWindow())
        dialog.confirmed.connect(self._remove)
        # Another fleet's robots of the same names are other ones.
        self._desk.state.forgotten.connect(dialog.reject)
        dialog.finished.connect(self._forget_question)
        self._question = dialog
        dialog.open()

    def remove(self) -> None:
        """Close the dialog, and remove the entries."""
        if self._question is not None:
            self._question.reject()
        self._table.setContextMenuPolicy(Qt.ContextMenuPolicy.DefaultContextMenu)
        self._table.removeAction(self._here)
        self._connections.withdraw(self.action)
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()

    def _forget_question(self) -> None:
        self._question = None

    def _gone(self) -> list[str]:
        views = self._desk.state.robots.views(self._desk.clock.steady())
        return [view.name for view in views if view.state in GONE]

    def _remove(self, robots: list[str], reason: str) -> None:
        words = tr("Remove {names}", names=_in_words(robots))
        self._asking.ask(administration.RemoveRobots(robots, reason or None), words, self._removed)

    def _removed(self, result: dict[str, Any]) -> None:
        removed, kept = result["removed"], result["kept"]
        text = tr_count(
            len(removed),
            "1 robot was removed: {names}",
            "%n robots were removed: {names}",
            names=_in_words(removed),
        )
        self._desk.info.emit(text)
        if kept:
            why = "; ".join(first_of([one["reason"] for one in kept]))
            self._desk.warning.emit(
                tr_count(
                    len(kept), "1 robot was not removed: {why}", "%n robots were not removed: {why}", why=why
                )
            )


def _in_words(names: Sequence[str]) -> str:
    return ", ".join(first_of(names, MOST_NAMES))
