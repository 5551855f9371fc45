"""Alarms as the operator meets them, on real widgets: panel, message bar, log, settings."""

import csv
import json
import time
from itertools import groupby

import pytest
from fleet_supervisor.plugin.panel.alarms.rules import (
    AlarmKind,
    Thresholds,
    read_thresholds,
    write_thresholds,
)
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.core import QgsFeature, QgsGeometry, QgsProject, QgsRectangle, QgsSettings, QgsVectorLayer
from qgis.PyQt.QtCore import Qt, QTimer
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QApplication,
    QCheckBox,
    QDialogButtonBox,
    QDoubleSpinBox,
    QLabel,
    QPushButton,
    QTableView,
    QToolButton,
    QWidget,
)

from tests.support.patience import BUSY

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def at_alarms(at_desk):
    """The desk with the panel of alarms in front."""
    at_desk.dock.tabs.setCurrentIndex(alarm_tab(at_desk))
    return at_desk


def alarm_tab(window) -> int:
    tabs = window.dock.tabs
    return next(k for k in range(tabs.count()) if tabs.tabText(k).startswith("Alarms"))


def alarms(window) -> list[tuple[str, str]]:
    # In its page: what is asked for again and again would pass every part of the panel each time.
    page = window.dock.tabs.widget(alarm_tab(window))
    model = page.findChild(QTableView, "fleet_alarms").model()
    return [tuple(model.index(row, column).data() for column in (1, 2)) for row in range(model.rowCount())]


def bar_texts(iface) -> list[str]:
    return [label.text() for label in iface.bar.findChildren(QLabel, "fleet_alarm_text")]


def press(window, name, kind=QPushButton):
    QTest.mouseClick(window.findChild(kind, name), LEFT)


def choose(window, row):
    view = window.dock.findChild(QTableView, "fleet_alarms")
    QTest.mouseClick(view.viewport(), LEFT, pos=view.visualRect(view.model().index(row, 1)).center())
    return view


# --- each alarm, from the wire to the panel ---


def test_what_robots_tell_of_themselves_is_an_alarm_and_over_when_they_tell_better(
    at_alarms, gateway, make_robot, wait
):
    def wait_for(text, state="new"):
        wait(lambda: (text, state) in alarms(at_alarms), what=text)

    gateway.show(make_robot("r1", 50, 40, battery=0.12))
    wait(lambda: alarms(at_alarms) == [("r1 has 12% of its battery left", "new")])
    gateway.show(make_robot("r1", 50, 40, battery=0.9))
    wait(lambda: alarms(at_alarms) == [("r1 has 12% of its battery left", "over")])
    gateway.show(
        make_robot("r1", 50, 40, accuracy=2.5), make_robot("phone", 20, 20, accuracy=8.0, abilities="")
    )
    text = "r1 does not know its place: ± 2.5 m at 50.0, 40.0 m"
    wait_for(text)
    gateway.show(make_robot("r1", 50, 40, accuracy=0.06))
    wait_for(text, "over")
    why = "its position was 6 s old when it came"
    gateway.show(make_robot("r1", 50, 40, doubt=why), make_robot("phone", 20, 20, abilities="", doubt=why))
    text = f"r1 may not be where it is shown: {why}"
    wait_for(text, "new ×2")
    gateway.show(make_robot("r1", 50, 40))
    wait_for(text, "over ×2")
    gateway.show(make_robot("r1", 203, 40))
    wait_for("r1 is outside the site at 203.0, 40.0 m")
    gateway.show(make_robot("r1", 79.5, 60))
    wait_for("r1 and r2 are 0.5 m apart at 79.5, 60.0 m")
    gateway.show(make_robot("r1", 50, 40, age=30.0, state=RobotState.LOST))
    wait_for("r1 is lost: nothing is heard of it; last at 50.0, 40.0 m")
    # The phone gave no alarm, and each of the others one.
    assert len(alarms(at_alarms)) == 5


def tell_of_fences(gateway, *alarms, **more):
    """Tell the desk who is in a keepout or at an obstacle, as gateways do."""
    watched = {"keepouts": 2, "obstacles": 46, "unjudged": [], **more}
    gateway.tell("geofence", {"t": time.time(), "alarms": list(alarms), **watched})


def fence_alarm(kind="keepout", name="Water basin", **more):
    return {"robot": "r1", "kind": kind, "name": name, "since": time.time(), "x": 50.0, "y": 40.0, **more}


