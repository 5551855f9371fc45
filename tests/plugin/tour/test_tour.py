"""The tour, with mouse and keys, with a real gateway and real simulated robots."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase
from fleet_supervisor.plugin.panel.window import MENU, FleetWindow
from fleet_supervisor.plugin.settings.profile import GatewayConnection
from fleet_supervisor.plugin.tour import practice_fleet
from fleet_supervisor.plugin.tour.practice_fleet import PracticeFleet, find_program
from fleet_supervisor.plugin.tour.tour_panel import FLEET, OFFERED, PROJECT, STEPS, TourAction
from qgis.core import QgsSettings
from qgis.PyQt.QtCore import QEvent, QPoint, QPointF, QProcess, Qt
from qgis.PyQt.QtGui import QMouseEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QLabel, QPushButton, QWidget

LEFT = Qt.MouseButton.LeftButton


class Tour:
    """A desk in a window, the tour beside it, and somebody who takes it."""

    def __init__(self, iface, fleet=None):
        self.iface = iface
        self.window = FleetWindow(iface)
        self.action = TourAction(iface, MENU, self.window, fleet)

    @property
    def desk(self):
        return self.window.desk

    def click(self, name):
        QTest.mouseClick(self.iface.findChild(QPushButton, name), LEFT)

    def text(self, name):
        return self.iface.findChild(QLabel, name).text()

    def go_to(self, at):
        while self.action.panel.step is not STEPS[at]:
            self.click("fleet_tour_next")

    def remove(self):
        self.action.remove()
        self.window.remove()


@pytest.fixture
def tour(iface):
    made = Tour(iface)
    yield made
    made.remove()


def is_running(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def program_in(folder, first="true", then="sleep 600"):
    """Return a program that does ``first``, says that it listens, and becomes ``then``."""
    program = folder / "robot-bridge"
    program.write_text(f"#!/bin/sh\n{first}\necho listening on ws://127.0.0.1:1\nexec {then}\n")
    program.chmod(0o755)
    return program


def has_started(process):
    return process.state() != QProcess.ProcessState.NotRunning


def at_of(offer):
    return next(at for at, step in enumerate(STEPS) if step.offer == offer)


@pytest.fixture
def new_profile(iface):
    """Settings of QGIS in which the tour was not offered yet."""
    QgsSettings().remove(OFFERED)


def test_it_is_offered_once_and_again_in_the_menu(iface, new_profile):
    first = Tour(iface)
    assert iface.findChild(QPushButton, "fleet_tour_start").isVisible()
    first.click("fleet_tour_start")
    assert first.action.panel.isVisible()
    first.remove()
    QApplication.sendPostedEvents(None, 52)
    assert QgsSettings().value(OFFERED, False, type=bool)
    second = Tour(iface)
    assert iface.findChild(QPushButton, "fleet_tour_start") is None
    assert second.action.action in iface.plugins.actions()
    second.action.action.trigger()
    assert second.action.panel.isVisible()
    second.remove()
    assert second.action.action not in iface.plugins.actions()


def test_keys_lead_through_it_and_escape_closes(tour):
    tour.action.start()
    focus = QApplication.focusWidget()
    assert focus is tour.iface.findChild(QPushButton, "fleet_tour_next")
    for at in range(1, len(STEPS)):
        QTest.keyClick(focus, Qt.Key.Key_Return)
        assert STEPS[at].title in tour.text("fleet_tour_title")
    QTest.keyClick(focus, Qt.Key.Key_Tab, Qt.KeyboardModifier.ShiftModifier)
    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)
    assert tour.action.panel.step is STEPS[-2]
    QTest.keyClick(focus, Qt.Key.Key_Escape)
    assert tour.action.panel is None


def test_every_step_points_at_a_widget_that_is_there(tour):
    tour.action.start()
    window = tour.iface.mainWindow()
    pointed = 0
    for at, step in enumerate(STEPS):
        tour.go_to(at)
        spotlight = window.findChild(QWidget, "fleet_tour_spotlight")
        if step.target:
            target = window.findChild(QWidget, step.target)
            middle = target.mapTo(window, QPoint(target.width() // 2, target.height() // 2))
            assert spotlight.framed.contains(middle), step.target
            pointed += 1
    assert pointed >= 6


def test_the_panel_lets_the_rest_be_used_and_can_be_dragged(tour):
    tour.action.start()
    panel = tour.action.panel
    assert not panel.isModal() and panel.geometry().bottom() < tour.iface.height()
    assert tour.iface.rect().contains(panel.geometry())
    search = tour.iface.findChild(QWidget, "fleet_url")
    QTest.mouseClick(search, LEFT)
    QTest.keyClicks(search, "x")
    assert "x" in search.text()
    before = panel.pos()
    for kind, at in (("MouseButtonPress", 3), ("MouseMove", 43), ("MouseButtonRelease", 43)):
        what = getattr(QEvent.Type, kind)
        event = QMouseEvent(what, QPointF(at, 3), LEFT, LEFT, Qt.KeyboardModifier.NoModifier)
        QApplication.sendEvent(panel, event)
    assert panel.pos().x() == before.x() + 40


def test_while_the_fleet_starts_enter_leads_on_and_does_not_close(tour):
    tour.action.start()
    tour.go_to(at_of(FLEET))
    panel = tour.action.panel
    panel.findChild(QPushButton, "fleet_tour_offer").setFocus()
    panel.say("Starting …", busy=True)
    focus = QApplication.focusWidget()
    assert focus.objectName() == "fleet_tour_next"
    QTest.keyClick(focus, Qt.Key.Key_Return)
    assert tour.action.panel is panel and panel.step is STEPS[at_of(FLEET) + 1]


def test_it_does_not_lie_over_the_robots_of_the_sample_site(tour):
    tour.action.start()
    canvas = tour.iface.mapCanvas()
    for at in range(len(STEPS)):
        tour.go_to(at)
        tour.action.panel.say("The practice fleet runs, and the desk is connected to it.")
        foot = tour.action.panel.mapTo(tour.iface, tour.action.panel.rect().bottomLeft())
        assert canvas.mapFrom(tour.iface, foot).y() < canvas.height() / 2, STEPS[at].title


def test_without_the_bridge_it_says_how_to_get_it(iface):
    tour = Tour(iface, PracticeFleet(program=""))
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    assert "pip install" in tour.text("fleet_tour_said")
    assert tour.iface.rect().contains(tour.action.panel.geometry())
    tour.remove()


def test_a_program_that_ends_is_told_with_what_it_said(iface, wait, tmp_path):
    program = tmp_path / "robot-bridge"
    program.write_text("#!/bin/sh\necho no room on this computer\nexit 3\n")
    program.chmod(0o755)
    tour = Tour(iface, PracticeFleet(program=str(program)))
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    wait(lambda: "no room on this computer" in tour.text("fleet_tour_said"), 10, "the reason")
    assert not tour.action.fleet.running
    assert tour.iface.findChild(QPushButton, "fleet_tour_offer").isEnabled()
    tour.remove()


def test_closing_it_waits_for_no_process_and_its_folder_goes_with_the_last(
    qgis_app, wait, tmp_path, monkeypatch
):
    program = program_in(tmp_path)
    fleet = PracticeFleet(program=str(program))
    fleet.start()
    wait(lambda: len(fleet._processes) == 4, what="the robots")
    wait(lambda: all(process.processId() for process in fleet._processes), what="the start of the robots")
    pids = [process.processId() for process in fleet._processes]
    folder = Path(fleet._folder.path())
    monkeypatch.setattr(practice_fleet, "PATIENCE_MS", 50)
    fleet.stop()
    assert not fleet.running
    assert all(is_running(pid) for pid in pids) and folder.exists()
    wait(lambda: not folder.exists(), what="the end of the last process")
    assert not any(is_running(pid) for pid in pids)


def test_when_it_is_removed_every_process_has_ended(qgis_app, wait, tmp_path, monkeypatch):
    fleet = PracticeFleet(program=str(program_in(tmp_path)))
    fleet.start()
    wait(lambda: len(fleet._processes) == 4, what="the robots")
    wait(lambda: all(process.processId() for process in fleet._processes), what="the start of the robots")
    pids = [process.processId() for process in fleet._processes]
    monkeypatch.setattr(practice_fleet, "PATIENCE_MS", 50)
    fleet.remove()
    assert not any(is_running(pid) for pid in pids)


def test_a_fleet_that_runs_is_connected_to_again_after_disconnecting(iface, wait, tmp_path):
    tour = Tour(iface, PracticeFleet(program=str(program_in(tmp_path, then="cat"))))
    panel = tour.window.dock.connection_panel
    panel.use(GatewayConnection("", "ws://127.0.0.1:8765/desk"))
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    wait(lambda: "is connected" in tour.text("fleet_tour_said"), what="the fleet")
    tour.desk.close_link()
    tour.click("fleet_tour_offer")
    wait(lambda: "is connected" in tour.text("fleet_tour_said"), what="the fleet again")
    assert tour.desk.state.link.phase is not ConnectionPhase.CLOSED
    tour.action.end()
    assert panel.url() == "ws://127.0.0.1:8765/desk"
    tour.remove()


@pytest.mark.parametrize("stored", [False, True])
def test_closed_after_disconnecting_it_leaves_no_address_of_a_fleet_that_is_gone(
    iface, wait, tmp_path, stored
):
    tour = Tour(iface, PracticeFleet(program=str(program_in(tmp_path, then="cat"))))
    panel, before = tour.window.dock.connection_panel, "ws://127.0.0.1:8765/desk"
    panel.use(GatewayConnection("", before))
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    wait(lambda: "is connected" in tour.text("fleet_tour_said"), what="the fleet")
    tour.desk.close_link()
    if stored:
        tour.window.actions.connect.trigger()
        assert QgsSettings().value("fleet_supervisor/url") == "ws://127.0.0.1:1/desk"
        tour.window.actions.connect.trigger()
    tour.action.end()
    assert panel.url() == before
    assert QgsSettings().value("fleet_supervisor/url", before) == before
    tour.remove()


@pytest.mark.parametrize(
    ("robot", "why"),
    [
        ('rm "$0"', "not run: "),
        ("echo '#!/bin/sh\nexit 3' > $0", "not run: it ended with code 3"),
        ("echo '#!/bin/sh\nkill -KILL $$' > $0", "not run: Process crashed"),
    ],
)
def test_a_robot_that_does_not_run_is_named(iface, wait, tmp_path, robot, why):
    program = program_in(tmp_path, robot, "cat")
    tour = Tour(iface, PracticeFleet(program=str(program)))
    said = []
    tour.action.fleet.failed.connect(said.append)
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    wait(lambda: said and not any(map(has_started, tour.action.fleet._processes[1:])), what="three robots")
    assert len(said) == 3
    assert all(
        any(f"practice robot {name} does {why}" in text for text in said) for name in ("r1", "r2", "r3")
    )
    assert tour.text("fleet_tour_said") == said[-1]
    tour.remove()


def test_connected_elsewhere_it_starts_nothing_and_asks_for_no_deeds(tour, gateway, wait):
    tour.desk.open_link(gateway.url, "anna")
    wait(lambda: tour.desk.state.link.phase is ConnectionPhase.CONNECTED)
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    assert "Disconnect first" in tour.text("fleet_tour_said")
    assert not tour.action.fleet.running
    for at, step in enumerate(STEPS):
        if step.practice:
            tour.action.panel.show_step(at)
            assert step.practice not in tour.text("fleet_tour_text")
    tour.action.end()
    assert tour.desk.state.link.phase is ConnectionPhase.CONNECTED


def test_the_sample_site_opens(tour):
    opened = []
    tour.iface.addProject = lambda path: opened.append(path) or True
    tour.action.start()
    tour.go_to(at_of(PROJECT))
    tour.click("fleet_tour_offer")
    assert opened[0].endswith("sample_site.qgz") and "is open" in tour.text("fleet_tour_said")
    tour.iface.addProject = lambda path: False
    tour.click("fleet_tour_offer")
    assert "not opened" in tour.text("fleet_tour_said")


def test_a_practice_fleet_is_driven_and_ends_with_the_tour(tour, wait):
    assert find_program(), "robot-bridge is beside this plugin"
    before = tour.window.dock.connection_panel.url()
    tour.action.start()
    tour.go_to(at_of(FLEET))
    tour.click("fleet_tour_offer")
    wait(lambda: len(tour.desk.state.robots.views(tour.desk.clock.steady())) == 3, 60, "three robots")
    processes = list(tour.action.fleet.findChildren(type(tour.action.fleet._processes[0])))
    assert len(processes) == 4
    # Else they would outlive a QGIS that crashes.
    assert all("--until-stdin-closes" in process.arguments() for process in processes)
    wait(lambda: "is connected" in tour.text("fleet_tour_said"))
    sent = next(at for at, step in enumerate(STEPS) if step.target == "fleet_cone_target_button")
    tour.go_to(sent)
    assert STEPS[sent].practice in tour.text("fleet_tour_text")
    pids = [process.processId() for process in processes]
    tour.click("fleet_tour_close")
    assert tour.action.panel is None
    assert tour.window.dock.connection_panel.url() == before
    assert tour.desk.state.link.phase is ConnectionPhase.CLOSED
    wait(lambda: not any(is_running(pid) for pid in pids), what="the end of the processes")


def test_its_address_is_not_kept_for_the_next_session(tour):
    panel = tour.window.dock.connection_panel
    panel.use(GatewayConnection("", "ws://127.0.0.1:8765/desk"))
    tour.action._connect("ws://127.0.0.1:9/desk")
    assert QgsSettings().value("fleet_supervisor/url") is None
    tour.desk.close_link()


def test_its_offer_is_read_whole_beside_its_button(iface, new_profile, plugin, wait):
    label = iface.findChild(QLabel, "fleet_tour_offer_text")
    button = iface.findChild(QPushButton, "fleet_tour_start")
    wait(lambda: label.isVisible() and button.isVisible(), what="the offer")
    assert label.text() == "Fleet Supervisor: A five-minute tour shows how it works."
    assert label.height() >= label.heightForWidth(label.width())
    # QGIS's own bar is as high as what hangs in it.
    iface.bar.resize(700, 80)
    wait(lambda: label.visibleRegion().boundingRect() == label.rect(), what="room for the offer")
