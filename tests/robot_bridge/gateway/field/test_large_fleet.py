"""The field page with more robots than a phone is told of one by one: real gateway, real browser, a link."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.link_crowd import RUNNER, Crowd
from tests.support.patience import BUSY

SLOW = BUSY * 15_000
CROWD, ALL = 1100, "1,101"
MOST = 300


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def desk(bridge):
    """A desk without positions, once the whole crowd has said where it is."""
    crowd = Crowd(bridge.address, CROWD)
    everywhere = {"view": {"bounds": [0, 0, 200, 160], "most": 1}}
    desk = bridge.desk()
    wait_until(lambda: desk.ask("get_positions", everywhere)["view"]["inside"] == CROWD + 1)
    yield desk
    crowd.end()


@pytest.fixture(scope="module")
def chromium(desk, chromium):
    """The browser, after all that asyncio is asked to run: playwright holds this thread's loop."""
    return chromium


class Wire:
    """What the page asked for and was told."""

    def __init__(self, page):
        self.asked, self.told, self.largest, self.at = [], [], 0, {}
        page.on("websocket", self._listen)
        page.reload()
        page.locator("#connection.up").wait_for(timeout=SLOW)

    def of(self, method):
        """Return the parameters of what was asked by ``method``."""
        return [frame["params"] for frame in self.asked if frame["method"] == method]

    def _listen(self, socket):
        socket.on("framesent", lambda text: self.asked.append(json.loads(text)))
        socket.on("framereceived", self._hear)

    def _hear(self, frame):
        if isinstance(frame, bytes):
            begin = 4 + int.from_bytes(frame[:4], "little")
            params = json.loads(frame[4:begin])["params"]
            names, x = params["robots"], params["columns"].index("x") if "x" in params["columns"] else None
            width = 4 if "age" not in params["columns"] else 8
            if x is not None:
                values = np.frombuffer(frame, f"<f{width}", offset=-(-begin // 8) * 8)
                table = values.reshape(len(params["columns"]), -1)
                self.at.update(zip(names, table[x].tolist(), strict=True))
        else:
            params = json.loads(frame).get("result") or {}
            names = [one["robot"] for one in params.get("robots", [])] if "view" in params else []
            self.told += [params] if "view" in params else []
        self.largest = max(self.largest, len(names))


@pytest.fixture
def phone(open_phone, bridge):
    """The page, and what goes over its wire."""
    page = open_phone(bridge)
    return page, Wire(page)


def wait_for(page, condition):
    wait_until(lambda: page.wait_for_timeout(50) or condition())


def text_is(page, selector, pattern):
    found = page.locator(selector)
    try:
        found.filter(has_text=re.compile(pattern)).first.wait_for(timeout=SLOW)
    except Exception as error:
        raise AssertionError(f"{selector} says {found.all_inner_texts()}, not {pattern}") from error


def ring_points(page):
    """Return how many points of the ring around a selected robot are amid the map that the sheet leaves."""
    sheet, box = page.locator("#robot").bounding_box(), page.locator("#map").bounding_box()
    return page.evaluate(
        """([x, y]) => { const c = document.querySelector('#map .leaflet-marker-pane canvas');
        const d = c.getContext('2d').getImageData(2 * x - 80, 2 * y - 80, 160, 160).data;
        let n = 0;
        for (let k = 0; k < d.length; k += 4) n += d[k] === 0x0b && d[k + 1] === 0x57 && d[k + 2] === 0xa4;
        return n; }""",
        [box["width"] / 2, (sheet["y"] - box["y"]) / 2],
    )


def coloured(page):
    """Return how many points of the robots' canvas are as green as a fresh robot, and how many white."""
    return page.evaluate(
        """() => { const c = document.querySelector('#map .leaflet-marker-pane canvas');
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let green = 0, white = 0;
        for (let k = 0; k < d.length; k += 4) {
          green += d[k] === 0x13 && d[k + 1] === 0x6b && d[k + 2] === 0x2c && d[k + 3] === 255;
          white += d[k] === 255 && d[k + 1] === 255 && d[k + 2] === 255 && d[k + 3] === 255; }
        return [green, white]; }"""
    )


def zoom_in(page, times=1):
    for _ in range(times):
        page.locator(".leaflet-control-zoom-in").tap()
        page.wait_for_timeout(400)


def middle(page):
    box = page.locator("#map").bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


PAN = """async () => {
  const map = document.querySelector("#map"), { left, top } = map.getBoundingClientRect();
  const at = (x) => ({ clientX: left + x, clientY: top + 100, button: 0, bubbles: true });
  for (let k = 0; k < 10; k++) {
    map.dispatchEvent(new MouseEvent("mousedown", at(100)));
    for (const x of [140, 190]) map.dispatchEvent(new MouseEvent("mousemove", at(x)));
    map.dispatchEvent(new MouseEvent("mouseup", at(190)));
    await new Promise((resolve) => setTimeout(resolve, 30));
  }
}"""
"""Drag the map to the right ten times, one after the other."""


def select(page, text, robot):
    page.locator("#menu-button").tap()
    page.locator("#search").fill(text)
    page.locator("#robots button", has_text=re.compile(f"^{robot}:")).tap()
    text_is(page, "#robot-name", f"^{robot}$")


def test_many_robots_are_shown_by_number_and_each_one_after_zooming_in(phone):
    page, wire = phone
    text_is(page, "#count", rf"^Robots here: {ALL} of {ALL}\. Zoom in to see each\.$")
    assert {one["view"]["most"] for one in wire.of("subscribe")} == {MOST}
    assert wire.largest == 0
    _, white = coloured(page)
    assert white > 5000
    # One of the circles is there: the map goes closer.
    page.touchscreen.tap(*middle(page))
    text_is(page, "#count", rf"^Robots here: \d+ of {ALL}\. Zoom in to see each\.$")
    zoom_in(page)
    text_is(page, "#count", rf"^Robots here: \d+ of {ALL}\.$")
    wait_for(page, lambda: coloured(page)[0] > 1000)
    assert 0 < wire.largest <= MOST
    here = int(re.search(r"\d+", page.locator("#count").inner_text())[0])
    assert here < wire.largest


def test_a_map_that_is_panned_asks_once_it_is_still(phone):
    page, wire = phone
    text_is(page, "#count", "Zoom in")
    zoom_in(page, 3)
    text_is(page, "#count", rf"of {ALL}\.$")
    before = len(wire.of("subscribe"))
    page.evaluate(PAN)
    wait_for(page, lambda: len(wire.of("subscribe")) > before)
    page.wait_for_timeout(600)
    asked = [one["view"]["bounds"] for one in wire.of("subscribe")]
    # More than one where the machine stood still for as long as the page takes for the end of it.
    assert 1 <= len(asked) - before <= 3
    # Nine hundred points, of a map of 393, and what it glides on.
    assert asked[-1][2] < asked[before - 1][0]


def test_a_robot_is_found_at_the_gateway_and_followed_wherever_the_map_is(phone, desk):
    page, wire = phone
    text_is(page, "#count", "Zoom in")
    zoom_in(page, 3)
    page.locator("#menu-button").tap()
    text_is(page, "#robots-more", f"{CROWD + 1 - 50} more")
    page.locator("#menu-button").tap()
    assert RUNNER not in wire.at
    select(page, "AN-7", RUNNER)
    text_is(page, "#robot-facts", "fresh")
    wait_for(page, lambda: RUNNER in wire.at)
    # It is shown in the middle of what the sheet leaves of the map: the ring around it is there.
    wait_for(page, lambda: ring_points(page) > 100)
    page.locator("#whole").tap()
    zoom_in(page, 3)
    seen = wire.at[RUNNER]
    wait_for(page, lambda: wire.at[RUNNER] != seen)
    assert wire.of("subscribe")[-1]["view"]["always"] == [RUNNER]
    before = set(desk.commands)
    page.locator("#abort").tap()
    desk.until(lambda: any(one["robot"] == RUNNER for id, one in desk.commands.items() if id not in before))
    page.locator("#robot-close").tap()
    wait_for(page, lambda: wire.of("subscribe")[-1]["view"]["always"] == [])


def test_the_stop_is_for_all_robots_whatever_the_map_shows(phone, desk):
    page, _ = phone
    text_is(page, "#count", "Zoom in")
    zoom_in(page, 3)
    page.locator("#stop").tap()
    text_is(page, "#stop-state", rf"STOP IN FORCE, .* of {CROWD + 1} robots")
    desk.ask("clear_emergency_stop", {"reason": "the test is over"})


def test_where_positions_are_asked_for_it_is_by_the_same_view(phone):
    page, wire = phone
    text_is(page, "#count", "Zoom in")
    page.locator("#menu-button").tap()
    page.locator("#updates").select_option("poll")
    page.locator("#menu-button").tap()
    zoom_in(page, 3)
    wait_for(page, lambda: any(told["robots"] for told in wire.told))
    text_is(page, "#count", rf"^Robots here: \d+ of {ALL}\.$")
    assert all("view" in one for one in wire.of("get_positions"))
    assert 0 < wire.largest <= MOST


THERE_AND_BACK = """async () => {
  const { earthOf, siteOf } = await import("/field/map.js");
  const { to_earth } = await (await fetch("/field/site.json")).json(), worst = [];
  // As on a large site: what bends there bends more than on this one.
  const bent = { ...to_earth, lon: to_earth.lon.map((c, k) => (k === 5 ? c + 0.02 * to_earth.lon[4] : c)) };
  for (const one of [to_earth, bent]) {
    const there = earthOf(one), back = siteOf(one), off = [];
    for (let x = -40; x <= 240; x += 35) {
      for (let y = -20; y <= 180; y += 25) {
        const [u, v] = back(...there(x, y));
        off.push(Math.hypot(u - x, v - y));
      }
    }
    worst.push(Math.max(...off));
  }
  const [[west], [east]] = [-170, 170].map((longitude) => siteOf(to_earth)(46, longitude));
  return [...worst, west, east];
}"""


def test_places_on_the_map_are_those_of_the_site_and_far_beside_it_still_in_their_order(phone):
    page, _ = phone
    plain, bent, west, east = page.evaluate(THERE_AND_BACK)
    assert plain < 0.001 and bent < 0.001
    assert west < -1e6 and east > 1e6


def test_axe_finds_nothing_where_robots_are_counted(open_phone, bridge):
    axe_core = pytest.importorskip("axe_core_python.sync_playwright", reason="axe looks for barriers")
    page = open_phone(bridge, bypass_csp=True)
    text_is(page, "#count", "Zoom in")
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        rules = ["wcag2a", "wcag2aa", "best-practice"] if scheme == "light" else ["color-contrast"]
        kind = "tag" if scheme == "light" else "rule"
        answer = axe_core.Axe().run(page, options={"runOnly": {"type": kind, "values": rules}})
        assert [one["id"] for one in answer["violations"]] == []
