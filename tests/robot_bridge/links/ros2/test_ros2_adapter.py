"""The adapter's loop: what goes wrong with one robot stays there, and who has its tasks is remembered."""

from __future__ import annotations

import logging

import pytest

from robot_bridge.links.base.errors import LinkError
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
        adapter._lead(robot, robot.fail)
        adapter._lead(robot, robot.fail)
    adapter._report(link)
    assert len(caplog.records) == 1
    assert not link.said["ok"] and link.said["text"] == "r1: the link failed; its log says more"
    assert link.said["reached"]


def test_what_a_person_has_to_put_right_ends_the_process(adapter):
    robot = Robot("r1", LinkError("memory cannot be written"))
    with pytest.raises(LinkError):
        adapter._lead(robot, robot.fail)


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
