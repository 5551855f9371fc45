"""The guide on rosbridge, as it is written: docs/links-rosbridge.md."""

from __future__ import annotations

import msgspec
import tomllib

from robot_bridge.gateway.auth import certificates
from robot_bridge.links.rosbridge.adapter import load
from robot_bridge.links.rosbridge.settings import RosbridgeSettings


def test_every_setting_is_named_with_its_default_and_can_be_used(guide, tmp_path):
    text = guide("all")
    files = certificates.create(tmp_path / "tls", ["robots.example"], [])
    (tmp_path / "robots-ca.pem").write_bytes(files.ca.read_bytes())
    (tmp_path / "rosbridge.token").write_text("a-token", encoding="utf-8")
    file = tmp_path / "far.toml"
    file.write_text(text, encoding="utf-8")
    settings, adapter = load(file)
    assert (settings.name, adapter.kind) == ("far", "rosbridge")

    named = tomllib.loads(text.replace("# user", "user").replace("# password_file", "password_file"))
    written = named["rosbridge"]
    assert set(written) == set(RosbridgeSettings.__struct_fields__)
    places = {"url", "ca", "token_file", "user", "password_file", "topics"}
    read = msgspec.convert({key: written[key] for key in written.keys() - places}, RosbridgeSettings)
    assert read == RosbridgeSettings()


def test_the_shortest_settings_can_be_used(guide, tmp_path):
    file = tmp_path / "far.toml"
    file.write_text(guide("shortest"), encoding="utf-8")
    settings, adapter = load(file)
    assert (settings.name, adapter.kind) == ("far", "rosbridge")
