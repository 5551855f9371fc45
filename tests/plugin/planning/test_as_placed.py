"""The as-placed report as rows, figures, CSV and, by Processing, PDF."""

from __future__ import annotations

import csv
import errno
import os
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.planning.as_placed import (
    COLUMNS,
    PlacedModel,
    deviation_summary,
    select_placed_cones,
)
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.records import PlacementReport
from qgis.core import QgsCoordinateReferenceSystem, QgsProject
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDialog

from tests.plugin.planning.panel_parts import E, N, press

YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'


def placed(number, cone="c", at=1_700_000_000.0, deviation=0.05, **more):
    values = (number, f"task-{number}", "r1", 10.0, 20.0, 10.05, 20.0, 0.0, deviation, at, "command")
    return PlacementReport(*values, cone=cone, **{"layout": "row", "plan": "p", **more})


def test_the_report_has_every_cone_in_the_order_of_placing():
    ones = [
        placed(2, "b", 5.0),
        placed(1, "a", 9.0),
        placed(3, "x", 1.0, plan="q"),
        placed(4, "y", 1.0, layout="z"),
    ]
    assert [one.cone for one in select_placed_cones(ones, plan="p")] == ["y", "b", "a"]
    assert [one.cone for one in select_placed_cones(ones, layout="row")] == ["x", "b", "a"]
    assert len(select_placed_cones(ones)) == 4


def test_the_figures_are_those_of_the_deviations():
    ones = [placed(1, deviation=0.1), placed(2, deviation=0.3, collected_at=9.0)]
    found = deviation_summary(ones)
    assert (found.cones, found.collected, found.largest) == (2, 1, 0.3)
    assert found.mean == pytest.approx(0.2)
    assert (
        found.in_words(5)
        == "2 of 5 cones placed, 1 collected again; off by 0.200 m on average, at most 0.300 m"
    )
    assert deviation_summary([]).in_words() == "No cone was put down yet."


@pytest.fixture
def page(panel, gateway, wait):
    """The page As placed with a cone that has a name and one that has none."""
    ones = [placed(1, deviation=0.05), placed(2, None, label="by hand", layout=None, plan=None)]
    gateway.answers["get_placements"] = lambda _: {"result": {"placements": [to_json(one) for one in ones]}}
    panel.tabs.setCurrentWidget(panel.placed)
    press(panel, "fleet_placed_refresh")
    panel.placed.which.setCurrentIndex(panel.placed.which.findText("everything"))
    wait(lambda: len(panel.placed.placements) == 2, 10, "the placed cones")
    return panel.placed


def test_a_double_click_shows_the_place_or_why_it_cannot_be_shown(page, iface):
    place = page.table.visualRect(page.rows.index(0, 0)).center()

    def double_click():
        QTest.mouseClick(page.table.viewport(), Qt.MouseButton.LeftButton, pos=place)
        QTest.mouseDClick(page.table.viewport(), Qt.MouseButton.LeftButton, pos=place)

    one = page.placements[0]
    double_click()
    middle = iface.canvas.center()
    assert (middle.x() - E, middle.y() - N) == pytest.approx((one.x, one.y))
    iface.canvas.setDestinationCrs(QgsCoordinateReferenceSystem(f"wkt:{YARD}"))
    double_click()
    assert any("nothing is known of how the two lie to each other" in text for text in iface.texts())


def test_the_csv_reads_back_with_commas_quotes_and_lines_in_names(page, tmp_path):
    page.placements = [
        replace(placed(1, 'a,"b"\nc'), planned_x=-10.0),
        placed(2, None, label="by hand", collected_at=1_700_000_060.0),
    ]
    page.save(str(tmp_path / "placed.csv"))
    with (tmp_path / "placed.csv").open(encoding="utf-8-sig", newline="") as file:
        head, first, second = csv.reader(file)
    assert tuple(head) == COLUMNS
    assert first[:2] == ['a,"b"\nc', "row"]
    assert [float(value) for value in first[2:7]] == [-10.0, 20.0, 10.05, 20.0, 0.05]
    assert first[7:] == ["r1", "2023-11-14T22:13:20Z", ""]
    assert second[0] == "by hand" and second[-1] == "2023-11-14T22:14:20Z"


def test_no_name_in_the_csv_is_a_formula_to_a_spreadsheet(page, tmp_path):
    page.placements = [placed(1, "=cmd()")]
    page.save(str(tmp_path / "placed.csv"))
    assert "\n'=cmd(),row," in (tmp_path / "placed.csv").read_text(encoding="utf-8-sig")


