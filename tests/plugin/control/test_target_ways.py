"""The way to a cone target: drawn as it is sent, checked before, found again as the robot moves."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.control.pending_command import CONE, ApproachKind, PendingCommand
from fleet_supervisor.plugin.control.request_tracker import SLOW_AFTER
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtCore import QEvent, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication

AT, GOAL = (50.0, 40.0), (70.0, 60.0)
CORNER = [50.0, 60.0]
BETWEEN = "Polygon ((58 48, 62 48, 62 52, 58 52, 58 48))"
"""On the straight line from AT to GOAL, and off the way by CORNER."""


@pytest.fixture
def site(site):
    return replace(site, roads=True)


class Roads:
    """A gateway whose ways lead round a corner; ``note`` and ``refusal`` make them something else."""

    def __init__(self, hand, gateway, make_robot):
        self.hand, self.gateway, self.make_robot = hand, gateway, make_robot
        self.note = self.refusal = ""
        gateway.answers["get_route"] = self._answer
        gateway.answers["add_tasks"] = lambda _params: {"result": {"revision": 1}}

    def _answer(self, params):
        if self.refusal:
            return {"error": {"code": -32000, "message": self.refusal}}
        robot = self.gateway.robots[params.get("robot", "r1")]
        start, goal = params.get("start", [robot.x, robot.y]), [params["x"], params["y"]]
        points = [start, goal] if self.note else [start, CORNER, goal]
        return {"result": {"points": points, "metres": 40.0, "seconds": 30.0, "note": self.note}}

    def declare(self, paths, **where):
        robot = replace(self.gateway.robots["r1"], paths=paths, **where)
        self.gateway.show(robot)
        picture, clock = self.hand.window.desk.state.robots, self.hand.window.desk.clock
        told = robot.x, robot.y, paths

        def is_told():
            report = picture.view("r1", clock.steady()).report
            return (report.x, report.y, report.paths) == told

        self.hand.wait(is_told, what="where r1 is, and what it declared")
        return self

    @property
    def draft(self):
        return self.hand.drafts.draft

    def click(self, place=GOAL, *modifiers):
        self.hand.take("cone")
        held = Qt.KeyboardModifier.NoModifier
        for modifier in modifiers:
            held |= modifier
        view = self.hand.iface.canvas.viewport()
        QTest.mouseClick(view, Qt.MouseButton.LeftButton, held, self.hand.iface.pixel(*place))
        self.settle()
        return self.draft

    def settle(self):
        self.hand.wait(self._is_settled, what="the way to the target")

    def _is_settled(self):
        draft = self.draft
        return draft is None or (draft.way.kind is not ApproachKind.SOUGHT and draft.is_checked)


@pytest.fixture
def roads(hand, gateway, make_robot):
    return Roads(hand, gateway, make_robot)


def rounded(points):
    return [tuple(round(v) for v in point) for point in points]


@pytest.mark.parametrize("paths", ["cones", "asks and cones"])
def test_the_way_that_is_drawn_is_what_is_sent_with_the_cone_at_its_end(roads, paths):
    draft = roads.declare(paths).click()
    assert rounded(draft.outline) == [AT, tuple(CORNER), GOAL]
    assert "Cone for r1 at" in roads.hand.draft_text and "along the roads 40.0 m" in roads.hand.draft_text
    roads.hand.key(Qt.Key.Key_Return)
    sent = roads.hand.sent()
    assert (sent["op"], sent["params"]["cone"]) == ("SetPath", True)
    assert sent["params"]["points"] == [list(point) for point in draft.outline]


def test_a_robot_that_asks_for_its_path_is_sent_the_target_and_shown_the_way(roads):
    draft = roads.declare("asks").click()
    assert rounded(draft.outline) == [AT, tuple(CORNER), GOAL]
    roads.hand.key(Qt.Key.Key_Return)
    sent = roads.hand.sent()
    assert (sent["op"], sent["params"]["cone"]) == ("SetPosEnd", True)


def test_one_that_declared_nothing_is_shown_straight_and_told_so(roads, gateway):
    draft = roads.click()
    assert (draft.way.kind, rounded(draft.way.line)) == (ApproachKind.STRAIGHT, [AT, GOAL])
    assert gateway.requests_of("get_route") == []
    assert "r1 has not declared that it asks for its path" in roads.hand.draft_text
    roads.hand.key(Qt.Key.Key_Return)
    assert roads.hand.sent()["op"] == "SetPosEnd"


@pytest.mark.parametrize("role", ["keepout", "obstacle"])
def test_what_is_on_the_straight_way_is_named_and_keeps_it_here_unless_overridden(roads, layer_of, role):
    layer_of("Polygon", BETWEEN, role=role, names=["Basin"])
    draft = roads.click()
    assert roads.hand.complained("Basin. Choose a place or way")
    assert "The way to (69." in roads.hand.draft_text and draft.can_be_overridden
    roads.hand.key(Qt.Key.Key_Return)
    assert roads.hand.nothing_sent()
    # By the road it is another way, and a task of a queue is driven from elsewhere.
    roads.hand.push("fleet_enqueue")
    roads.hand.wait(lambda: roads.gateway.requests_of("add_tasks"), what="the task")


@pytest.mark.parametrize("role", ["keepout", "obstacle"])
def test_along_the_roads_what_lies_straight_ahead_is_no_matter(roads, layer_of, role):
    layer_of("Polygon", BETWEEN, role=role, names=["Basin"])
    assert roads.declare("cones").click().fault is None


def test_a_keepout_of_the_project_on_the_way_along_the_roads_is_named(roads, layer_of):
    layer_of("Polygon", "Polygon ((49 50, 51 50, 51 52, 49 52, 49 50))", role="keepout", names=["New pit"])
    roads.declare("cones").click()
    assert "enters the keepout New pit" in roads.hand.draft_text


def test_what_is_at_the_target_is_named_once(roads, layer_of):
    layer_of("Polygon", "Polygon ((68 58, 72 58, 72 62, 68 62, 68 58))", role="keepout", names=["Pit"])
    assert len(roads.click().findings.overridable) == 1


def test_with_shift_it_is_straight_for_any_robot(roads, layer_of):
    layer_of("Polygon", BETWEEN, role="keepout", names=["Basin"])
    draft = roads.declare("cones").click(GOAL, Qt.KeyboardModifier.ShiftModifier)
    assert (draft.way.kind, draft.is_direct) == (ApproachKind.STRAIGHT, True)
    assert "keepout Basin" in roads.hand.draft_text
    roads.hand.key(Qt.Key.Key_Left, Qt.KeyboardModifier.ControlModifier)
    assert roads.draft.is_direct
    assert roads.click().way.kind is ApproachKind.PATH


@pytest.mark.parametrize("how", ["note", "refusal"])
def test_where_no_way_leads_the_straight_one_is_shown_with_the_reason(roads, how):
    setattr(roads, how, "no road is near")
    draft = roads.declare("cones").click()
    assert draft.way.kind is ApproachKind.STRAIGHT
    assert "No way along the roads leads there: no road is near." in roads.hand.draft_text
    roads.hand.key(Qt.Key.Key_Return)
    assert roads.hand.sent()["op"] == "SetPosEnd"


def test_one_that_asks_is_sent_nowhere_where_it_would_be_told_no_way(roads):
    roads.refusal = "closed"
    roads.declare("asks").click()
    assert "Not to be sent: No way along the roads leads there: closed." in roads.hand.draft_text
    roads.hand.key(Qt.Key.Key_Return)
    assert roads.hand.nothing_sent()


def test_no_newer_question_of_the_robot_has_the_one_for_the_target_refused(roads, gateway):
    # A gateway refuses a get_route that waits when a newer one of the same robot comes.
    roads.declare("cones").click()
    asked = gateway.requests_of("get_route")
    assert [one for one in asked if "start" in one and "robot" not in one] != []


def test_a_send_before_the_way_is_known_is_done_when_it_is(roads, gateway):
    roads.declare("cones")
    gateway.mute.add("get_route")
    roads.hand.take("cone").click(GOAL)
    assert "the way there is being found" in roads.hand.draft_text
    QTest.keyClick(roads.hand.iface.canvas, Qt.Key.Key_Return)
    assert roads.hand.nothing_sent()
    desk = roads.hand.window.desk
    assert desk.sending.awaits_way
    assert "It goes out when that is found" in roads.hand.draft_text
    gateway.mute.clear()
    desk.target_ways._pending = None
    assert roads.hand.sent()["op"] == "SetPath"
    roads.hand.wait(lambda: roads.draft is None, what="the draft to be gone")
    assert not desk.sending.awaits_way


def test_it_goes_out_though_another_target_is_set_meanwhile(roads, gateway):
    roads.declare("cones")
    gateway.mute.add("get_route")
    roads.hand.take("cone").click(GOAL)
    QTest.keyClick(roads.hand.iface.canvas, Qt.Key.Key_Return)
    gateway.mute.clear()
    roads.hand.take("cone", "r2").click((90.0, 70.0))
    roads.hand.wait(lambda: gateway.requests_of("send"), what="the first")
    sent = gateway.requests_of("send")[-1]
    assert (sent["robot"], sent["op"]) == ("r1", "SetPath")
    assert roads.draft.robot == "r2"


@pytest.mark.parametrize("stop", ["abort", "abort_all", "emergency_stop"])
def test_who_lets_robots_stop_meanwhile_sends_it_no_more(roads, gateway, stop):
    roads.declare("cones")
    gateway.mute.add("get_route")
    roads.hand.take("cone").click(GOAL)
    QTest.keyClick(roads.hand.iface.canvas, Qt.Key.Key_Return)
    desk = roads.hand.window.desk
    {"abort": desk.abort_selected}.get(stop, getattr(desk, stop, None))()
    gateway.mute.clear()
    desk.target_ways._pending = None
    roads.settle()
    QTest.qWait(200)
    assert [one for one in gateway.requests_of("send") if one["op"] != "Abort"] == []


def test_a_gateway_that_does_not_answer_keeps_the_target_here(roads, gateway, monkeypatch):
    roads.declare("cones")
    gateway.mute.add("get_route")
    roads.hand.take("cone").click(GOAL)
    ways = roads.hand.window.desk.target_ways
    now = ways._clock
    monkeypatch.setattr(ways, "_clock", SimpleNamespace(steady=lambda: now.steady() + SLOW_AFTER + 1))
    roads.settle()
    assert "The gateway does not answer which way leads there" in roads.hand.draft_text
    assert roads.draft.fault is not None


def test_the_way_follows_a_robot_that_moves(roads):
    roads.declare("cones").click()
    roads.declare("cones", x=50.0, y=45.0)
    roads.hand.wait(lambda: rounded(roads.draft.outline)[0] == (50, 45), what="the way from there")
    roads.settle()
    roads.hand.key(Qt.Key.Key_Return)
    assert rounded(roads.hand.sent()["params"]["points"])[0] == (50, 45)


def test_so_does_the_straight_one(roads, layer_of):
    layer_of("Polygon", BETWEEN, role="keepout", names=["Basin"])
    roads.click()
    roads.declare(None, x=70.0, y=40.0)
    roads.hand.wait(lambda: rounded(roads.draft.way.line)[0] == (70, 40), what="the way from there")
    roads.settle()
    assert "Basin" not in roads.hand.draft_text


def test_a_way_that_its_robot_has_left_is_not_sent(roads, monkeypatch):
    roads.declare("cones").click()
    monkeypatch.setattr(roads.hand.window.desk.target_ways, "watch", lambda: None)
    roads.declare("cones", x=50.0, y=45.0)
    roads.hand.window.desk.sending.send()
    assert roads.hand.complained("r1 has moved since its way was found")
    assert roads.hand.nothing_sent()


def test_the_way_to_the_mouse_goes_with_whatever_makes_it_untrue(roads, gateway):
    desk, view = roads.hand.window.desk, roads.hand.iface.canvas.viewport()
    roads.declare("cones").hand.take("cone")
    way = roads.hand.iface.canvas.mapTool()._way

    def shown():
        desk.selection.select("r1")
        # One pixel beside where it was, so that the mouse has moved.
        roads.hand.move(70, 60)
        roads.hand.move(71, 60)
        roads.hand.wait(lambda: way.line, what="the way to the mouse")

    def leave():
        QApplication.sendEvent(view, QEvent(QEvent.Type.Leave))

    def send():
        desk.target_ways.set_command(PendingCommand("r1", CONE, (GOAL,)))
        roads.settle()
        desk.sending.send()
        roads.hand.wait(lambda: roads.draft is None, what="the draft to be gone")

    for go in (leave, desk.abort_selected, desk.abort_all, desk.emergency_stop, send):
        shown()
        go()
        assert way.line == [], go
        QTest.qWait(100)
        assert way.line == [], f"{go}: it came back"
    shown()
    desk.selection.select(None)
    assert way.line == []
    shown()
    gateway.stop()
    roads.hand.wait(lambda: not way.line, what="the way to be gone with the link")


def test_it_is_thinner_than_any_way_and_follows_its_robot(roads):
    roads.declare("cones").hand.take("cone")
    way = roads.hand.iface.canvas.mapTool()._way
    roads.hand.move(70, 60)
    roads.hand.wait(lambda: way.line, what="the way to the mouse")
    assert way._band.width() == 2
    assert way._band.strokeColor().alpha() < 255
    before = way.line[0]
    roads.declare("cones", x=50.0, y=45.0)
    roads.hand.wait(lambda: way.line and way.line[0] != before, what="the way from where r1 is now")


def test_what_the_log_says_of_a_cone_with_a_path(roads, gateway):
    roads.declare("cones").click()
    roads.hand.key(Qt.Key.Key_Return)
    command = roads.hand.sent()["command"]
    gateway.step(command, CommandState.DELIVERED, "gateway")
    gateway.step(command, CommandState.ACKNOWLEDGED, "r1")
    from fleet_supervisor.plugin.gateway_client.command_cache import command_in_words

    desk = roads.hand.window.desk
    roads.hand.wait(lambda: command in desk.state.commands, what="the report")
    assert command_in_words(desk.state.commands.get(command)).startswith("cone at 69.9")


def test_the_target_of_an_unplaced_robot_says_that_nobody_looked_at_its_way(roads):
    gateway = roads.gateway
    gateway.show(replace(roads.make_robot("r9"), x=None, y=None, theta=None, v=None))
    desk = roads.hand.window.desk
    roads.hand.wait(lambda: desk.state.robots.view("r9", desk.clock.steady()) is not None, what="r9")
    roads.hand.take("cone", "r9").click(GOAL)
    assert "It is not known where r9 is, so nobody has looked at the way" in roads.hand.draft_text


@pytest.mark.parametrize("role", ["keepout", "obstacle"])
def test_what_is_on_the_way_to_where_a_route_begins_keeps_it_here_unless_overridden(roads, layer_of, role):
    layer_of("Polygon", BETWEEN, role=role, names=["Basin"])
    roads.declare("asks and cones").hand.take("route").click(GOAL, (90, 60))
    draft = roads.draft
    (text,) = draft.findings.overridable
    assert text.startswith("The way to (") and "Basin. Choose a place or way" in text
    assert draft.can_be_overridden
    roads.hand.key(Qt.Key.Key_Return)
    assert roads.hand.nothing_sent()
    # A task of a queue is driven when its robot stands at the beginning.
    roads.hand.push("fleet_enqueue")
    roads.hand.wait(lambda: roads.gateway.requests_of("add_tasks"), what="the task")


def test_it_is_looked_at_again_as_the_robot_moves_and_the_leg_to_the_mouse_stays(roads, layer_of):
    layer_of("Polygon", BETWEEN, role="keepout", names=["Basin"])
    roads.hand.take("route").click(GOAL, (90, 60))
    assert roads.draft.fault
    roads.hand.drafts.point_at((95.0, 50.0))
    roads.declare(None, x=70.0, y=40.0)
    roads.hand.wait(lambda: roads.draft.fault is None, what="a way beside the keepout")
    assert roads.draft.way.line == ((70.0, 40.0), roads.draft.points[0])
    assert roads.hand.drafts.cursor == (95.0, 50.0)


def test_the_route_of_a_robot_that_stands_where_it_begins_is_looked_at_alone(roads, layer_of):
    layer_of("Polygon", "Polygon ((49.9 38, 50.1 38, 50.1 39.9, 49.9 39.9, 49.9 38))", role="obstacle")
    roads.hand.take("route").click((50.2, 40.3), (50, 60))
    assert roads.draft.fault is None
