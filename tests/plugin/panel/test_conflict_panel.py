"""The rows of robots that will be in each other's way."""

from __future__ import annotations

import time

import pytest
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QListWidget, QToolButton

from tests.support.patience import BUSY

LEFT = Qt.MouseButton.LeftButton


def meeting(robot, other, kind="head-on", x=50.0):
    at = time.time() + 20.0
    where = {"x": x, "y": 40.0, "metres": 0.4}
    return {"robot": robot, "other": other, "kind": kind, "begins": at, "nearest_at": at, **where}


@pytest.fixture
def tell(at_desk, gateway, wait):
    """Tell the desk of conflicts and of who waits, and wait until it knows them."""

    def told(*conflicts, waiting=()):
        gateway.tell("conflicts", {"t": time.time(), "conflicts": list(conflicts), "waiting": list(waiting)})
        known = at_desk.desk.state
        wait(lambda: [one.x for one in known.conflicts.conflicts] == [one["x"] for one in conflicts])

    return told


def texts(window):
    return window.dock.conflict_panel.texts()


def rows(window):
    return window.dock.conflict_panel.findChild(QListWidget, "fleet_conflict_list")


def choose(window, row):
    view = rows(window)
    QTest.mouseClick(view.viewport(), LEFT, pos=view.visualItemRect(view.item(row)).center())


def gives_way(window, robot):
    return window.dock.findChild(QToolButton, f"fleet_give_way_{robot}")


@pytest.fixture
def conflicts(at_desk):
    """The desk with the page of conflicts before the operator."""
    at_desk.dock.tabs.setCurrentWidget(at_desk.dock.conflict_panel)
    return at_desk


def test_each_kind_is_told_with_place_and_robots(conflicts, tell):
    kinds = ("head-on", "crossing", "following", "standing")
    tell(*(meeting("r1", f"r{k}", kind) for k, kind in enumerate(kinds, start=2)))
    ends = {text.partition("  ")[2] for text in texts(conflicts)}
    assert ends == {f"r1 × r{k}: {kind} at 50, 40 m" for k, kind in enumerate(kinds, start=2)}


def test_every_conflict_is_listed_with_who_waits(conflicts, tell):
    holds = {"until": time.time() + 5.0, "x": 1.0, "y": 2.0, "by": "anna", "command": "c1"}
    tell(
        *(meeting("robot-11", f"robot-{k}", "following", 100.0 + k) for k in range(12, 17)),
        waiting=[{"robot": "robot-9", "other": "robot-10", **holds}],
    )
    *meetings, waits = texts(conflicts)
    assert len(meetings) == 5
    assert waits.startswith("robot-9 waits for robot-10, until ")


def test_the_tab_shows_that_there_are_conflicts(at_desk, tell):
    bar, tab = at_desk.dock.tabs.tabBar(), at_desk.dock.tabs.indexOf(at_desk.dock.conflict_panel)
    plain = bar.tabTextColor(tab)
    tell(meeting("r1", "r2"))
    assert bar.tabTextColor(tab) != plain


def test_the_tab_shows_them_in_a_theme_that_colours_the_letters_of_tabs(at_desk, tell):
    """As QGIS's themes Night Mapping and Blend of Gray do."""
    at_desk.dock.window().setStyleSheet("QTabBar::tab { color: #eeeeee; background-color: #323232; }")
    bar, tab = at_desk.dock.tabs.tabBar(), at_desk.dock.tabs.indexOf(at_desk.dock.conflict_panel)

    def colours():
        image = bar.grab(bar.tabRect(tab)).toImage()
        return {image.pixelColor(x, y).name() for x in range(image.width()) for y in range(image.height())}

    plain = colours()
    tell(meeting("r1", "r2"))
    assert bar.tabTextColor(tab).name() in colours() - plain
    tell()
    assert colours() == plain


def test_the_map_keeps_its_width_whatever_the_panel_has_to_tell(conflicts, tell, gateway, iface, wait):
    """It would move beneath the mouse of who is about to click, and be drawn again."""
    before = iface.canvas.width()
    names = [f"robot-{k}" for k in range(10, 18)]
    holds = {"until": time.time() + 5.0, "x": 1.0, "y": 2.0, "by": "anna", "command": "c1"}
    tell(
        *(meeting("robot-10", name, "following", 100.0) for name in names[1:]),
        waiting=[{"robot": name, "other": "robot-10", **holds} for name in names[1:]],
    )
    gateway.stand(in_force=True, stop="s1", at=time.time(), by="anna", waiting=names, refused=names)
    wait(lambda: conflicts.dock.banner.isVisible(), what="the banner")
    QTest.qWait(100)
    assert iface.canvas.width() == before