def test_a_robot_in_a_keepout_and_at_an_obstacle_while_it_is_there(at_alarms, gateway, iface, wait):
    asked = fence_alarm(action="pause", outcome="asked")
    tell_of_fences(gateway, asked, fence_alarm("obstacle", "Control tower"))
    basin, tower = "r1 is in the keepout Water basin", "r1 is at the obstacle Control tower"
    wait(lambda: alarms(at_alarms) == [(f"{basin}: it is being paused", "new"), (tower, "new")])
    hung = "Fleet Supervisor: 2 alarms:"
    wait(lambda: bar_texts(iface) == [f"{hung} {basin}: it is being paused; {tower}"])
    tell_of_fences(gateway, {**asked, "outcome": "paused"})
    basin += ": the gateway has paused it"
    wait(lambda: alarms(at_alarms) == [(basin, "new"), (tower, "over")])
    wait(lambda: bar_texts(iface) == [f"{hung} {basin}; {tower}"])
    press(at_alarms.dock, "fleet_acknowledge_all")
    wait(lambda: alarms(at_alarms) == [(basin, "seen")])
    tell_of_fences(gateway)
    wait(lambda: alarms(at_alarms) == [])


def test_what_the_gateway_does_about_it_is_said(at_alarms, gateway, wait):
    for how, text in (
        ({"action": "abort", "outcome": "aborted"}, "the gateway has aborted its task"),
        ({"action": "abort", "outcome": "asked"}, "it is being aborted"),
        ({"action": "abort", "outcome": "stopped"}, "the emergency stop holds it"),
        (
            {"action": "abort", "outcome": "failed", "reason": "no disk"},
            "it could NOT be stopped yet: no disk",
        ),
    ):
        tell_of_fences(gateway, fence_alarm(**how))
        told = [(f"r1 is in the keepout Water basin: {text}", "new")]
        wait(lambda told=told: alarms(at_alarms) == told, what=text)


def test_what_the_gateway_cannot_judge_is_said(at_alarms, gateway, wait):
    note = at_alarms.dock.findChild(QLabel, "fleet_alarm_note")
    names = [f"r{number}" for number in range(3, 8)]
    tell_of_fences(gateway, keepouts=0, obstacles=0, unjudged=names, unjudged_more=4)
    wait(lambda: "it is not known where they are: r3, r4, r5, 6 more." in note.text())
    assert "The published site has no keepouts." in note.text()
    assert "no obstacles, so nobody is told to be at one" in note.text()
    tell_of_fences(gateway, fault="no ring")
    wait(lambda: "Keepouts and obstacles are not watched: no ring." in note.text())
    tell_of_fences(gateway)
    wait(lambda: "eepouts" not in note.text())


def test_a_gateway_that_tells_nothing_of_keepouts_is_named_as_older(at_alarms, wait, monkeypatch):
    note = at_alarms.dock.findChild(QLabel, "fleet_alarm_note")
    assert "older" not in note.text()
    monkeypatch.setattr("fleet_supervisor.plugin.gateway_client.report_caches.GEOFENCE_SILENT_AFTER", 0.5)
    wait(lambda: "The gateway tells nothing of them".lower() in note.text())
    assert "It may be older than this plugin." in note.text()


def meeting(seconds, **more):
    now = time.time()
    where = {"x": 60.0, "y": 40.0, "metres": 0.7, "clearance": 1.5, **more}
    times = {"begins": now + seconds, "nearest_at": now + seconds + 1}
    return {"t": now, "conflicts": [{"robot": "r1", "other": "r2", "kind": "standing", **times, **where}]}


def test_robots_that_will_pass_too_near_before_they_do(at_alarms, gateway, wait):
    gateway.tell("conflicts", meeting(60.0))
    wait(lambda: len(at_alarms.desk.state.conflicts.conflicts) == 1)
    QTest.qWait(1200)
    assert alarms(at_alarms) == []
    gateway.tell("conflicts", meeting(29.0))
    text = "r1 will pass r2 at 0.7 m (clearance 1.5 m) at 60.0, 40.0 m"
    wait(lambda: alarms(at_alarms) == [(text, "new")])
    gateway.tell("conflicts", {"t": time.time(), "conflicts": []})
    wait(lambda: alarms(at_alarms) == [(text, "over")])


