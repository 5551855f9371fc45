"""What a stranger sends to a real gateway: too much, in others' names, with pages of their own."""

from __future__ import annotations

import http.client
import os
import stat
from pathlib import Path

import pytest

from tests.support.wire import RefusedError


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site, tmp_path_factory):
    """A gateway that was started with the umask of most logins."""
    before = os.umask(0o022)
    try:
        return start_bridge(sample_site)
    finally:
        os.umask(before)


def page(bridge, path, host):
    connection = http.client.HTTPConnection("127.0.0.1", bridge.port, timeout=60)
    connection.putrequest("GET", path, skip_host=True)
    connection.putheader("Host", host)
    connection.endheaders()
    answer = connection.getresponse()
    text = answer.read().decode()
    if answer.status == http.HTTPStatus.OK:
        assert answer.getheader("X-Content-Type-Options") == "nosniff"
    connection.close()
    return answer.status, text


@pytest.mark.parametrize("path", ["/metrics", "/healthz", "/schemas/"])
def test_a_page_whose_name_leads_here_reads_nothing(bridge, path):
    assert page(bridge, path, f"127.0.0.1:{bridge.port}")[0] == 200
    assert page(bridge, path, f"localhost:{bridge.port}")[0] == 200
    status, text = page(bridge, path, f"evil.example:{bridge.port}")
    assert status == 421
    assert text.startswith(
        f"Host 'evil.example:{bridge.port}' is no name of this gateway; ask by its address"
    )


def test_only_an_image_may_be_as_large_as_an_image(bridge):
    robot = bridge.robot("r1")
    robot.plug_in(1)
    pose = {"x": 20.0, "y": 8.0, "theta": 0.0, "v": 0.0}
    with pytest.raises(
        RefusedError, match=r"SendPos has .* bytes; at most 65536 are taken, but for SendImage"
    ):
        robot.ask("SendPos", {**pose, "status": "!" * 1_000_000})
    (report,) = bridge.desk().ask("get_positions")["robots"]
    assert "at most 65536 are taken" in report["status"]
    with pytest.raises(RefusedError, match="SendPos: crs is no parameter here"):
        robot.ask("SendPos", {**pose, "crs": "EPSG:4326"})
    assert robot.ask("SendPos", {**pose, "status": "!" * 60_000})["ok"]
    (report,) = bridge.desk().ask("get_positions")["robots"]
    assert len(report["status"]) == 256


def test_an_operators_name_is_one_line(bridge):
    desk = bridge.desk()
    for name in ("Ada\n2026-11-23 12:00:00,000 WARNING all is well", "Ada\x1b[2J", "A" * 5000):
        with pytest.raises(RefusedError, match=r"hello: operator has .* characters and begins 'A"):
            desk.ask("hello", {"operator": name})
    assert all("WARNING all is well" not in line[:60] for line in bridge.output().splitlines())


def test_the_database_is_its_owners_alone(bridge):
    for end in ("", "-wal", "-shm"):
        assert stat.S_IMODE(Path(f"{bridge.file}{end}").stat().st_mode) == 0o600