def test_a_button_that_is_held_down_outlasts_news_of_the_same_conflict(conflicts, tell, gateway, wait):
    tell(meeting("r1", "r2"))
    button = gives_way(conflicts, "r2")
    QTest.mousePress(button, LEFT)
    tell(meeting("r1", "r2", x=51.0))
    assert "at 51, 40 m" in texts(conflicts)[0]
    QTest.mouseRelease(button, LEFT)
    wait(lambda: gateway.requests_of("resolve_conflict"), what="the request")
    assert gateway.requests_of("resolve_conflict")[-1]["robot"] == "r2"


def test_a_more_urgent_conflict_leaves_rows_and_buttons_to_the_one_that_was_chosen(
    conflicts, tell, gateway, wait
):
    tell(meeting("r1", "r2"))
    button = gives_way(conflicts, "r2")
    where = button.mapToGlobal(button.rect().center())
    tell(meeting("r3", "r4", x=51.0), meeting("r1", "r2"))
    assert [text.split("  ")[1].split(":")[0] for text in texts(conflicts)] == ["r1 × r2", "r3 × r4"]
    assert gives_way(conflicts, "r2").mapToGlobal(button.rect().center()) == where
    QTest.mouseClick(button, LEFT)
    wait(lambda: gateway.requests_of("resolve_conflict"), what="the request")
    asked = gateway.requests_of("resolve_conflict")[-1]
    assert (asked["robot"], asked["other"]) == ("r2", "r1")


def test_a_button_stays_its_robot_s_when_the_other_one_is_told_first(conflicts, tell, gateway, wait):
    tell(meeting("r1", "r2", "crossing"))
    where = gives_way(conflicts, "r1").geometry()
    QTest.mousePress(gives_way(conflicts, "r1"), LEFT)
    # r1 has come to its end: one that stands is named as the other.
    tell(meeting("r2", "r1", "standing", x=51.0))
    assert gives_way(conflicts, "r1").geometry() == where
    assert [text.split("  ")[1].split(":")[0] for text in texts(conflicts)] == ["r2 × r1"]
    QTest.mouseRelease(gives_way(conflicts, "r1"), LEFT)
    wait(lambda: gateway.requests_of("resolve_conflict"), what="the request")
    asked = gateway.requests_of("resolve_conflict")[-1]
    assert (asked["robot"], asked["other"]) == ("r1", "r2")


def test_buttons_of_a_conflict_that_is_over_do_nothing_for_another_one(conflicts, tell, gateway):
    tell(meeting("r1", "r2"), meeting("r3", "r4", x=51.0))
    choose(conflicts, 0)
    buttons = [gives_way(conflicts, name) for name in ("r1", "r2")]
    tell(meeting("r3", "r4", x=51.0))
    assert [button.isEnabled() for button in buttons] == [False, False]
    # What is below it stays where it is.
    assert texts(conflicts)[0] == "r1 × r2: over"
    choose(conflicts, 1)
    assert gives_way(conflicts, "r3").isEnabled()


def test_nothing_is_left_of_a_conflict_that_is_over(conflicts, tell, wait):
    tell(meeting("r1", "r2"))
    tell()
    wait(lambda: texts(conflicts) == ["No robot is in another one's way."], what="the empty list")
    assert not any(button.isEnabled() for button in conflicts.dock.conflict_panel.findChildren(QToolButton))


# --- what each of the two can do ---


def way(robot, how, possible, text, points=()):
    return {"robot": robot, "how": how, "possible": possible, "text": text, "points": list(points)}


STANDS = "r2 has no task or waits already, so it cannot give way"
NO_WAY = "r1 cannot give way to r2: neither waiting nor another way resolves it"
DRIVES = "r1 cannot go aside: r1 has a task or waits"
AWAY = "r2 goes 1.5 m aside, to (80.0, 61.5)"


@pytest.fixture
def answer(gateway):
    """Let the gateway say what r1, which drives, and r2, which stands, can do."""

    def ways_out(params):
        ways = [
            way("r1", "give way", False, NO_WAY),
            way("r2", "give way", False, STANDS),
            way("r1", "aside", False, DRIVES),
            way("r2", "aside", True, AWAY, [(80.0, 60.0), (80.0, 61.5)]),
        ]
        return {"result": {"t": time.time(), **params, "ways": ways}}

    gateway.answers["get_ways_out"] = ways_out


def button(window, name):
    return window.dock.findChild(QToolButton, name)


def test_what_cannot_work_is_disabled_with_the_reason_as_text_and_tip(conflicts, tell, answer, wait):
    tell(meeting("r1", "r2", "standing"))
    wait(lambda: button(conflicts, "fleet_aside_r2").isEnabled(), what="the answer")
    for name, why in (("give_way_r1", NO_WAY), ("give_way_r2", STANDS), ("aside_r1", DRIVES)):
        assert not button(conflicts, f"fleet_{name}").isEnabled()
        assert why in button(conflicts, f"fleet_{name}").toolTip()
    shown = conflicts.dock.findChild(QLabel, "fleet_conflict_reasons").text()
    assert shown.splitlines() == [NO_WAY, DRIVES, STANDS]
    assert AWAY in button(conflicts, "fleet_aside_r2").toolTip()


