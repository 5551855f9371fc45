"""What a draft is held against before it is sent, and overriding that."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from fleet_supervisor.robot_bridge.core.messages.records import PlacementReport
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.core import QgsCoordinateReferenceSystem, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDialog, QLineEdit, QPushButton

YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
"""A CRS of its own, of which nobody knows where on the Earth it is."""
SQUARE = "Polygon ((60 50, 80 50, 80 60, 60 60, 60 50))"


@pytest.fixture
def cone(hand):
    return hand.take("cone")


@pytest.mark.parametrize("role", ["obstacle", "furniture", "stairs"])
def test_a_target_on_an_obstacle_is_refused_and_the_feature_named(cone, layer_of, role):
    layer_of("Polygon", SQUARE, role=role, names=["Hall 3"])
    cone.click((70, 55))
    assert cone.complained("is on Hall 3. Choose a place or way beside it.")
    assert "Not to be sent" in cone.draft_text
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()
    assert cone.points is not None
    cone.click((50, 70))
    assert "Not to be sent" not in cone.draft_text


@pytest.mark.parametrize("role", ["keepout", "obstacle", "road_surface"])
@pytest.mark.parametrize("name", ["bays.gpkg", "bays.geojson"])
def test_a_layer_whose_file_goes_while_it_is_open_keeps_the_draft_here(
    cone, layer_of, save_layer, tmp_path, role, name
):
    drawn = layer_of("Polygon", SQUARE)
    layer = save_layer(drawn, name)
    layer.setName("Bays")
    layer.setCustomProperty("fleet/role", role)
    QgsProject.instance().removeMapLayer(drawn.id())
    QgsProject.instance().addMapLayer(layer)
    (tmp_path / name).rename(tmp_path / "elsewhere")
    assert layer.isValid() and layer.featureCount() == 1
    cone.click((20, 20))
    assert cone.complained("The layer Bays cannot be read, so what is in it was not looked at.")
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()
    (tmp_path / "elsewhere").rename(tmp_path / name)
    cone.click((30, 20))
    assert "cannot be read" not in cone.draft_text


@pytest.mark.parametrize("name", ["bays.gpkg", "bays.geojson"])
def test_a_layer_whose_file_goes_is_not_read_from_what_qgis_still_has_open(
    cone, layer_of, save_layer, tmp_path, name
):
    layer = save_layer(layer_of("Polygon", SQUARE), name)
    layer.setName("Bays")
    layer.setCustomProperty("fleet/role", "keepout")
    QgsProject.instance().addMapLayer(layer)
    # QGIS keeps the file open for other readers for a minute.
    assert next(layer.getFeatures()).isValid()
    (tmp_path / name).rename(tmp_path / "elsewhere")
    assert next(layer.getFeatures()).isValid()
    cone.click((20, 20))
    assert cone.complained("The layer Bays cannot be read, so what is in it was not looked at.")
    (tmp_path / "elsewhere").rename(tmp_path / name)
    cone.click((30, 20))
    assert "cannot be read" not in cone.draft_text


def test_a_layer_without_a_crs_keeps_the_draft_here_wherever_the_map_draws_it(cone, layer_of):
    layer = layer_of("Polygon", SQUARE, crs="", role="keepout", name="Bays")
    assert not layer.crs().isValid()
    # In metres of the site, as surveys come: what is in it lies where nothing is looked for.
    cone.click((70, 55))
    assert cone.complained("The layer Bays has no CRS, so nobody knows where on the site it lies.")
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()
    layer.setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    cone.click((20, 20))
    assert "has no CRS" not in cone.draft_text


def test_where_no_layer_has_a_role_it_is_said_that_nobody_has_looked(cone, layer_of):
    cone.click((70, 55))
    assert "No layer of the project says where obstacles and keepouts are" in cone.draft_text
    layer_of("Polygon", SQUARE, role="keepout")
    cone.click((20, 20))
    assert "No layer of the project" not in cone.draft_text
    cone.key(Qt.Key.Key_Return)
    assert cone.sent()["robot"] == "r1"


@pytest.mark.parametrize("role", ["keepout", "obstacle", "road_surface"])
def test_a_layer_whose_file_is_gone_keeps_the_draft_here_unless_overridden(cone, role):
    layer = QgsVectorLayer("/nowhere/yard.gpkg|layername=bays", "Bays", "ogr")
    layer.setCustomProperty("fleet/role", role)
    QgsProject.instance().addMapLayer(layer)
    cone.click((70, 55))
    assert cone.complained("The layer Bays cannot be read, so what is in it was not looked at.")
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()
    assert cone.drafts.draft.can_be_overridden


@pytest.mark.parametrize("role", ["obstacle", "keepout"])
def test_a_layer_of_which_nobody_knows_where_it_lies_is_not_held_to_be_free(cone, layer_of, role):
    layer_of("Polygon", SQUARE, role=role, name="Bays").setCrs(QgsCoordinateReferenceSystem(YARD))
    cone.click((70, 55))
    assert cone.complained("nothing is known of how the two lie to each other")
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()


def test_a_feature_without_a_name_is_named_by_layer_and_number(cone, layer_of):
    layer_of("Polygon", SQUARE, role="obstacle", name="buildings")
    cone.click((70, 55))
    assert cone.complained("is on buildings (feature 1)")


def test_a_target_beside_a_wall_is_too_near_by_metres_whatever_the_layers_crs(cone, layer_of):
    from pyproj import Transformer

    earth = Transformer.from_crs("EPSG:32633", "EPSG:4326", always_xy=True).transform
    ends = ", ".join("{} {}".format(*earth(488000 + x, 5190000 + y)) for x, y in ((70, 40), (70, 70)))
    layer_of("LineString", f"LineString ({ends})", crs="EPSG:4326", role="obstacle", names=["Fence"])
    cone.click((70, 55))
    assert cone.complained("from Fence", "is on Fence")
    cone.click((69, 55))
    assert "Not to be sent" not in cone.draft_text


def test_half_a_robot_has_to_fit_beside_a_wall(cone, layer_of):
    layer_of("LineString", "LineString (70 40, 70 70)", role="obstacle", names=["Wall"])
    for x, is_free in ((69.8, False), (69.7, True), (70.2, False)):
        cone.iface.canvas.mapTool().add_point((x, 55.0))
        cone.wait(cone.iface.is_settled, what="the check of the draft")
        assert ("Not to be sent" not in cone.draft_text) is is_free, x
        assert ("is 0.20 m from Wall" in cone.draft_text) is not is_free, x
        assert is_free or cone.complained("is 0.20 m from Wall")


def test_a_ramp_can_be_driven_to(cone, layer_of):
    layer_of("Polygon", SQUARE, role="ramp", names=["Ramp"])
    cone.click((70, 55))
    assert "Not to be sent" not in cone.draft_text


def test_a_drawn_route_through_an_obstacle_is_refused_though_its_points_are_beside(hand, layer_of):
    layer_of("Polygon", SQUARE, role="obstacle", names=["Hall 3"])
    hand.take("route").click((50, 55), (90, 55))
    assert hand.complained("The way to")
    assert "is on Hall 3" in hand.draft_text


def test_a_drawn_leg_that_leaves_the_road_between_two_points_on_it_is_warned_of(hand, layer_of):
    box = "Polygon (({0} 20, {1} 20, {1} 80, {0} 80, {0} 20))"
    # Two surfaces with no room between, and one behind a strip of grass.
    roads = [box.format(*between) for between in ((10, 40), (40.2, 60), (70, 100))]
    layer_of("Polygon", *roads, role="road_surface")
    hand.take("route").click((20, 30), (50, 35))
    assert "road surface" not in hand.draft_text
    hand.click((80, 30))
    assert "The way to (80" in hand.draft_text and "leaves the road surface" in hand.draft_text
    hand.click((85, 60), (50, 60))
    assert "2 of 4 legs leave the road surface" in hand.draft_text
    hand.click((65, 60))
    assert "is not on a road surface" in hand.draft_text and "legs" not in hand.draft_text


def test_only_what_the_filter_of_a_layer_keeps_is_an_obstacle(cone, layer_of):
    layer = layer_of("Polygon", SQUARE, role="obstacle", names=["Hall 3"])
    layer.setCustomProperty("fleet/filter", "\"name\" <> 'Hall 3'")
    cone.click((70, 55))
    assert "Not to be sent" not in cone.draft_text


def test_a_target_too_near_to_that_of_another_robot_is_refused_and_that_one_named(cone, hand):
    cone.click((70, 55))
    cone.key(Qt.Key.Key_Return)
    cone.sent()
    cone.wait(lambda: len(cone.window.desk.state.commands) == 1)
    cone.window.desk.selection.select("r2")
    cone.click((70, 55.5))
    assert cone.complained("m from the target of r1 at ")
    assert "Not to be sent" in cone.draft_text
    cone.window.desk.selection.select("r1")
    cone.click((70, 55.5))
    assert "Not to be sent" not in cone.draft_text


def test_a_target_too_near_to_the_end_of_another_robots_route_is_refused(cone, gateway):
    from fleet_supervisor.robot_bridge.core.messages.commands import CommandState

    gateway._queue("elsewhere", "r2", "SetPath", {"points": [[20.0, 20.0], [70.0, 55.0]]})
    gateway.step("elsewhere", CommandState.DELIVERED, "r2")
    cone.wait(lambda: len(cone.window.desk.state.commands) == 1)
    cone.click((70, 55.5))
    assert "m from the end of the route of r2 at 70.00, 55.00" in cone.draft_text
    cone.click((20, 20))
    assert "Not to be sent" not in cone.draft_text
    # What has come to its end is nobody's target any more.
    gateway.step("elsewhere", CommandState.REACHED, "r2")
    cone.wait(lambda: cone.window.desk.state.commands.task_of("r2") is None)
    cone.click((70, 55.5))
    assert "Not to be sent" not in cone.draft_text


def test_a_target_where_another_robot_stands_is_warned_of(cone, gateway, make_robot, wait):
    # r2 stands at (80, 60) but says that it drives.
    cone.click((80, 60.5))
    assert "stands" not in cone.draft_text
    gateway.show(make_robot("r2", 80, 60, v=0.0))
    wait(lambda: cone.window.desk.state.report_of("r2").v == 0.0)
    # At the end of a check a robot has come to stand there that did not before.
    cone.key(Qt.Key.Key_Return)
    assert cone.complained("only now this is known: (80.")
    assert cone.nothing_sent() and "is where r2 stands." in cone.draft_text
    cone.click((80, 61.5))
    assert "stands" not in cone.draft_text
    cone.window.desk.selection.select("r2")
    cone.click((80, 60.5))
    assert "stands" not in cone.draft_text
    cone.window.desk.selection.select("r1")
    asked_for_by(gateway, "anna", "r2")
    wait(lambda: cone.window.desk.state.commands.task_of("r2") is not None)
    cone.click((80, 60.5))
    assert "stands" not in cone.draft_text


def test_a_target_where_a_cone_stands_is_warned_of_until_that_is_collected(cone, gateway, wait):
    put_down = PlacementReport(
        1, "t", "r2", 70.0, 55.0, 70.1, 55.2, theta=0.0, deviation=0.2, placed_at=1.7e9, command="c"
    )
    gateway.tell("placement", to_json(put_down))
    wait(lambda: len(cone.window.desk.state.placed_cones) == 1)
    cone.click((70, 55))
    assert "m is where a cone stands: r2 put it down at 70.10, 55.20." in cone.draft_text
    cone.key(Qt.Key.Key_Return)
    assert cone.sent()["robot"] == "r1"
    cone.click((70, 56))
    assert "stands" not in cone.draft_text
    gateway.tell("placement", to_json(replace(put_down, collected_at=1.8e9, collected_by="r1")))
    wait(lambda: all(one.collected_at for one in cone.window.desk.state.placed_cones))
    cone.click((70, 55))
    assert "stands" not in cone.draft_text


def test_a_target_where_a_cone_of_a_single_target_stands_is_warned_of(cone, gateway, wait):
    asked_for_by(gateway, "anna", "r2")
    gateway.step("of-anna", CommandState.REACHED, "r2")
    wait(lambda: cone.window.desk.state.commands.reached_by("r2") is not None)
    cone.click((90, 20.3))
    assert "m is where a cone stands: r2 put it down at 90.00, 20.00." in cone.draft_text
    cone.click((90, 21))
    assert "stands" not in cone.draft_text


def asked_for_by(gateway, operator, robot="r1"):
    report = gateway._queue(f"of-{operator}", robot, "SetPosEnd", {"x": 90.0, "y": 20.0, "cone": True})
    gateway.commands[report.command] = replace(report, operator=operator)
    gateway.step(report.command, CommandState.ACKNOWLEDGED, robot)


@pytest.fixture
def known(gateway):
    """A gateway that tells the desk who its operator is."""
    gateway.who = {"operator": "anna", "role": "operator"}


def test_a_robot_that_works_for_somebody_else_is_told_before_it_is_taken_from_them(
    known, cone, gateway, wait
):
    asked_for_by(gateway, "bert")
    wait(lambda: cone.window.desk.state.commands.task_of("r1") is not None)
    cone.click((70, 55))
    assert "r1 is at work for bert (cone at 90.00, 20.00): sending this takes its place." in cone.draft_text
    cone.key(Qt.Key.Key_Return)
    assert cone.sent()["robot"] == "r1"


def test_who_takes_it_meanwhile_is_told_in_place_of_sending(known, cone, gateway, wait):
    cone.click((70, 55))
    assert "is at work for" not in cone.draft_text
    asked_for_by(gateway, "bert")
    wait(lambda: cone.window.desk.state.commands.task_of("r1") is not None)
    cone.key(Qt.Key.Key_Return)
    assert cone.complained("only now this is known: r1 is at work for bert")
    assert cone.nothing_sent()
    cone.key(Qt.Key.Key_Return)
    assert cone.sent()["robot"] == "r1"


def test_ones_own_order_is_replaced_without_a_word(known, cone, gateway, wait):
    asked_for_by(gateway, "anna")
    wait(lambda: cone.window.desk.state.commands.task_of("r1") is not None)
    cone.click((70, 55))
    assert "is at work for" not in cone.draft_text


def test_a_draft_is_looked_at_once_more_when_it_is_sent(cone, gateway):
    from fleet_supervisor.robot_bridge.core.messages.commands import CommandState

    cone.click((70, 55))
    assert "Not to be sent" not in cone.draft_text
    # Meanwhile somebody else has sent the other robot there.
    gateway._queue("elsewhere", "r2", "SetPosEnd", {"x": 70.0, "y": 55.0})
    gateway.step("elsewhere", CommandState.DELIVERED, "r2")
    cone.wait(lambda: len(cone.window.desk.state.commands) == 1)
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()
    assert "from the target of r2" in cone.draft_text


def override(hand, why="the bay is cleared"):
    hand.push("fleet_override")
    dialog = hand.iface.findChild(QDialog, "fleet_override")
    confirm = dialog.findChild(QPushButton, "fleet_override_confirm")
    assert not confirm.isEnabled()
    QTest.keyClicks(dialog.findChild(QLineEdit, "fleet_override_why"), why)
    return confirm


def test_what_can_be_overridden_is_sent_with_what_was_found_and_why(cone, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    cone.click((70, 55))
    QTest.mouseClick(override(cone), Qt.MouseButton.LeftButton)
    assert cone.nothing_sent()
    assert "OVERRIDDEN" in cone.draft_text
    cone.key(Qt.Key.Key_Return)
    text = cone.sent()["override"]
    assert "enters the keepout Loading bay" in text
    assert text.endswith("because: the bay is cleared")


def test_an_ordinary_command_carries_no_override(cone):
    cone.click((70, 55))
    cone.key(Qt.Key.Key_Return)
    assert "override" not in cone.sent()


def test_an_override_is_gone_when_the_draft_is_moved(cone, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    cone.click((70, 55))
    QTest.mouseClick(override(cone), Qt.MouseButton.LeftButton)
    cone.click((72, 55))
    assert "Not to be sent" in cone.draft_text
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()


def test_an_override_is_gone_when_something_else_is_in_the_way(cone, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    cone.click((70, 55))
    QTest.mouseClick(override(cone), Qt.MouseButton.LeftButton)
    layer_of("Polygon", SQUARE, role="obstacle", names=["New fence"])
    cone.key(Qt.Key.Key_Return)
    assert cone.nothing_sent()
    assert "New fence" in cone.draft_text
    assert "OVERRIDDEN" not in cone.draft_text


def test_an_override_of_a_draft_that_changed_behind_the_dialog_is_none(cone, layer_of):
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    cone.click((70, 55))
    confirm = override(cone)
    cone.click((74, 55))
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    assert cone.complained("The draft has changed since it was looked at")
    assert cone.drafts.draft.override is None


def test_what_lies_outside_the_site_cannot_be_overridden(cone, iface):
    iface.look_at(-60, -60, 260, 200)
    cone.click((-20, 30))
    assert not cone.window.actions.override.isEnabled()
    assert "Override" not in cone.draft_text


def test_a_refused_override_comes_back_as_a_draft(cone, layer_of, gateway):
    gateway.refuse["send"] = "send: anna is operator, and an override takes supervisor"
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    cone.click((70, 55))
    QTest.mouseClick(override(cone), Qt.MouseButton.LeftButton)
    cone.key(Qt.Key.Key_Return)
    assert cone.complained("an override takes supervisor")
    assert cone.points[0] == pytest.approx((70, 55), abs=0.3)


def test_a_draft_for_a_robot_of_which_nothing_is_heard_says_so(hand, gateway, make_robot):
    cone = hand.take("cone")
    cone.click((20, 20))
    assert "when it is heard again" not in cone.draft_text
    gateway.show(make_robot("r1", 50, 40, age=125.0, state=RobotState.LOST))
    hand.wait(
        lambda: (
            hand.window.desk.state.robots.view("r1", hand.window.desk.clock.steady()).state is RobotState.LOST
        )
    )
    cone.click((22, 20))
    assert "r1 is lost: it is told this when it is heard again" in cone.draft_text
    assert not hand.drafts.draft.findings.refused


@pytest.mark.parametrize("how, method", [("send", "send"), ("enqueue", "add_tasks")])
def test_who_has_seen_that_a_robot_is_lost_sends_it_all_the_same(
    hand, gateway, make_robot, layer_of, how, method
):
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    gateway.show(make_robot("r1", 50, 40, age=12.0, state=RobotState.LOST))
    steady = hand.window.desk.clock.steady

    def age():
        return hand.window.desk.state.robots.view("r1", steady()).age

    hand.wait(lambda: age() >= 12.0, what="the lost robot")
    hand.take("cone").click((20, 20))
    seen = age()
    hand.wait(lambda: age() > seen + 0.2, what="the robot to be silent for longer")
    getattr(hand.window.actions, how).trigger()
    hand.wait(lambda: gateway.requests_of(method), what="the request")


def test_a_draft_of_a_robot_that_moves_meanwhile_is_overridden(cone, layer_of, gateway, make_robot):
    layer_of("Polygon", SQUARE, role="keepout", names=["Loading bay"])
    cone.click((70, 55))
    before = cone.drafts.draft
    confirm = override(cone, "the gate is open")
    gateway.show(make_robot("r1", 51, 40))
    cone.wait(
        lambda: cone.drafts.draft.way != before.way and cone.drafts.draft.is_checked, what="its new way"
    )
    QTest.mouseClick(confirm, Qt.MouseButton.LeftButton)
    assert "the gate is open" in cone.drafts.draft.override
    assert cone.drafts.draft.way.line[0] == (51, 40)