def test_what_was_written_is_told_and_what_cannot_be_written_harms_no_older_file(
    page, iface, tmp_path, monkeypatch
):
    told = []
    page._desk.info.connect(told.append)
    target = tmp_path / "placed.csv"
    page.save(str(target))
    assert told == [f"2 cones written to {target}"]
    before = target.read_bytes()

    def full(_descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    page.save(str(target))
    assert any(f"{target} was not written" in text for text in iface.texts())
    assert (target.read_bytes(), len(told)) == (before, 1)


@pytest.fixture
def processing(qgis_processing):
    """QGIS's Processing, which can be imported once QGIS is there."""
    import processing

    return processing


@pytest.fixture
def dialogs(monkeypatch, processing):
    """Catch what is asked of Processing's dialogs: the algorithm and its parameters."""
    asked = []

    def dialog(algorithm, parameters):
        asked.append((algorithm, parameters))
        return QDialog()

    monkeypatch.setattr(processing, "createAlgorithmDialog", dialog)
    return asked


def test_the_report_takes_the_layer_of_placed_cones_as_it_is(page, processing, dialogs, tmp_path):
    QTest.mouseClick(page.report, Qt.MouseButton.LeftButton)
    ((algorithm, parameters),) = dialogs
    told = processing.run(algorithm, {**parameters, "OUTPUT": str(tmp_path / "report.pdf")})
    assert (told["CONE_COUNT"], told["WITHIN_COUNT"], told["WARNING_COUNT"]) == (2, 2, 0)
    assert told["MAX"] == pytest.approx(0.05)
    layer = QgsProject.instance().mapLayer(parameters["INPUT"])
    first, second = (feature.attributeMap() for feature in layer.getFeatures())
    assert (first["planned_easting"], first["northing"]) == (488010.0, 5190020.0)
    assert (first["placed_at"], second["cone"]) == ("2023-11-14T22:13:20Z", "by hand")


def test_cones_placed_while_the_panel_was_closed_are_shown_when_it_opens(panel, gateway, wait):
    panel.tabs.setCurrentWidget(panel.placed)
    panel.placed.which.setCurrentIndex(panel.placed.which.findText("everything"))
    panel.close()
    gateway.tell("placement", to_json(placed(1)))
    wait(lambda: len(panel._desk.state.placed_cones) == 1, 10, "the placed cone")
    assert panel.placed.rows.rowCount() == 0
    panel.show()
    assert panel.placed.rows.rowCount() == 1


def test_cones_that_come_in_leave_the_rows_before_them_as_they_are(qgis_app):
    model, changes = PlacedModel(), []
    model.modelReset.connect(lambda: changes.append("all"))
    model.dataChanged.connect(lambda *_: changes.append("changed"))
    model.rowsInserted.connect(lambda _, first, last: changes.append(("in", first, last)))
    model.rowsRemoved.connect(lambda _, first, last: changes.append(("out", first, last)))
    ones = [placed(number, f"c{number}") for number in range(6)]

    def shown(rows):
        changes.clear()
        model.show_placed(rows)
        assert [model.index(k, 0).data() for k in range(model.rowCount())] == [one.cone for one in rows]
        return list(changes)

    assert shown(ones[:3]) == ["all"]
    assert shown(ones[:5]) == [("in", 3, 4)]
    assert shown(ones[:5]) == []
    assert shown(ones[2:]) == [("out", 0, 1), ("in", 3, 3)]
    collected = [replace(ones[2], collected_at=1_700_000_060.0), *ones[3:]]
    assert shown(collected) == ["changed"]
    assert shown(ones[4:]) == [("out", 0, 1)]
    assert shown([]) == ["all"]


def test_of_the_plan_that_is_driven_its_cones_alone_are_collected(page, panel, gateway, wait):
    """It may have several layouts, or none; and cones of its layout may be of another plan."""
    ones = [placed(1), placed(2, layout="another"), placed(3, plan="before")]
    gateway.answers["get_placements"] = lambda _: {"result": {"placements": [to_json(one) for one in ones]}}
    press(panel, "fleet_placed_refresh")
    wait(lambda: len(panel._desk.state.placed_cones) == 3, 10, "the placed cones")
    page.show_plan("p", 2)
    page.which.setCurrentIndex(page.which.findText("the plan that is driven"))
    task = {"task": "t", "kind": "collect", "x": 75.0, "y": 40.0}
    stands = [
        {**task, "task": f"collected-{number}", "cone": f"c{number}", "placement": number}
        for number in (1, 2, 3)
    ]
    gateway.answers["collect_layout"] = lambda params: {"result": {"tasks": stands, "in_queues": 0}}
    made, refused = [], []
    panel.collecting._drafts.make_collecting = lambda tasks, preview: made.append(tasks)
    panel.collecting.refused.connect(refused.append)
    press(panel, "fleet_placed_collect")
    wait(lambda: made or refused, 3, "the draft")
    assert refused == []
    assert [one.placement for one in made.pop()] == [1, 2]
    page.show_plan("q", 2)
    press(panel, "fleet_placed_collect")
    wait(lambda: refused, 10, "the refusal")
    assert made == [] and refused[0].startswith("No cone of this plan stands that could be collected")


def test_there_is_no_report_of_no_cone(panel, dialogs):
    panel.tabs.setCurrentWidget(panel.placed)
    assert panel.placed.report.isVisible() and not panel.placed.report.isEnabled()


def test_a_layer_that_was_taken_out_is_there_again(page, dialogs):
    QTest.mouseClick(page.report, Qt.MouseButton.LeftButton)
    QgsProject.instance().removeMapLayer(dialogs.pop()[1]["INPUT"])
    QTest.mouseClick(page.report, Qt.MouseButton.LeftButton)
    ((_, parameters),) = dialogs
    assert QgsProject.instance().mapLayer(parameters["INPUT"]).featureCount() == 2


def test_without_processing_it_is_said_what_to_do(page, iface, processing, monkeypatch):
    monkeypatch.delattr(processing, "createAlgorithmDialog")
    QTest.mouseClick(page.report, Qt.MouseButton.LeftButton)
    assert any("switch that on in Plugins > Manage" in text for text in iface.texts())
