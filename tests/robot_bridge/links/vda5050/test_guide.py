"""The guide on VDA 5050 vehicles, as it is written: docs/links-vda5050.md."""

from __future__ import annotations

import re

import pytest
import tomllib

from robot_bridge.gateway.auth import certificates
from robot_bridge.links.base.settings import read_settings
from robot_bridge.links.kinds import load
from robot_bridge.links.vda5050.settings import Vda5050Settings, check
from tests.robot_bridge.links.vda5050.peers import Yard, require_peers


@pytest.fixture(scope="module")
def guide(root):
    return (root / "docs" / "links-vda5050.md").read_text(encoding="utf-8")


def block(guide, name):
    return re.search(rf"```toml {name}\n(.*?)```", guide, re.DOTALL)[1]


def test_every_setting_is_named_and_can_be_used(guide, tmp_path):
    text = block(guide, "all")
    files = certificates.create(tmp_path / "tls", ["broker.example"], [])
    for name, file in (("ca", files.ca), ("fleet", files.certificate), ("fleet-key", files.key)):
        (tmp_path / f"{name}.pem").write_bytes(file.read_bytes())
    file = tmp_path / "yard.toml"
    file.write_text(text, encoding="utf-8")
    settings, own = read_settings(file, "vda5050", Vda5050Settings)
    check(settings, own)

    named = tomllib.loads(text)["vda5050"]
    assert set(named) == set(Vda5050Settings.__struct_fields__)
    plain = Vda5050Settings()
    lengths = [key for key in named if key.endswith(("_m", "_s", "_deg")) or key in ("interface", "names")]
    assert {key: named[key] for key in lengths} == {key: getattr(plain, key) for key in lengths}


def test_the_shortest_settings_show_and_drive_a_vehicle(guide, root, start_bridge, sample_site, tmp_path):
    from tests.support.processes import Processes

    modules = require_peers(root)
    bridge = start_bridge(sample_site)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    with Processes(tmp_path / "logs") as processes:
        yard = Yard(processes, tmp_path, modules)
        yard.start_broker()
        text = block(guide, "shortest").replace("127.0.0.1:1883", f"127.0.0.1:{yard.port}")
        (tmp_path / "yard.toml").write_text(
            text.replace("ws://127.0.0.1:8765", bridge.address), encoding="utf-8"
        )
        assert load("vda5050", tmp_path / "yard.toml")
        yard.run_adapter(tmp_path / "yard.toml")
        yard.start_vehicle("0001", 20.0, 8.0)
        desk.wait_for_robots("0001")
        desk.send("command-1", "0001", "SetPosEnd", x=30.0, y=8.0)
        desk.wait_for_step("command-1", "reached")
        yard.end()
    bridge.end()
