"""Links that a site names: started with the gateway, started again, ended with it, and told of."""

from __future__ import annotations

import asyncio
import errno
import io
import json
import os
import shutil
import sys
import urllib.request
from types import SimpleNamespace

import pytest
import uvloop

from robot_bridge.core.sites.settings_tables import LinkOptions
from robot_bridge.gateway.fleet import link_supervision
from robot_bridge.gateway.fleet.link_supervision import LinkProcesses
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.link_process import LinkProcess
from tests.support.patience import BUSY
from tests.support.processes import Processes, is_running

SETTINGS = 'kind = "tracker"\n[tracker]\nnmea_udp = "127.0.0.1:0"\n[tracker.names]\n1 = "car-1"\n'


@pytest.fixture
def site(impatient_site, tmp_path):
    """A site that names two links, of which one has wrong settings."""
    folder = tmp_path / "site"
    shutil.copytree(impatient_site, folder)
    (folder / "links").mkdir()
    (folder / "links/cars.toml").write_text(SETTINGS, encoding="utf-8")
    (folder / "links/wrong.toml").write_text("[tracker]\n", encoding="utf-8")
    text = (folder / "site.toml").read_text(encoding="utf-8")
    links = '[links]\ntracker = ["links/cars.toml", "links/wrong.toml"]\n'
    (folder / "site.toml").write_text(f"{text}\n{links}", encoding="utf-8")
    return folder


@pytest.fixture
def bridge(start_bridge, site):
    bridge = start_bridge(site)
    yield bridge
    bridge.end()


def children(bridge):
    """Return the links' processes by what they run."""
    listed = os.popen(f"ps -ww -o pid=,args= --ppid {bridge.gateway.pid}").read()
    return {
        line.split("links/")[1].split(".")[0]: int(line.split()[0])
        for line in listed.splitlines()
        if "links/" in line
    }


def reported(desk, link):
    return next((one for one in desk.links if one["link"] == link), None)


class FullStream(io.StringIO):
    def write(self, text):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_link_is_read_to_its_end_where_its_lines_cannot_be_written(monkeypatch):
    monkeypatch.setattr(sys, "stderr", FullStream())
    assert link_supervision._pass_on(io.BytesIO(b"WARNING one\nrobot-bridge: the last\n")) == "the last"


FORKS = []
os.register_at_fork(before=lambda: FORKS.append("fork"))


def test_a_link_is_started_without_a_fork_of_this_python(tmp_path):
    """In a forked copy a lock may be held for ever that another thread had, and uvloop waits for the copy."""

    async def run_once():
        links = LinkProcesses(LinkOptions(tracker=("none.toml",)), tmp_path)
        async with asyncio.timeout(60):
            running = asyncio.create_task(links.run("ws://127.0.0.1:1/link"))
            while not (links.states[0].starts and links.states[0].fault):
                await asyncio.sleep(0.01)
        running.cancel()
        return links.states[0].fault

    FORKS.clear()
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        assert "none.toml" in runner.run(run_once())
    assert not FORKS


def test_links_are_started_again_and_told_of_and_end_with_their_gateway(bridge):
    desk = bridge.desk()
    desk.until(lambda: (reported(desk, "cars") or {}).get("up"), 20)
    desk.until(lambda: "listens to nothing" in str((reported(desk, "wrong") or {}).get("text")), 20)
    assert reported(desk, "wrong")["up"] is False
    with urllib.request.urlopen(bridge.address.replace("ws://", "http://") + "/healthz") as page:
        links = json.load(page)["links"]
    assert links["cars"] == {"ok": True, "text": None}
    assert "tracker.toml" not in links and links["wrong"]["ok"] is False
    with urllib.request.urlopen(bridge.address.replace("ws://", "http://") + "/metrics") as page:
        text = page.read().decode()
    assert 'robot_bridge_link_up{link="cars"} 1.0' in text
    assert 'robot_bridge_link_up{link="wrong"} 0.0' in text

    first = children(bridge)["cars"]
    os.kill(first, 9)
    wait_until(lambda: children(bridge).get("cars", first) != first, 20)
    second = children(bridge)["cars"]

    bridge.kill_gateway()
    wait_until(lambda: not is_running(second), 10)
    bridge.start_gateway()
    wait_until(lambda: "cars" in children(bridge), 20)
    third = children(bridge)["cars"]
    bridge.gateway.terminate()
    assert bridge.gateway.wait(BUSY * 10) == 0
    assert not is_running(third)


def test_a_link_that_is_started_twice_runs_once(bridge, tmp_path):
    file = tmp_path / "vans.toml"
    file.write_text(f'{SETTINGS}[gateway]\nurl = "{bridge.address}/link"\n', encoding="utf-8")
    with Processes(tmp_path / "logs") as processes:
        first, second = (LinkProcess(processes, "tracker", file) for _ in range(2))
        first.start()
        desk = bridge.desk()
        desk.until(lambda: (reported(desk, "vans") or {}).get("up"), 20)
        second.start()
        assert second.process.wait(BUSY * 20) != 0
        assert f"link vans runs already on this computer, as process {first.process.pid}" in second.output()
        assert first.process.poll() is None
        first.kill()
        second.start()
        wait_until(lambda: (tmp_path / "vans.lock").read_text() == str(second.process.pid), 20)


async def test_a_link_that_cannot_even_be_tried_keeps_no_other_from_going_on(tmp_path, monkeypatch):
    monkeypatch.setattr(link_supervision, "sys", SimpleNamespace(executable="/bin/false", stderr=sys.stderr))
    monkeypatch.setattr(link_supervision, "FIRST_WAIT", 0.01)
    links = LinkProcesses(LinkOptions(tracker=("cars.toml", "no\0file.toml")), tmp_path)
    running = asyncio.create_task(links.run("ws://127.0.0.1:1/link"))
    cars, wrong = links.states
    try:
        async with asyncio.timeout(60):
            while cars.starts < 2 or "null byte" not in str(wrong.fault):
                await asyncio.sleep(0.01)
        assert wrong.starts == 0 and not running.done()
    finally:
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
