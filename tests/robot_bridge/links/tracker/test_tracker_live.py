"""The guide for phones and trackers as it is written: a real gateway, the real adapter, a plain client."""

from __future__ import annotations

import re
import shlex
import socket
import subprocess
import time
from http.client import HTTPConnection
from pathlib import Path

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.command_line import run_command
from tests.support.bridge.cut_line import CUT, CutLine
from tests.support.patience import BUSY
from tests.support.processes import free_port
from tests.support.wire import RefusedError

GUIDE = (Path(__file__).parents[4] / "docs/links-tracker.md").read_text(encoding="utf-8")
SETTINGS = re.findall(r"```toml\n(.*?)```", GUIDE, re.DOTALL)
(CURL,) = re.findall(r"^    (curl .*)$", GUIDE, re.MULTILINE)


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture
def desk(bridge):
    return desk_of(bridge)


def desk_of(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    return desk


@pytest.fixture
def ports():
    return {"http": free_port(), "nmea": free_port()}


@pytest.fixture
def config(bridge, ports, tmp_path):
    """The shortest settings of the guide, with NMEA besides, on ports that are free."""
    text = SETTINGS[0].replace("5055", str(ports["http"]))
    text = text.replace("[tracker]\n", f'[tracker]\nnmea_tcp = "127.0.0.1:{ports["nmea"]}"\n')
    text = text.replace("[tracker]\n", f'[tracker]\nnmea_udp = "127.0.0.1:{ports["nmea"]}"\n')
    file = tmp_path / "phones.toml"
    gateway = f'[gateway]\nurl = "{bridge.address}/link"\n'
    file.write_text(f'{gateway}\n{text}\n"127.0.0.1" = "tractor-1"\n', encoding="utf-8")
    return file


def command_of(ports):
    return shlex.split(CURL.replace("5055", str(ports["http"])) + " --silent --show-error --fail")


def report(ports, text, **headers):
    connection = HTTPConnection("127.0.0.1", ports["http"], timeout=BUSY * 10)
    connection.request("GET", f"/?{text}", headers=headers)
    answer = connection.getresponse()
    return answer.status, answer.read().decode()


def place(east):
    return f"id=845213&lat=46.8805&lon={16.8436 + east:.6f}&speed=2.5&bearing=90&accuracy=4&batt=81"


def reports(ports, text):
    """Tell whether a phone gets rid of its report."""
    try:
        return report(ports, text)[0] == 200
    except OSError:
        return False


def test_a_phone_is_seen_as_the_guide_says_and_comes_back_whatever_is_killed(bridge, desk, config, ports):
    adapter = bridge.start_link("tracker", config)
    wait_until(lambda: subprocess.run(command_of(ports), check=False).returncode == 0, 15)
    desk.wait_for_robots("anna")
    seen = desk.robots["anna"]
    assert (seen["accuracy"], seen["battery"], seen["link"]) == (4.0, 0.81, "phones")
    with pytest.raises(RefusedError, match="is only seen"):
        desk.send("go-anna-go", "anna", "SetPosEnd", x=40.0, y=8.0)
    desk.until(lambda: desk.robots["anna"]["state"] == "lost", 10)

    bridge.kill_gateway()
    bridge.start_gateway()
    desk = desk_of(bridge)
    wait_until(lambda: reports(ports, place(0.0001)) and is_east(desk, seen["x"] + 5), 20)

    adapter.kill()
    adapter.wait(5)
    bridge.start_link("tracker", config)
    wait_until(lambda: reports(ports, place(0.0002)) and is_east(desk, seen["x"] + 12), 20)


def test_what_a_phone_kept_shows_nobody_as_being_there(bridge, desk, config, ports):
    config.write_text(config.read_text(encoding="utf-8").replace('"anna"', '"berta"'), encoding="utf-8")
    adapter = bridge.start_link("tracker", config)
    wait_until(lambda: reports(ports, f"{place(0.0)}&timestamp={time.time():.1f}"), 15)
    before = desk.until(lambda: desk.robots.get("berta", {}).get("x"), 10)
    desk.until(lambda: desk.robots["berta"]["state"] == "lost", 10)
    for ago in range(50, 12, -1):
        assert reports(ports, f"{place(0.001)}&timestamp={time.time() - ago:.1f}")
    desk.listen(1.0)
    assert (desk.robots["berta"]["state"], desk.robots["berta"]["x"]) == ("lost", before)
    assert reports(ports, f"{place(0.001)}&timestamp={time.time():.1f}")
    desk.until(lambda: desk.robots["berta"]["state"] == "fresh", 10)
    adapter.kill()
    adapter.wait(5)


def is_east(desk, x):
    desk.listen(0.1)
    return desk.robots.get("anna", {}).get("x", 0.0) > x


def test_receivers_are_seen_over_tcp_and_udp_and_an_emergency_stop_waits_for_none(
    bridge, desk, config, ports
):
    bridge.start_link("tracker", config)
    wait_until(lambda: reports(ports, place(0.0)), 15)
    sentence = "GPRMC,,A,4652.8300,N,01650.6160,E,010.0,084.4,,,"
    total = 0
    for character in sentence:
        total ^= ord(character)
    line = f"${sentence}*{total:02X}\r\n".encode()
    mobile = CutLine(ports["nmea"])
    port = int(mobile.address.rpartition(":")[2])
    with socket.create_connection(("127.0.0.1", port)) as receiver:
        receiver.sendall(b"nonsense\r\n" + line)
        desk.until(lambda: desk.robots.get("tractor-1", {}).get("v") is not None, 10)
        # The network is gone for 10 s, and what was sent meanwhile comes late over the same connection.
        mobile.cut()
        mended_at = time.monotonic() + CUT
        receiver.sendall(line)
        desk.until(lambda: desk.robots["tractor-1"]["state"] == "lost", 10)
        desk.listen(mended_at - time.monotonic())
        assert desk.robots["tractor-1"]["state"] == "lost"
        mobile.mend()
        desk.until(lambda: desk.robots["tractor-1"]["state"] == "fresh", 10)
    mobile.close()
    desk.until(lambda: desk.robots["tractor-1"]["state"] == "lost", 10)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.sendto(line, ("127.0.0.1", ports["nmea"]))
    desk.until(lambda: desk.robots["tractor-1"]["state"] == "fresh", 10)
    stopped = desk.ask("emergency_stop", {"command": "stop-of-trackers"})
    desk.ask("clear_emergency_stop", {})
    assert (stopped["robots"], stopped["waiting"]) == (0, [])


def test_reports_that_count_for_nothing_are_answered_with_the_reason(bridge, desk, config, ports):
    bridge.start_link("tracker", config)
    wait_until(lambda: reports(ports, place(0.0)), 15)
    assert report(ports, "id=999&lat=46.8&lon=16.8") == (
        400,
        "device '999' is not in [tracker.names] of the link's settings\n",
    )
    assert report(ports, "id=845213&lat=x&lon=16.8")[0] == 400
    assert report(ports, f"{place(0.01)}&timestamp={time.time() - 3600:.0f}")[0] == 200
    for wrong in (
        b"\0\0\r\n\r\n",
        b"GET / HTTP/1.1\r\nContent-Length: x\r\n\r\n",
        b"POST / HTTP/1.1\r\nContent-Length: 999999999\r\n\r\n",
        b"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
        b"DELETE / HTTP/1.1\r\n\r\n",
        b"GET /?" + b"a" * 40_000,
    ):
        with socket.create_connection(("127.0.0.1", ports["http"]), timeout=BUSY * 10) as phone:
            phone.sendall(wrong)
            assert re.match(rb"HTTP/1.1 4\d\d ", phone.recv(1000)), wrong
    # One that begins a request and never ends it keeps nobody out.
    with socket.create_connection(("127.0.0.1", ports["http"])) as silent:
        silent.sendall(b"POST / HTTP/1.1\r\nContent-Length: 10\r\n\r\n")
        assert report(ports, place(0.0))[0] == 200
    desk.wait_for_robots("anna")
    assert "999" not in desk.robots


WRONG = [
    ("[tracker]", "tracker listens to nothing"),
    ('[tracker]\nhttp = "5055"', "tracker.http = '5055': write an IP address and a port"),
    ('[tracker]\nhtp = "127.0.0.1:5055"', "tracker.htp is not a setting: did you mean http?"),
    ('[tracker]\nhttp = "127.0.0.1:5055"\n[tracker.names]\n1 = "a b"', "tracker.names.1: robot name"),
    ('[tracker]\nhttp = "127.0.0.1:5055"\nbaud = 7', "tracker.baud = 7"),
    ('[tracker]\nhttp = "127.0.0.1:5055"\noldest_s = "x"', "tracker.oldest_s"),
    ('[trackr]\nhttp = "127.0.0.1:5055"', "trackr is not a setting: did you mean tracker?"),
    ('[gateway]\nurl = "http://x"\n[tracker]\nhttp = "127.0.0.1:5055"', "gateway.url = 'http://x'"),
    ("[tracker", "is not valid TOML"),
]


@pytest.mark.parametrize(("text", "reason"), WRONG)
def test_settings_that_are_wrong_are_named_with_file_and_key(tmp_path, text, reason):
    from robot_bridge.links.base.errors import LinkError
    from robot_bridge.links.kinds import load

    file = tmp_path / "phones.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(LinkError, match=re.escape(reason)) as refused:
        load("tracker", file)
    assert str(file) in str(refused.value)


def test_the_command_line_checks_settings_and_says_one_line(tmp_path):
    file = tmp_path / "phones.toml"
    file.write_text(SETTINGS[1], encoding="utf-8")
    done = run_command("link", "tracker", "--config", file, "--check")
    assert (done.returncode, done.stdout) == (0, f"{file}: link phones of kind tracker can be run\n")
    done = run_command("link", "tracker", "--config", tmp_path / "none.toml")
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1 and "none.toml cannot be read" in done.stderr