def test_two_robots_are_one_alarm_whichever_of_them_is_told_first(at_alarms, gateway, wait):
    gateway.tell("conflicts", meeting(5.0))
    wait(lambda: [state for _, state in alarms(at_alarms)] == ["new"])
    told = meeting(4.0)
    # r1 has come to its end, and stands in the way of r2.
    told["conflicts"][0] |= {"robot": "r2", "other": "r1"}
    gateway.tell("conflicts", told)
    roads = at_alarms.desk.state
    wait(lambda: roads.conflicts.conflicts[0].robot == "r2", what="the news of it")
    watch = at_alarms.dock.findChild(QTableView, "fleet_alarms").parent()._watch
    watch.evaluate()
    assert [(alarm.robot, alarm.other, alarm.times) for alarm in watch.board.alarms()] == [("r1", "r2", 1)]


def test_an_older_gateway_tells_no_clearance(at_alarms, gateway, wait):
    told = meeting(5.0)
    del told["conflicts"][0]["clearance"]
    gateway.tell("conflicts", told)
    wait(lambda: alarms(at_alarms) == [("r1 will pass r2 at 0.7 m at 60.0, 40.0 m", "new")])


def test_a_phone_that_comes_near_a_robot_and_is_near_names_both(at_alarms, gateway, make_robot, wait):
    def tell(*alarms, **more):
        at = {"t": time.time(), "metres": 5.0, "within_s": 10.0, **more}
        gateway.tell("nearness", {**at, "alarms": list(alarms)})

    anna = {"seen": "anna", "robot": "r1", "since": time.time(), "x": 50.0, "y": 40.0}
    tell({**anna, "metres": 5.0, "seconds": 6.2})
    coming = "anna comes within 5.0 m of r1 in 6 s"
    wait(lambda: alarms(at_alarms) == [(coming, "new")])
    tell({**anna, "metres": 3.4, "seconds": 0.0})
    near = "anna is 3.4 m from r1"
    wait(lambda: alarms(at_alarms) == [(near, "new"), (coming, "over")])
    tell()
    wait(lambda: alarms(at_alarms) == [(near, "over"), (coming, "over")])
    gateway.show(make_robot("r1", 50, 40, doubt="it leapt"), make_robot("anna", 20, 20, abilities=""))

    def tell_again():
        tell({**anna, "metres": 3.4, "seconds": 0.0})
        return [text for text, state in alarms(at_alarms) if state.startswith("new") and "anna" in text]

    unsure = f"{near}; r1 may be elsewhere"
    wait(lambda: tell_again() == [unsure])
    gateway.show(make_robot("r1", 50, 40))
    wait(lambda: tell_again() == [near])
    # How near they are stays as it was.
    tell({**anna, "metres": 3.0, "seconds": 0.0})
    assert tell_again() == [near]
    tell(fault="it cannot be judged")
    panel = at_alarms.dock.findChild(QTableView, "fleet_alarms").parent()
    wait(lambda: "People near robots are not watched: it cannot be judged." in panel._watch.why_not())


def test_kinds_that_the_gateway_judges_can_be_switched_off(at_alarms, gateway, wait):
    panel = at_alarms.dock.findChild(QTableView, "fleet_alarms").parent()

    def states():
        # It goes on telling of them: what it tells no more would be over in any case.
        tell_of_fences(gateway, fence_alarm())
        gateway.tell("conflicts", meeting(5.0))
        return [state for _, state in alarms(at_alarms)]

    wait(lambda: states() == ["new", "new"])
    panel._watch.set_limits(Thresholds(kinds=frozenset()))
    wait(lambda: states() == ["over", "over"])


def test_a_robot_that_stands_with_a_task(at_alarms, gateway, make_robot, iface, wait):
    QgsSettings().setValue("fleet_supervisor/alarms/stopped_after", 1)
    panel = at_alarms.dock.findChild(QTableView, "fleet_alarms").parent()
    panel._watch.set_limits(read_thresholds())
    gateway.show(make_robot("r1", 50, 40, v=0.0), make_robot("r2", 80, 60, v=0.0))
    command = gateway._queue("command-1", "r1", "SetPosEnd", {"x": 70.0, "y": 40.0, "cone": True})
    gateway.step(command.command, CommandState.DELIVERED, "gateway")
    for _ in range(12):
        # It has not accepted the task yet.
        gateway.show(make_robot("r1", 50, 40, v=0.0))
        QTest.qWait(200)
    assert alarms(at_alarms) == []
    gateway.step(command.command, CommandState.ACKNOWLEDGED, "r1")
    keep = time.monotonic() + BUSY * 8
    while not alarms(at_alarms) and time.monotonic() < keep:
        gateway.show(make_robot("r1", 50, 40, v=0.0), make_robot("r2", 80, 60, v=0.0))
        QTest.qWait(200)
    assert alarms(at_alarms) == [("r1 has a task and stands at 50.0, 40.0 m", "new")]


