"""A robot that an administrator removes on the command line is gone from desks, and stays so at a restart."""

from __future__ import annotations

from tests.support.robots.robot_wires import RobotWire


def plugged(bridge, name, **options) -> RobotWire:
    robot = bridge.robot(name, **options)
    robot.plug_in(1)
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0})
    return robot


def is_without_r1(told):
    """Tell whether r1 is told to be gone; a desk that a busy gateway was late for is told who is left."""
    left = [robot["robot"] for robot in told["robots"]]
    return told.get("removed") == ["r1"] or (told.get("everything") and left == ["r2"])


def test_a_robot_that_is_removed_is_gone_from_the_desks_and_stays_gone(
    start_bridge, sample_site, accounts_of
):
    bridge = start_bridge(sample_site)
    for name in ("r1", "r2"):
        plugged(bridge, name)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 10})
    desk.wait_for_robots("r1", "r2")
    desk.send("command-0001", "r1", "SetPosEnd", x=30.0, y=8.0)
    accounts_of(bridge).do("robots", "remove", "r1")
    desk.until(lambda: any(map(is_without_r1, desk.snapshots)))
    failed = desk.wait_for_step("command-0001", "failed")
    assert failed["steps"][-1]["reason"] == "the robot was removed"
    assert [robot["robot"] for robot in desk.ask("get_positions")["robots"]] == ["r2"]
    bridge.kill_gateway()
    bridge.start_gateway()
    everything = bridge.desk("Bob").ask("get_positions")
    assert (everything["everything"], [robot["robot"] for robot in everything["robots"]]) == (True, ["r2"])
