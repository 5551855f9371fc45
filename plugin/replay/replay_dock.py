"""The panel of the replay, and its menu entry."""

from __future__ import annotations

from qgis.core import QgsApplication
from qgis.gui import QgisInterface
from qgis.PyQt.QtWidgets import QComboBox, QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from ..control.fleet_controller import FleetController
from ..control.messages import REPLAY, SELECTION, Level, Topic
from ..ui.actions import ActionDock, DockAction
from ..ui.errors import FleetError
from ..ui.language import date_and_time, tr, tr_count
from ..ui.scheduling import ONE_STEP, CooperativeTask, Steps
from ..ui.steady_widgets import ScrollingText
from .history import NO_MARKS, CommandSorter, HistoryDownload, PastCommands
from .replay_map import ReplayLayer, ReplayMap
from .time_controls import SPEEDS, ReplayClock, TimeLine, TimeRangeForm

BANNER = "background: #7B1FA2; color: white; font-weight: bold; padding: 0px 6px;"

PLAY, PAUSE = "/temporal_navigation/forward.svg", "/temporal_navigation/pause.svg"


class ReplayDock(ActionDock):
    """Builds the parts. :meth:`remove` undoes what they did outside of it."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(tr("Replay"), "fleet_replay_dock", parent)
        self._desk = desk

    def _build(self) -> None:
        desk = self._desk
        self._status = ""
        self._showing = CooperativeTask(self, ONE_STEP)
        """Shows a history that has just arrived."""
        self._past = CommandSorter(desk.state.commands, self)
        self.fetching = HistoryDownload(desk.orders, self)
        self.clockwork = ReplayClock(desk.canvas, self)
        self.layer = ReplayLayer(desk.project, self)
        self.form = TimeRangeForm()
        self.map = ReplayMap(desk.canvas)
        self.map.setTemporalController(self.clockwork.controller)
        self.banner = ScrollingText("fleet_replay_banner", lines=3)
        self.banner.set_text_style(BANNER)
        self.line = TimeLine()
        self.play = QToolButton()
        self.play.setObjectName("fleet_replay_play")
        self._show_playing(False)
        self.play.setToolTip(tr("Play, or hold (Space)"))
        self.speed = QComboBox()
        self.speed.setObjectName("fleet_replay_speed")
        self.speed.setToolTip(tr("How much faster than it was"))
        self.speed.addItems([f"× {speed:g}" for speed in SPEEDS])
        self.speed.setCurrentIndex(SPEEDS.index(1))
        self._lay_out()
        self._wire()
        self._show_status(tr("Choose a time and press Load."))

    def _remove_parts(self) -> None:
        """Stop the clock, remove the layer from the project, disconnect from the live map."""
        self._showing.stop()
        self._past.forget()
        self.fetching.forget()
        self.clockwork.remove()
        self.layer.remove()
        self.map.remove()

    @property
    def is_busy(self) -> bool:
        """Whether a history is still being fetched or shown."""
        return any(part.is_busy for part in (self.fetching, self._showing, self._past, self.layer))

    def load(self) -> None:
        """Fetch the span in the form and show it."""
        since, until = self.form.stretch()
        self._desk.messages.end(REPLAY)
        if self._desk.state.site is None:
            self._warn(tr("There is nothing to replay yet. Connect to a gateway first."))
            return
        if until <= since:
            self._warn(tr("The replay's time ends before it begins. Correct one of the two."))
            return
        robots = list(self._desk.selection.robots) if self.form.selected.isChecked() else []
        if self.form.selected.isChecked() and not robots:
            text = tr("No robot is selected to be replayed. Select one, or replay all.")
            self._warn(text, SELECTION)
            return
        try:
            self.fetching.begin(since, until, robots)
        except FleetError as error:
            self._desk.report_failure(tr("The replay was not loaded: {error}", error=error), REPLAY)
            return
        self._robots = robots
        self._showing.stop()
        self._past.renew()
        self.layer.clear()
        self.map.begin(self._desk.state.site)
        self.line.show_time(since, until)
        self.clockwork.show(since, until)
        self.form.show_busy(True)
        self._show_status(tr("Loading …"))

    def _wire(self) -> None:
        self.form.requested.connect(self.load)
        self.form.stop_requested.connect(self.fetching.stop)
        self.fetching.progressed.connect(self._progressed)
        self.fetching.ended.connect(self._ended)
        self.layer.failed.connect(self._warn)
        self.layer.changed.connect(self.map.follow)
        self.line.requested.connect(self.clockwork.seek)
        self.clockwork.moved.connect(self._show)
        self.line.play_requested.connect(self._play_or_hold)
        self.clockwork.playing_changed.connect(self._show_playing)
        self.play.clicked.connect(self._play_or_hold)
        self.speed.currentIndexChanged.connect(lambda k: self.clockwork.set_speed(SPEEDS[k]))
        self._desk.state.commands_changed.connect(self._commands_changed)
        self._past.done.connect(self._show_commands)
        self._desk.state.site_changed.connect(self._site_changed)
        self._robots: list[str] = []
        self._generation = self._desk.state.robots.generation

    def _play_or_hold(self, *_: object) -> None:
        self.clockwork.play(not self.clockwork.is_playing)

    def _show_playing(self, on: bool) -> None:
        # QGIS's own icons: not every font has signs for play and pause.
        self.play.setIcon(QgsApplication.getThemeIcon(PAUSE if on else PLAY))

    def _progressed(self) -> None:
        self._show_status(
            tr(
                "Loading … {positions}, up to {moment}",
                positions=tr_count(len(self.fetching.history), "1 position", "%n positions"),
                moment=date_and_time(self.fetching.reached),
            )
        )

    def _ended(self, why: str) -> None:
        self.form.show_busy(False)
        history = self.fetching.history
        if why:
            self._warn(why)
        if not len(history):
            self._show_status(why or tr("No positions are stored of that time."))
            return
        self._show_status(
            tr("positions: {positions}, robots: {robots}", positions=len(history), robots=len(history.names))
            + (tr(" · NOT ALL") if why else "")
        )
        self._showing.begin_soon(self._parts())

    def _parts(self) -> Steps[None]:
        """Show a history part by part: between two of them the window handles events."""
        parts = self._show_lines, self._show_all, self._show_robots, self._show_marks
        for number, show in enumerate(parts):
            show()
            yield (number + 1) / len(parts)

    def _show_lines(self) -> None:
        if self._desk.state.site is not None:
            self.layer.show(self.fetching.history, self._desk.state.site)

    def _show_all(self) -> None:
        try:
            self.map.show_all(self.fetching.history)
        except FleetError as error:
            self._warn(str(error))

    def _show_robots(self) -> None:
        self._show(self.clockwork.moment)

    def _show(self, moment: float) -> None:
        self.line.show_moment(moment)
        self._show_banner(moment)
        if not self.fetching.history.is_arranged:
            # It is shown when all of it is there.
            return
        try:
            self.map.show_moment(
                self.fetching.history, self._past.commands, moment, self._desk.selection.robots
            )
        except FleetError as error:
            self.clockwork.play(False)
            self._warn(str(error))

    def _commands_changed(self, *_: object) -> None:
        if self.clockwork.is_set:
            self._past.renew()

    def _show_commands(self, before: PastCommands) -> None:
        self._show_marks()
        moment = self.clockwork.moment
        if self._past.commands.under_way_at(moment) != before.under_way_at(moment):
            self._show(moment)

    def _show_marks(self) -> None:
        since, until = self.clockwork.since, self.clockwork.until
        self.line.show_marks(self._past.commands.marks(since, until, self._robots))

    def _site_changed(self) -> None:
        if self._desk.state.robots.generation == self._generation:
            return
        # Another site's history must not be shown, nor another gateway's of the same site: other robots may
        # have the same names.
        self._generation = self._desk.state.robots.generation
        self.fetching.forget()
        self._showing.stop()
        self._past.forget()
        self.form.show_busy(False)
        self.clockwork.play(False)
        self.layer.clear()
        self.map.show_nothing()
        self.line.show_time(0.0, 0.0)
        self.line.show_marks(NO_MARKS)
        self._show_status(tr("Choose a time and press Load."))

    def _warn(self, text: str, *topics: Topic) -> None:
        """Report an error about the loaded data, until other data is loaded."""
        self._desk.messages.post(text, Level.WARNING, REPLAY, *topics)

    def _show_status(self, text: str) -> None:
        self._status = text
        self._show_banner(self.clockwork.moment)

    def _show_banner(self, moment: float) -> None:
        if not self.clockwork.is_set:
            self.banner.setText(tr("REPLAY · {status}", status=self._status))
            return
        self.banner.setText(
            tr("REPLAY, not live · {moment} · {status}", moment=date_and_time(moment), status=self._status)
        )

    def _lay_out(self) -> None:
        bottom = QHBoxLayout()
        bottom.addWidget(self.play)
        bottom.addWidget(self.speed)
        bottom.addWidget(self.line, 1)
        body = QWidget()
        rows = QVBoxLayout(body)
        rows.setContentsMargins(6, 4, 6, 6)
        rows.setSpacing(4)
        rows.addWidget(self.form)
        rows.addWidget(self.banner)
        rows.addWidget(self.map, 1)
        rows.addLayout(bottom)
        self.map.setMinimumHeight(100)
        self.setWidget(body)
        self.setFocusProxy(self.form.last)


class ReplayAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: FleetController):
        super().__init__(
            iface,
            menu,
            ReplayDock(desk, iface.mainWindow()),
            icon="replay.svg",
            text=tr("Replay"),
            name="fleet_replay",
            tip=tr("Play what robots did, on a map beside the live one"),
        )
