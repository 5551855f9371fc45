"""The adapter's loop: what goes wrong with one robot stays there, and who has its tasks is remembered."""

from __future__ import annotations

import logging
from types import SimpleNamespace

import pytest

from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.ros.adapter import MOST_ROBOTS
from robot_bridge.links.ros.settings import LONGEST_NAME
from robot_bridge.links.ros.site_maps import MOST_GRIDS_KEPT, Grids
from robot_bridge.links.ros2 import dds
from robot_bridge.links.ros2.adapter import Ros2Adapter, Ros2Settings


class Robot:
    """A robot that does what the test says."""

    faults: tuple[str, ...] = ()

    def __init__(self, name, error=None, server=None):
        self.name, self.error, self.server = name, error, server
        self.expected = None

    def expect_server(self, server):
        self.expected = server

    def fail(self):
        raise self.error


class Link:
    """Keeps what is reported."""

    def report(self, **said):
        self.said = said


@pytest.fixture
def adapter(tmp_path):
    return Ros2Adapter(Ros2Settings(), tmp_path / "nav2.servers")


def test_what_nobody_foresaw_concerns_one_robot_and_is_logged_once(adapter, caplog):
    robot, link = Robot("r1", KeyError("odd")), Link()
    with caplog.at_level(logging.ERROR):
        adapter._lead(robot, "act", robot.fail, 1.0)
        adapter._lead(robot, "act", robot.fail, 2.0)
    adapter._report(link)
    assert len(caplog.records) == 1
    assert not link.said["ok"] and link.said["text"] == "r1: the link failed; its log says more"
    assert link.said["reached"]


def test_what_a_person_has_to_put_right_ends_the_process(adapter):
    robot = Robot("r1", LinkError("memory cannot be written"))
    with pytest.raises(LinkError):
        adapter._lead(robot, "act", robot.fail, 1.0)


def test_the_next_process_knows_who_had_a_robots_tasks(adapter, tmp_path):
    adapter._meet("r1", lambda name: Robot(name, server=bytes(range(16))))
    adapter._note_servers()
    again = Ros2Adapter(Ros2Settings(), tmp_path / "nav2.servers")
    made = []
    again._meet("r1", lambda name: made.append(Robot(name)) or made[0])
    assert made[0].expected == bytes(range(16))


def test_a_full_disk_ends_no_link_and_is_told(adapter, tmp_path, caplog):
    link, new = Link(), tmp_path / ".nav2.servers.new"
    new.symlink_to("/dev/full")
    adapter._meet("r1", lambda name: Robot(name, server=bytes(range(16))))
    for _ in range(2):
        adapter._note_servers()
    adapter._report(link)
    assert not link.said["ok"] and "No space left on device" in link.said["text"]
    assert len(caplog.records) == 1
    new.unlink()
    adapter._note_servers()
    adapter._report(link)
    assert link.said["ok"] and (tmp_path / "nav2.servers").exists()


@pytest.mark.parametrize("text", ["", "[]", "{", '{"r1": 7}', '{"r1": "zz"}'])
def test_a_file_of_servers_that_is_none_is_left_out(tmp_path, text, caplog):
    (tmp_path / "nav2.servers").write_text(text, encoding="utf-8")
    made = []
    Ros2Adapter(Ros2Settings(), tmp_path / "nav2.servers")._meet(
        "r1", lambda name: made.append(Robot(name)) or made[0]
    )
    assert made[0].expected is None and "is left out" in caplog.text


def test_a_name_that_no_robot_can_have_is_refused_once(adapter, caplog):
    adapter._meet("_hidden", Robot)
    assert "robot name '_hidden' cannot be used" in caplog.text
    assert adapter._robots == {}


def test_robots_without_end_are_not_led(adapter, caplog):
    for number in range(MOST_ROBOTS + 2):
        adapter._meet(f"r{number}", Robot)
    assert len(adapter._robots) == MOST_ROBOTS
    assert caplog.text.count(f"more than {MOST_ROBOTS} robots were found; name yours in robots") == 2


def test_topics_without_end_are_not_remembered(monkeypatch, caplog):
    core = pytest.importorskip("cyclonedds.core", reason="cyclonedds is not installed; run make setup")
    monkeypatch.setattr(dds, "MOST_ENDPOINTS", 2)
    here = object.__new__(dds.Participant)
    here._endpoints, here._own, here._full = {}, b"own", False

    def offered(number, topic="rt/r1/odom"):
        return SimpleNamespace(
            key=SimpleNamespace(bytes=bytes([number])),
            participant_key=SimpleNamespace(bytes=bytes(16)),
            topic_name=topic,
            type_name="nav_msgs::msg::dds_::Odometry_",
            qos=core.Qos(),
            sample_info=SimpleNamespace(valid_data=True, instance_state=core.InstanceState.Alive),
        )

    assert not here._record(offered(9, "r" * (LONGEST_NAME + 1)), False)
    assert [here._record(offered(number), False) for number in range(4)] == [True, True, False, False]
    assert caplog.text.count("more than 2 topics are offered and wanted") == 1


async def test_of_the_maps_of_many_robots_the_newest_are_kept():
    made = []
    outgoing = SimpleNamespace(grid=lambda robot_map, resolution: robot_map)
    grids = Grids(lambda kind, grid: made.append(grid) or grid, outgoing, 0.1)
    for number in range(MOST_GRIDS_KEPT + 1):
        await grids.of(bytes([number]))
    assert await grids.of(bytes([MOST_GRIDS_KEPT])) == bytes([MOST_GRIDS_KEPT])
    assert len(made) == MOST_GRIDS_KEPT + 1 == len(grids._kept) + 1
