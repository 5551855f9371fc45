"""Real robots driven into a keepout and at an obstacle: operators hear of it, and the site acts once."""

from __future__ import annotations

import itertools
import math

import pytest

from tests.support.bridge.bridge_programs import wait_until

WAYS = {
    "r1": ("keepout", "Water basin", [(66.0, 27.0), (66.0, 38.0)]),
    "r2": ("obstacle", "Control tower", [(119.0, 70.0), (133.0, 70.0)]),
}
WHERE = {"r1": "in the keepout 'Water basin'", "r2": "at the obstacle 'Control tower'"}
OUTCOMES = {"none": "none", "pause": "paused", "abort": "aborted"}
COMMANDS = itertools.count(1)


@pytest.fixture(params=["none abort", "pause none", "abort pause"])
def guarded(request, start_bridge, limited_site):
    """A gateway with one action for keepouts and another for obstacles; each action comes up for both."""
    keepout, obstacle = request.param.split()
    text = f'[geofence]\nin_keepout = "{keepout}"\nat_obstacle = "{obstacle}"\n'
    bridge = start_bridge(limited_site(text))
    bridge.actions = {"r1": keepout, "r2": obstacle}
    for robot, (_, _, way) in WAYS.items():
        bridge.start_robot(robot, (*way[0], 0.0))
    yield bridge
    bridge.end()


def send(desk, robot, points):
    command = f"command-{next(COMMANDS)}"
    params = {"points": [list(point) for point in points]}
    override = "it leads through; because: this is what is tried out"
    asked = {"command": command, "robot": robot, "op": "SetPath", "params": params, "override": override}
    desk.commands[command] = desk.ask("send", asked)
    return command


def alarm(desk, robot):
    found = {(one["robot"], one["kind"], one["name"]): one for one in desk.geofence.get("alarms", [])}
    return found.get((robot, *WAYS[robot][:2]), {})


def place(desk, robot):
    return desk.robots[robot]["x"], desk.robots[robot]["y"]


def drive_on(desk, robot, action, command):
    """Drive a robot out on the other side: it goes on, is sent anew, or was never stopped."""
    end = WAYS[robot][2][-1]
    if action == "none":
        desk.wait_for_step(command, "reached")
        return
    stopped = desk.wait_for_step(command, "aborted")
    assert WHERE[robot] in stopped["steps"][-1]["reason"]
    desk.until(lambda: desk.robots[robot]["v"] == 0.0, 15)
    assert alarm(desk, robot)["current"] is True
    assert math.dist(place(desk, robot), end) > 1.0
    if action == "abort":
        desk.wait_for_step(send(desk, robot, [place(desk, robot), end]), "reached")
        return
    queue = desk.ask("get_queue", {"robot": robot})["queues"][0]
    assert queue["reason"] == f"paused by geofence: {WHERE[robot]}"
    desk.ask("resume_queue", {"robot": robot, "revision": queue["revision"]})
    desk.until(lambda: desk.queues.get(robot, {}).get("tasks") == [], 60)


def test_robots_that_drive_in_are_told_while_they_are_there_and_stopped_once_as_the_site_says(guarded):
    desk = guarded.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots(*WAYS)
    sent = {robot: send(desk, robot, way) for robot, (_, _, way) in WAYS.items()}
    for robot, action in guarded.actions.items():
        desk.until(lambda: alarm(desk, robot).get("outcome") == OUTCOMES[action], 30)  # noqa: B023
        assert alarm(desk, robot)["action"] == action
    for robot, command in sent.items():
        drive_on(desk, robot, guarded.actions[robot], command)
    desk.until(lambda: desk.geofence["alarms"] == [], 15)
    for robot, (_, _, way) in WAYS.items():
        assert math.dist(place(desk, robot), way[-1]) < 0.3
    # The alarms of the way out were those of the way in: nobody was stopped twice.
    noted = guarded.sql("select subject, action, detail from audit where who = 'geofence' order by subject")
    acted = [(robot, what, WHERE[robot]) for robot, what in guarded.actions.items() if what != "none"]
    assert [tuple(row) for row in noted] == acted
    assert (desk.geofence["keepouts"], desk.geofence["obstacles"] > 40) == (2, True)
    guarded.robot("silent").plug_in(1)
    desk.until(lambda: desk.geofence["unjudged"] == ["silent"], 10)


def test_robots_are_stopped_with_no_desk_connected(start_bridge, limited_site):
    bridge = start_bridge(limited_site('[geofence]\nin_keepout = "abort"\nat_obstacle = "abort"\n'))
    for robot, (_, _, way) in WAYS.items():
        wire = bridge.robot(robot)
        wire.plug_in(1)
        begin, end = way
        for x, y in (begin, ((begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2)):
            wire.tell("SendPos", {"x": x, "y": y, "theta": 0.0, "v": 1.0})
        assert wire.wait_for("Abort")["params"] == {"emergency": False}

    def noted():
        rows = bridge.sql("select subject, action, detail from audit where who = 'geofence' order by subject")
        return [tuple(row) for row in rows]

    # It is written after the robot was told: nobody's stop waits for the audit log.
    wait_until(lambda: len(noted()) == len(WAYS))
    assert noted() == [(robot, "abort", WHERE[robot]) for robot in WAYS]
    bridge.end()