def test_a_robot_off_the_road_of_the_project(at_alarms, gateway, make_robot, wait):
    road = QgsVectorLayer("Polygon?crs=EPSG:32633", "asphalt", "memory")
    feature = QgsFeature()
    feature.setGeometry(QgsGeometry.fromRect(QgsRectangle(488000, 5190000, 488200, 5190062)))
    road.dataProvider().addFeatures([feature])
    road.setCustomProperty("fleet/role", "road_surface")
    note = at_alarms.dock.findChild(QLabel, "fleet_alarm_note")
    wait(lambda: "no layer of the project has the role road surface" in note.text())
    QgsProject.instance().addMapLayer(road)
    gateway.show(make_robot("r2", 80, 62.3))
    wait(lambda: "road" not in note.text(), 10)
    QTest.qWait(1600)
    assert alarms(at_alarms) == []
    gateway.show(make_robot("r2", 80, 63))
    wait(lambda: alarms(at_alarms) == [("r2 is off the road at 80.0, 63.0 m", "new")])
    gateway.show(make_robot("r2", 80, 61.9))
    wait(lambda: alarms(at_alarms) == [("r2 is off the road at 80.0, 63.0 m", "over")])


def test_a_layer_of_surfaces_without_areas_is_named_and_nobody_off_the_road(at_alarms, wait):
    line = QgsVectorLayer("LineString?crs=EPSG:32633", "kerbs", "memory")
    line.setCustomProperty("fleet/role", "road_surface")
    QgsProject.instance().addMapLayer(line)
    note = at_alarms.dock.findChild(QLabel, "fleet_alarm_note")
    wait(lambda: "Off the road is not watched" in note.text() and "kerbs" in note.text())
    assert alarms(at_alarms) == []


# --- what the operator does about it ---


def test_acknowledging_one_takes_it_from_the_new_ones(at_alarms, gateway, make_robot, wait):
    gateway.show(make_robot("r1", 50, 40, battery=0.1), make_robot("r2", 80, 60, battery=0.1))
    wait(lambda: len(alarms(at_alarms)) == 2)
    assert at_alarms.dock.tabs.tabText(alarm_tab(at_alarms)) == "Alarms (2)"
    button = at_alarms.dock.findChild(QPushButton, "fleet_acknowledge")
    assert not button.isEnabled()
    choose(at_alarms, 0)
    chosen = alarms(at_alarms)[0][0]
    QTest.mouseClick(button, LEFT)
    assert alarms(at_alarms)[1] == (chosen, "seen")
    assert at_alarms.dock.tabs.tabText(alarm_tab(at_alarms)) == "Alarms (1)"
    gateway.show(make_robot("r1", 50, 40), make_robot("r2", 80, 60))
    wait(lambda: [state for _, state in alarms(at_alarms)] == ["over"])


def watch_of(window):
    return window.dock.findChild(QTableView, "fleet_alarms").parent()._watch


def test_alarms_are_judged_told_and_listed_in_pieces_between_which_the_window_looks_for_events(
    at_alarms, gateway, make_robot, wait, monkeypatch
):
    told, watch, events = [], watch_of(at_alarms), QTimer()
    look = watch.board.evaluate

    def judge(*now):
        found = look(*now)
        told.extend(["judged"] if found else [])
        return found

    monkeypatch.setattr(watch.board, "evaluate", judge)
    watch.happened.connect(lambda _: told.append("told"))
    watch.changed.connect(lambda: told.append("listed"))
    events.timeout.connect(lambda: told.append("events"))
    events.start(0)
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: alarms(at_alarms))
    events.stop()
    pieces = [what for what, _ in groupby(told)]
    begun = pieces.index("judged")
    assert pieces[begun : begun + 5] == ["judged", "events", "told", "events", "listed"]


def test_alarms_that_nobody_was_told_of_yet_are_not_acknowledged_with_all_others(
    at_alarms, gateway, make_robot, wait, monkeypatch
):
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: len(alarms(at_alarms)) == 1)
    watch = watch_of(at_alarms)
    with monkeypatch.context() as late:
        late.setattr(watch._announcing, "begin_soon", lambda work: None)
        gateway.show(make_robot("r2", 80, 60, battery=0.1))
        wait(lambda: len(watch.board.alarms()) == 2)
    assert len(alarms(at_alarms)) == 1
    press(at_alarms.dock, "fleet_acknowledge_all")
    assert [(alarm.robot, alarm.is_new) for alarm in watch.board.alarms()] == [("r2", True), ("r1", False)]
    assert sorted(state for _, state in alarms(at_alarms)) == ["new", "seen"]


