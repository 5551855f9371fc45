"""The operations that carry more than numbers, with a robot account's rights on each kind of database."""

from __future__ import annotations

import base64
import os

import pytest

from tests.robot_bridge.gateway.storage.databases.accounts import Accounts
from tests.support.bridge.bridge_programs import wait_until

PNG = b"\x89PNG\r\n\x1a\n" + os.urandom(3_000_000)


@pytest.fixture
def accounts(kind, request, url, tmp_path):
    server = None if kind == "sqlite" else request.getfixturevalue(f"{kind}_server")
    accounts = Accounts(kind, server.admin_url(url) if server else url, tmp_path)
    yield accounts
    accounts.remove()


def test_a_robot_tells_what_it_sees_asks_its_path_and_is_told_where_it_begins(
    start_bridge, sample_site, url, accounts, tmp_path
):
    bridge = start_bridge(sample_site, url)
    name, address = accounts.add(bridge.database)
    picture = tmp_path / "cone.png"
    picture.write_bytes(PNG)
    options = ["--see", "45,8,cone-7", "--image", picture, "--ask-path"]
    bridge.start_robot(name, (20.0, 8.0, 0.0), sql=address, options=options)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots(name)
    desk.send("begin-here", name, "SetPosIni", x=22.0, y=8.0)
    desk.wait_for_step("begin-here", "reached")
    desk.send("drive-there", name, "SetPosEnd", x=45.0, y=8.0, theta=1.0)
    desk.wait_for_step("drive-there", "reached")
    told = wait_until(lambda: (o := desk.ask("get_observations", {"robot": name})["observations"])[1:] and o)
    assert [(o["op"], o["object"]) for o in told] == [("SendImage", "cone-7"), ("SetObject", "cone-7")]
    image = desk.ask("get_image", {"observation": told[0]["observation"]})
    assert base64.b64decode(image["image"]) == PNG
    accepted = desk.ask("review_observation", {"observation": told[1]["observation"], "accept": True})
    assert accepted["state"] == "accepted"
    bridge.end()
