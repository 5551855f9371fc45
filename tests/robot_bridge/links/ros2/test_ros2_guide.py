"""The guide's settings, as they are written there."""

from __future__ import annotations

import msgspec
import pytest
import tomllib

pytest.importorskip("rosbags", reason="rosbags is not installed; run make setup")

from robot_bridge.links import kinds
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.ros.settings import TopicSettings
from robot_bridge.links.ros2 import adapter as ros2_adapter
from robot_bridge.links.ros2.adapter import Ros2Settings, load


@pytest.mark.parametrize("name", ["shortest", "all"])
def test_the_settings_of_the_guide_can_be_used(guide, tmp_path, name):
    file = tmp_path / "nav2.toml"
    file.write_text(guide(name), encoding="utf-8")
    settings, adapter = load(file)
    assert (settings.name, adapter.kind) == ("nav2", "ros2")


@pytest.mark.parametrize("missing", ["cyclonedds", "rosbags"])
def test_a_missing_package_is_named_before_the_link_connects(guide, tmp_path, monkeypatch, missing):
    file = tmp_path / "nav2.toml"
    file.write_text(guide("shortest"), encoding="utf-8")
    found = ros2_adapter.find_spec
    monkeypatch.setattr(ros2_adapter, "find_spec", lambda name: None if name == missing else found(name))
    with pytest.raises(LinkError, match=rf"needs the Python package {missing}, .*\[ros2\]"):
        kinds.load("ros2", file)


def test_the_guide_names_every_setting_and_its_default(guide):
    written = tomllib.loads(guide("all"))["ros2"]
    topics = written.pop("topics")
    assert set(topics) == set(TopicSettings.__struct_fields__)
    assert {*written, "topics", "security"} == set(Ros2Settings.__struct_fields__)
    read = msgspec.convert(written | {"topics": {}}, Ros2Settings)
    assert read == Ros2Settings()
    for key, default in msgspec.structs.asdict(TopicSettings()).items():
        assert default in (None, topics[key]), key