@pytest.mark.parametrize("how", ["double click", "Enter"])
def test_a_double_click_or_enter_goes_to_both_robots(at_alarms, gateway, make_robot, iface, wait, how):
    gateway.show(make_robot("r1", 79.5, 60))
    wait(lambda: len(alarms(at_alarms)) == 1)
    iface.look_at(0, 0, 20, 20)
    view = choose(at_alarms, 0)
    if how == "Enter":
        QTest.keyClick(view, Qt.Key.Key_Return)
    else:
        QTest.mouseDClick(view.viewport(), LEFT, pos=view.visualRect(view.model().index(0, 1)).center())
    assert at_alarms.desk.selection.robots == ("r2", "r1")
    centre = iface.canvas.extent().center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((79.75, 60), abs=0.5)


def test_the_message_bar_has_one_item_that_counts(at_desk, gateway, make_robot, iface, wait):
    crowd = [make_robot(f"n{k}", 5.0 * k, 20, battery=0.1) for k in range(30)]
    gateway.show(*crowd)
    wait(lambda: bar_texts(iface) and "30 alarms" in bar_texts(iface)[0])
    assert len(bar_texts(iface)) == 1
    assert bar_texts(iface)[0].endswith("; and 28 more")
    gateway.show(make_robot("n31", 500, 20))
    wait(lambda: "31 alarms: n31 is outside the site" in bar_texts(iface)[-1])
    wait(lambda: len(bar_texts(iface)) == 1)
    assert len([text for text in iface.texts() if "battery" in text]) == 0


def test_the_bar_shows_the_panel_and_goes_when_all_is_seen(at_desk, gateway, make_robot, iface, wait):
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: bar_texts(iface))
    press(iface.bar, "fleet_show_alarms", QToolButton)
    assert at_desk.dock.tabs.currentIndex() == alarm_tab(at_desk)
    body = iface.bar.findChild(QWidget, "fleet_alarm_bar")
    assert [button.objectName() for button in body.findChildren(QAbstractButton)] == ["fleet_show_alarms"]
    wait(lambda: at_desk.dock.findChild(QPushButton, "fleet_acknowledge_all").isEnabled())
    press(at_desk.dock, "fleet_acknowledge_all")
    wait(lambda: not bar_texts(iface))
    assert [state for _, state in alarms(at_desk)] == ["seen"]


def test_closed_the_bar_comes_back_with_the_next_alarm_only(at_desk, gateway, make_robot, iface, wait):
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: bar_texts(iface))
    iface.bar.clearWidgets()
    QApplication.processEvents()
    gateway.show(make_robot("r1", 50, 40))
    wait(lambda: [state for _, state in alarms(at_desk)] == ["over"])
    assert not iface.bar.currentItem()
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: iface.bar.currentItem() and "alarm" in bar_texts(iface)[-1])


def test_the_log_is_written_as_csv(at_alarms, gateway, make_robot, tmp_path, wait):
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: alarms(at_alarms))
    press(at_alarms.dock, "fleet_acknowledge_all")
    press(at_alarms.dock, "fleet_alarm_log")
    dialog = QApplication.topLevelWidgets()
    dialog = next(w for w in dialog if w.objectName() == "fleet_alarm_log_dialog")
    model = dialog.findChild(QTableView, "fleet_alarm_events").model()
    assert [model.index(row, 1).data() for row in range(2)] == ["acknowledged", "began"]
    target = tmp_path / "alarms.csv"
    dialog.export(str(target))
    rows = list(csv.DictReader(target.open(encoding="utf-8-sig")))
    assert [(row["change"], row["robot"], row["kind"], row["x"]) for row in rows] == [
        ("began", "r1", "low battery", "50.0"),
        ("acknowledged", "r1", "low battery", "50.0"),
    ]
    assert rows[1]["by"] and not rows[0]["by"]
    dialog.export(str(tmp_path / "missing" / "alarms.csv"))
    assert "was not written" in dialog.findChild(QLabel, "fleet_alarm_log_said").text()
    dialog.close()