def test_a_robot_is_sent_aside_by_a_route_that_is_shown_first(conflicts, tell, gateway, answer, wait):
    tell(meeting("r1", "r2", "standing"))
    wait(lambda: button(conflicts, "fleet_aside_r2").isEnabled(), what="the answer")
    QTest.mouseClick(button(conflicts, "fleet_aside_r2"), LEFT)
    wait(lambda: conflicts.desk.drafts.draft is not None, what="the route")
    draft = conflicts.desk.drafts.draft
    assert (draft.robot, draft.points) == ("r2", ((80.0, 60.0), (80.0, 61.5)))
    wait(lambda: conflicts.desk.drafts.draft.is_checked, what="its check")
    assert gateway.requests_of("send") == []
    conflicts.actions.send.trigger()
    wait(lambda: gateway.requests_of("send"), what="the command")
    (sent,) = gateway.requests_of("send")
    assert (sent["robot"], sent["op"], sent["params"]["points"]) == (
        "r2",
        "SetPath",
        [[80.0, 60.0], [80.0, 61.5]],
    )


def test_either_robot_is_stopped_by_its_button(conflicts, tell, gateway, wait):
    tell(meeting("r1", "r2", "standing"))
    for robot in ("r1", "r2"):
        QTest.mouseClick(button(conflicts, f"fleet_stop_{robot}"), LEFT)
        wait(lambda: [one["robot"] for one in gateway.requests_of("pause_robot")][-1:] == [robot], what=robot)  # noqa: B023


def test_the_buttons_keep_their_places_whatever_is_known(conflicts, tell, answer, wait):
    panel = conflicts.dock.conflict_panel

    def places():
        QTest.qWait(50)
        return [one.mapToGlobal(one.rect().topLeft()) for one in panel.findChildren(QToolButton)]

    before = places()
    tell(meeting("r1", "r2", "standing"))
    assert places() == before
    wait(lambda: button(conflicts, "fleet_aside_r2").isEnabled(), what="the answer")
    assert places() == before
    tell(*(meeting(f"robot-{k}", "robot-1", x=60.0 + k) for k in range(2, 9)))
    assert places() == before
    tell()
    assert places() == before


def test_an_older_gateway_lets_give_way_be_tried_and_nobody_be_sent_aside(conflicts, tell, gateway, wait):
    gateway.refuse["get_ways_out"] = "there is no method get_ways_out"
    tell(meeting("r1", "r2"))
    shown = conflicts.dock.findChild(QLabel, "fleet_conflict_reasons")
    wait(lambda: "Nobody can be sent aside: there is no method get_ways_out" in shown.text(), what="why")
    assert gives_way(conflicts, "r1").isEnabled() and gives_way(conflicts, "r2").isEnabled()
    assert not button(conflicts, "fleet_aside_r1").isEnabled()


def test_what_the_robots_can_do_is_asked_again_while_somebody_looks(
    conflicts, tell, gateway, wait, monkeypatch
):
    monkeypatch.setattr("fleet_supervisor.plugin.panel.conflict_panel.ASK_EVERY", 0.2)
    tell(meeting("r1", "r2"))
    wait(lambda: len(gateway.requests_of("get_ways_out")) >= 3, what="three questions")
    assert gateway.requests_of("get_ways_out")[-1] == {"robot": "r1", "other": "r2"}
    conflicts.dock.tabs.setCurrentIndex(0)
    conflicts.desk.abort_all()
    wait(lambda: gateway.requests_of("abort_all"), what="all that was asked before")
    asked = len(gateway.requests_of("get_ways_out"))
    QTest.qWait(600)
    assert len(gateway.requests_of("get_ways_out")) == asked


def test_two_that_meet_in_another_way_are_asked_about_at_once(conflicts, tell, gateway, wait):
    tell(meeting("r1", "r2", "standing"))
    wait(lambda: len(gateway.requests_of("get_ways_out")) == 1, what="the question")
    tell(meeting("r1", "r2", "head-on", x=51.0))
    wait(lambda: len(gateway.requests_of("get_ways_out")) == 2, 2.0 / BUSY, what="another question")


def test_what_is_known_of_one_pair_is_not_said_of_another(conflicts, tell, gateway, answer, wait):
    tell(meeting("r1", "r2", "standing"), meeting("r5", "r2", "standing", x=51.0))
    wait(lambda: button(conflicts, "fleet_aside_r2").isEnabled(), what="the answer")
    gateway.mute.add("get_ways_out")
    choose(conflicts, 1)
    # The place off the way of r1 may lie on that of r5.
    assert not button(conflicts, "fleet_aside_r2").isEnabled()
    assert gives_way(conflicts, "r5").isEnabled() and gives_way(conflicts, "r2").isEnabled()
