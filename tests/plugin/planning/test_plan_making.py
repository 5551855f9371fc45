"""A cone plan is made, shown and given up; what is missing for one is named."""

from __future__ import annotations

import threading

import pytest
from fleet_supervisor.plugin.planning import proposal
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QEvent
from qgis.PyQt.QtWidgets import QAction, QApplication, QDockWidget

from tests.plugin.planning.panel_parts import ABOARD, CARRIES, E, N, cones_of, planned, press, untick, write
from tests.support.left_behind import slots_that_hold


def test_a_preview_gives_each_robot_the_cones_near_to_it_and_sends_nothing(panel, gateway, wait, iface):
    plan = planned(panel, wait)
    assert {robot: set(ids) for robot, ids in cones_of(plan).items()} == {
        "r1": {"row-1", "row-2", "row-3"},
        "r2": {"row-4", "row-5", "row-6"},
    }
    asked = {method for method, _ in gateway.requests}
    assert not asked & {"set_queue", "take_over", "send", "add_tasks"}
    tree = panel.tree
    assert [tree.topLevelItem(k).text(0) for k in range(2)] == ["r1", "r2"]
    assert tree.topLevelItem(0).child(0).text(1).startswith("+0:")
    assert "Not sent yet: 6 cones, 2 robots" in panel.bar.text.text()
    assert panel.bar.text.text().endswith("(quick preview, along straight lines)")
    told, how = panel.bar.text.toolTip().rsplit("\n", 1)
    assert (told, how) == (panel.bar.text.text(), "Found by: preview. Ways along: straight lines.")


def test_a_plan_keeps_clear_of_cones_that_single_targets_put_down(panel, gateway, wait):
    gateway._queue("single", "r1", "SetPosEnd", {"x": 60.0, "y": 52.0, "cone": True})
    gateway.step("single", CommandState.REACHED, "r1")
    wait(lambda: panel._desk.state.standing_cones(), what="the cone")
    planned(panel, wait)
    assert panel.drafts.draft.ways.cones.tolist() == [[60.0, 52.0]]


def test_a_good_plan_is_made_with_progress_and_can_be_given_up(panel, wait, endless):
    endless()
    panel.form.seconds.setValue(60.0)
    press(panel, "fleet_plan_solve")
    wait(lambda: panel.drafts.task is not None and panel.drafts.task.progress() > 0, 20, "progress")
    assert not panel.preview.isEnabled()
    assert not slots_that_hold(panel.drafts.task), "let go of, the task may crash QGIS when it ends"
    press(panel, "fleet_plan_cancel")
    wait(lambda: not panel.drafts.busy, 10, "the end")
    assert panel.drafts.draft is None and panel.preview.isEnabled()


def test_what_speaks_against_a_plan_is_found_beside_the_windows_thread(panel, wait, monkeypatch):
    threads = []
    for name in ("meetings", "closed_ways"):
        find = getattr(proposal, name)
        monkeypatch.setattr(
            proposal, name, lambda *args, find=find: threads.append(threading.get_ident()) or find(*args)
        )
    planned(panel, wait)
    assert len(threads) == 2 and threading.get_ident() not in threads


def test_the_plan_is_on_the_map_with_numbers_times_and_a_colour_for_each_robot(panel, wait):
    plan = planned(panel, wait)
    for written in (panel.layers.stops, panel.layers.ways):
        written.finish()
    stops, ways = panel.layers.stops.layer, panel.layers.ways.layer
    assert stops.featureCount() == 6 and ways.featureCount() == 6
    found = {f["id"]: f for f in stops.getFeatures()}
    for one in plan.robots:
        for number, stop in enumerate(one.stops, 1):
            feature = found[stop.id]
            assert feature["number"] == number and feature["robot"] == one.robot.id
            assert feature["arrives"].startswith("+0:")
            at = feature.geometry().asPoint()
            assert (at.x(), at.y()) == pytest.approx((E + stop.x, N + stop.y))
    assert len({f["colour"] for f in found.values()}) == 2


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (lambda dock: dock.form.cones.setCurrentIndex(0), "No layer of cones is chosen"),
        (lambda dock: [untick(dock, row) for row in range(2)], "No robot that is there is chosen"),
        (
            lambda dock: [write(dock, row, ABOARD, "0") for row in range(2)],
            "under Stores, or write under Aboard",
        ),
        (lambda dock: dock.form.selected_only.setChecked(True), "no selected features"),
        (lambda dock: write(dock, 0, CARRIES, "many"), "Carries of r1 is 'many'"),
    ],
)
def test_what_is_missing_is_named(panel, wait, iface, spoil, expected):
    spoil(panel)
    press(panel, "fleet_plan_preview")
    wait(lambda: any(expected in text for text in iface.texts()), 10, expected)


def test_what_was_missing_is_told_no_longer_once_another_plan_is_asked_for(panel, wait, iface):
    for row in range(2):
        write(panel, row, ABOARD, "0")
    press(panel, "fleet_plan_preview")
    wait(lambda: any("There is no store" in text for text in iface.texts()), 10, "what is missing")
    for row in range(2):
        write(panel, row, ABOARD, "6")
    planned(panel, wait)
    wait(lambda: not any("There is no store" in text for text in iface.texts()), 10, "the text going")


def test_unloading_takes_panel_layers_and_tasks_away(panel, plugin, wait, iface, endless):
    planned(panel, wait)
    endless()
    panel.form.seconds.setValue(60.0)
    press(panel, "fleet_plan_solve")
    wait(lambda: (task := panel.drafts.task) is not None and task.progress() > 0, 20, "progress")
    task = panel.drafts.task
    plugin.unload()
    wait(lambda: not task.is_under_way, what="the end of its thread")
    names = {layer.name() for layer in QgsProject.instance().mapLayers().values()}
    assert names == {"Cones"}
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert iface.findChild(QDockWidget, "fleet_plan_dock") is None
    assert iface.findChild(QAction, "fleet_plan_panel") is None


def test_another_project_switches_off_what_is_sent_by_itself(panel, tmp_path):
    panel.bar.by_itself.click()
    assert panel.drafts.settings.by_itself
    other = str(tmp_path / "other.qgz")
    assert QgsProject().write(other)
    assert QgsProject.instance().read(other)
    assert not panel.bar.by_itself.isChecked() and not panel.drafts.settings.by_itself