def test_who_has_seen_an_alarm_is_noted_as_the_gateway_knows_them(gateway, make_robot, request, wait):
    gateway.who = {"operator": "Anna Nagy", "role": "supervisor"}
    at_alarms = request.getfixturevalue("at_alarms")
    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: alarms(at_alarms))
    press(at_alarms.dock, "fleet_acknowledge_all")
    (alarm,) = at_alarms.dock.findChild(QTableView, "fleet_alarms").parent()._watch.board.alarms()
    assert alarm.by == "Anna Nagy, supervisor"


def test_settings_hold_at_once(at_alarms, gateway, make_robot, wait):
    press(at_alarms.dock, "fleet_alarm_limits")
    open_ones = (w for w in QApplication.topLevelWidgets() if w.isVisible())
    dialog = next(w for w in open_ones if w.objectName() == "fleet_thresholds")
    dialog.findChild(QDoubleSpinBox, "fleet_low_battery").setValue(85)
    dialog.findChild(QDoubleSpinBox, "fleet_too_close").setValue(2.5)
    dialog.findChild(QCheckBox, "fleet_watch_outside_site").setChecked(False)
    assert not dialog.findChild(QDoubleSpinBox, "fleet_outside_margin").isEnabled()
    QTest.mouseClick(dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok), LEFT)
    wait(lambda: len(alarms(at_alarms)) == 2)
    kept = at_alarms.dock.findChild(QTableView, "fleet_alarms").parent()._watch.board.limits
    assert (kept.low_battery, kept.too_close) == (0.85, 2.5)
    assert kept.kinds == frozenset(AlarmKind) - {AlarmKind.OUTSIDE_SITE}
    note = at_alarms.dock.findChild(QLabel, "fleet_alarm_note")
    wait(lambda: "Switched off: outside the site" in note.text())


def test_settings_are_kept():
    limits = Thresholds(low_battery=0.85, stopped_after=30.0, kinds=frozenset({AlarmKind.LOST}))
    write_thresholds(limits)
    assert read_thresholds() == limits


def test_broken_settings_count_as_never_set():
    QgsSettings().setValue("fleet_supervisor/alarms/low_battery", "much")
    QgsSettings().setValue("fleet_supervisor/alarms/too_close", -4)
    assert read_thresholds().low_battery == 0.20
    assert read_thresholds().too_close == 1.0


# --- when nobody can tell ---


def test_without_a_link_nothing_is_an_alarm_and_the_panel_says_so(at_alarms, gateway, wait):
    gateway.stop()
    note = at_alarms.dock.findChild(QLabel, "fleet_alarm_note")
    wait(lambda: note.text() == "Nothing is watched: the desk is not connected.")
    wait(lambda: at_alarms.desk.state.robots.view("r1", at_alarms.desk.clock.steady()).age > 10.5, 15)
    assert alarms(at_alarms) == []


def test_another_site_starts_without_alarms(at_alarms, gateway, site, make_robot, wait):
    from dataclasses import replace

    gateway.show(make_robot("r1", 50, 40, battery=0.1))
    wait(lambda: alarms(at_alarms))
    gateway.tell("site", json.loads(json.dumps(replace(site, origin=(1.0, 2.0)).__dict__)))
    wait(lambda: not alarms(at_alarms))


def test_of_ten_thousand_robots_the_two_that_are_close_are_found(at_desk, gateway, make_robot, wait):
    panel = at_desk.dock.findChild(QTableView, "fleet_alarms").parent()
    crowd = [make_robot(f"n{k}", 0.4 + (k % 100) * 1.9, 0.4 + (k // 100) * 1.5) for k in range(10_000)]
    near = make_robot("n10000", crowd[7777].x + 0.2, crowd[7777].y)
    gateway.show(make_robot("r1", None, None), make_robot("r2", None, None))
    gateway.show(*crowd, near)
    wait(lambda: len(at_desk.desk.state.robots) == 10_003, 30)
    panel._watch.evaluate()
    assert {(alarm.robot, alarm.other) for alarm in panel._watch.board.alarms()} == {("n7777", "n10000")}


def test_unloading_leaves_nothing(plugin, iface):
    assert plugin.window.dock.findChild(QTableView, "fleet_alarms") is not None
    tabs = plugin.window.dock.tabs
    before = tabs.count()
    part = next(part for part in plugin._parts if type(part).__name__ == "WindowAlarms")
    plugin._parts.remove(part)
    part.remove()
    assert tabs.count() == before - 1
    assert bar_texts(iface) == []
    plugin.window.desk.state.pull()
