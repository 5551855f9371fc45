"""The geofence of two gateways: each judges and stops its own robots, and operators at both see all."""

from __future__ import annotations

import pytest

from tests.support.bridge.gateway_pair import GatewayPair, desk_at

IN_THE_BASIN = 66.0, 32.0


@pytest.fixture(scope="module")
def pair(start_bridge, limited_site, fleet_url, nats, tmp_path_factory):
    site = limited_site('[geofence]\nin_keepout = "abort"\n')
    return GatewayPair(start_bridge, site, fleet_url, tmp_path_factory.mktemp("state"), "--bus", nats.url)


def alarms(desk):
    return {one["robot"]: one for one in desk.geofence.get("alarms", [])}


def test_a_robot_that_was_stopped_at_one_is_seen_at_the_other_and_drives_out_there(pair):
    robot, desk = pair.robot(pair.a, "r1", at=IN_THE_BASIN), desk_at(pair.b)
    assert not robot.hear("Abort")["emergency"]
    desk.until(lambda: alarms(desk).get("r1", {}).get("outcome") == "aborted")
    seen = alarms(desk)["r1"]
    assert (seen["kind"], seen["name"], seen["action"]) == ("keepout", "Water basin", "abort")
    # It goes on at the other gateway: it is in the same keepout, and has been stopped for that.
    robot.close()
    robot = pair.robot(pair.b, "r1", at=IN_THE_BASIN)
    desk.until(lambda: desk.robots["r1"]["link"] != "gateway a" and "r1" in alarms(desk))
    out = desk.ask(
        "send",
        {
            "command": "drive-out-1",
            "robot": "r1",
            "op": "SetPosEnd",
            "params": {"x": 56.0, "y": 22.0},
            "override": "it is in a keepout; because: it has to come out",
        },
    )
    assert out["state"] == "queued"
    robot.hear("SetPosEnd")
    robot.tell("SendPos", {"x": 60.0, "y": 22.0, "theta": 0.0, "v": 1.0})
    desk.until(lambda: "r1" not in alarms(desk))
    robot.tell("SendPos", {"x": 56.0, "y": 22.0, "theta": 0.0, "v": 0.0})
    desk.wait_for_step("drive-out-1", "reached")
