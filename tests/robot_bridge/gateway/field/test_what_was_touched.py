"""The field page where the link, the gateway or the fleet changes between a touch and what comes of it."""

from __future__ import annotations

import contextlib
import json
import re
import shutil

import pytest

from robot_bridge.core.messages.positions import PositionForm
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.fleet.operator_updates import table_frame
from robot_bridge.gateway.model.robots import Robots
from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.phone import GATEWAY_LOST
from tests.support.wire import RefusedError

SLOW = BUSY * 15_000
HELD, GOES_ON = 19, 18
SLEPT = "Date.now = (now => () => now() + 6e5)(Date.now)"
"""Ten minutes: performance.now() stands still in a phone that sleeps, and its clock does not."""
AMBER = (179, 107, 0)
SELDOM = ["--rate", "2"]
"""How often robots say where they are, in Hz: the page shows them once a second."""
POSES = {"r1": (20.0, 8.0, 0.0), "r2": (100.0, 60.0, 1.5), "r3": (150.0, 120.0, 3.0)}


@pytest.fixture(scope="module")
def site(sample_site, tmp_path_factory):
    """A site of which a test may move the origin."""
    folder = tmp_path_factory.mktemp("site")
    for name in ("site.gpkg", "site.toml"):
        shutil.copy(sample_site / name, folder)
    return folder


@pytest.fixture(scope="module")
def bridge(start_bridge, site):
    bridge = start_bridge(site)
    for name, pose in POSES.items():
        bridge.start_robot(name, pose, options=SELDOM)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 2})
    desk.wait_for_robots(*POSES)
    return bridge


@pytest.fixture(scope="module")
def chromium(bridge, chromium):
    """The browser, after all that asyncio is asked to run: playwright holds this thread's loop."""
    return chromium


@pytest.fixture
def desk(bridge):
    """An operator's connection, with no stop in force afterwards."""
    yield bridge.desk("Bob")
    # A test may have killed the gateway of the one before.
    desk = bridge.desk("Bob")
    if desk.hello["emergency"]["in_force"]:
        desk.ask("clear_emergency_stop", {"reason": "the test is over"})


@pytest.fixture
def page(open_phone, bridge, desk):
    """The page on a phone, connected, with the robots where they are."""
    page = open_phone(bridge, expected=GATEWAY_LOST)
    is_ready(page)
    return page


def is_ready(page):
    page.locator("#connection.up").wait_for(timeout=SLOW)
    page.locator("#menu-button").tap()
    text_is(page, "#robots", "r1: fresh")
    page.locator("#menu-button").tap()


def text_is(page, selector, pattern):
    """Wait until the element's text has ``pattern``."""
    found = page.locator(selector)
    try:
        found.filter(has_text=re.compile(pattern)).first.wait_for(timeout=SLOW)
    except Exception as error:
        raise AssertionError(f"{selector} says {found.all_inner_texts()}, not {pattern}") from error


def select(page, robot):
    page.locator("#menu-button").tap()
    page.locator("#robots button", has_text=re.compile(f"^{robot}:")).tap()
    text_is(page, "#robot-name", f"^{robot}$")


def middle(page, panel, dx=0.0):
    """Return the place on the screen ``dx`` pixels beside the chosen robot, above ``panel``."""
    above, below = page.locator("#map").bounding_box(), page.locator(panel).bounding_box()
    return above["x"] + above["width"] / 2 + dx, (above["y"] + below["y"]) / 2


def choose_target(page, robot):
    """Choose a place 40 pixels beside the robot, and send nothing."""
    select(page, robot)
    page.locator("#target").tap()
    page.touchscreen.tap(*middle(page, "#target-panel", 40))
    text_is(page, "#target-help", r"To 46\.88\d+, 16\.84\d+")


def drawn(page):
    """Return how many coloured points the robots' canvas has."""
    return page.evaluate(
        """() => { const c = document.querySelector('#map .leaflet-marker-pane canvas');
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
        let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 200; return n; }"""
    )


def commands(bridge):
    """Return what the gateway's robots were sent, as (robot, op)."""
    return [(one["robot"], one["op"]) for one in bridge.desk("x").ask("get_commands", {})["commands"]]


@contextlib.contextmanager
def finger_down(page, x, y):
    """A finger that comes down on the glass, and leaves it at the end."""
    session = page.context.new_cdp_session(page)
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": x, "y": y}]})
    yield
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def test_what_is_answered_late_is_said_of_the_robot_that_it_was_asked_of(page, bridge):
    choose_target(page, "r1")
    bridge.gateway.send_signal(HELD)
    try:
        page.locator("#send").tap()
        page.locator("#cancel").tap()
        choose_target(page, "r2")
    finally:
        bridge.gateway.send_signal(GOES_ON)
    text_is(page, "#banners", "r1, Send: sent")
    # Of r2 nothing was sent, and its target is still there to be sent.
    assert page.locator("#target-title").inner_text() == "Target of r2"
    assert page.locator("#target-answer").inner_text() == ""
    assert page.locator("#send").is_enabled()


def test_a_pause_that_is_pressed_after_resume_is_what_holds(page, bridge, desk):
    desk.ask("pause_robot", {"robot": "r2"})
    select(page, "r2")
    bridge.gateway.send_signal(HELD)
    try:
        page.locator("#resume").tap()
        page.locator("#pause").tap()
    finally:
        bridge.gateway.send_signal(GOES_ON)
    text_is(page, "#robot-answer", "^sent$")
    text_is(page, "#banners", "r2, Resume: Refused")
    assert desk.ask("get_queue", {"robot": "r2"})["queues"][0]["state"] == "paused"
    page.locator("#resume").tap()
    wait_until(lambda: desk.ask("get_queue", {"robot": "r2"})["queues"][0]["state"] != "paused")


def test_a_cone_that_was_not_answered_is_known_of_and_sent_once(page, bridge, desk):
    choose_target(page, "r3")
    page.locator("#cone").check()
    before = len(commands(bridge))
    bridge.gateway.send_signal(HELD)
    try:
        page.locator("#send").tap()
        text_is(page, "#target-answer", "it is not known whether this was done")
        page.locator("#connection.down").wait_for(timeout=SLOW)
    finally:
        bridge.gateway.send_signal(GOES_ON)
    # The gateway did it all the same, which is told on the next link.
    text_is(page, "#robot-answer", "^sent$")
    assert page.locator("#target-panel").is_hidden()
    assert len(commands(bridge)) == before + 1


def test_a_target_for_which_nobody_waits_any_more_is_not_given_to_the_robot(page, bridge, desk):
    choose_target(page, "r3")
    before = len(commands(bridge))
    bridge.gateway.send_signal(HELD)
    try:
        page.locator("#send").tap()
        # The page waits for an answer for 10 s, and the gateway has the request in its buffer all the time.
        page.wait_for_timeout(10_500)
    finally:
        bridge.gateway.send_signal(GOES_ON)
    page.locator("#connection.up").wait_for(timeout=SLOW)
    wait_until(lambda: [one for one in desk.ask("get_audit", {})["entries"] if "its deadline" in str(one)])
    assert len(commands(bridge)) == before


def test_a_cone_that_is_sent_again_is_sent_once(open_phone, bridge, desk):
    page = open_phone(bridge, expected=GATEWAY_LOST)
    lost = []

    def lose(socket):
        gateway = socket.connect_to_server()
        gateway.on_message(
            lambda frame: lost.append(frame) if "SetPosEnd" in str(frame) else socket.send(frame)
        )

    page.route_web_socket(re.compile("/desk"), lose)
    page.reload()
    is_ready(page)
    choose_target(page, "r3")
    page.locator("#cone").check()
    before = len(commands(bridge))
    page.locator("#send").tap()
    text_is(page, "#target-answer", "it is not known whether this was done")
    lost.clear()
    page.locator("#send").tap()
    wait_until(lambda: page.wait_for_timeout(50) or any('"id"' in str(frame) for frame in lost))
    assert len(commands(bridge)) == before + 1


def test_an_abort_goes_past_a_link_that_does_not_answer(open_phone, bridge, desk):
    page = open_phone(bridge, expected=GATEWAY_LOST)
    links = []

    def swallow(socket):
        gateway = socket.connect_to_server()
        links.append(socket)
        if len(links) == 1:
            socket.on_message(lambda frame: '"abort"' in frame or gateway.send(frame))

    page.route_web_socket(re.compile("/desk"), swallow)
    page.reload()
    is_ready(page)
    select(page, "r1")
    before = commands(bridge).count(("r1", "Abort"))
    page.locator("#abort").tap()
    text_is(page, "#robot-answer", "^sent$")
    assert commands(bridge).count(("r1", "Abort")) == before + 1


def test_a_stop_that_was_in_force_is_not_said_to_be_when_nothing_is_heard(page, bridge, desk):
    page.locator("#stop").tap()
    text_is(page, "#stop-state", "^STOP IN FORCE")
    bridge.gateway.send_signal(HELD)
    try:
        text_is(page, "#stop-state", r"^A stop by .* was in force \d+ s ago. It may have been cleared")
        page.locator("#menu-button").tap()
        text_is(page, "#robots", "r1: was (fresh|stale)")
    finally:
        bridge.gateway.send_signal(GOES_ON)
    text_is(page, "#stop-state", "^STOP IN FORCE")


def test_a_second_press_clears_the_stop_that_the_first_one_was_for(page, bridge, desk):
    page.locator("#stop").tap()
    text_is(page, "#stop-state", "^STOP IN FORCE")
    page.locator("#clear").tap()
    text_is(page, "#clear", "Press again")
    desk.ask("clear_emergency_stop", {"reason": "seen"})
    desk.ask("emergency_stop", {"command": "a-newer-stop"})
    text_is(page, "#stop-state", "^STOP IN FORCE, by Bob")
    page.locator("#clear").tap()
    text_is(page, "#clear", "Press again")
    assert desk.ask("hello", {"operator": "Bob"})["emergency"]["in_force"]


def test_a_stop_that_is_over_before_it_was_answered_is_said_to_be(open_phone, bridge, desk):
    page = open_phone(bridge, expected=GATEWAY_LOST)
    kept = []

    def keep(socket):
        gateway = socket.connect_to_server()
        socket.on_message(
            lambda frame: kept.append(frame) if "emergency_stop" in frame else gateway.send(frame)
        )

    page.route_web_socket(re.compile("/desk"), keep)
    page.reload()
    is_ready(page)
    page.locator("#stop").tap()
    wait_until(lambda: page.wait_for_timeout(20) or kept)
    command = json.loads(kept[0])["params"]["command"]
    desk.ask("emergency_stop", {"command": command})
    desk.ask("clear_emergency_stop", {"reason": "seen"})
    page.unroute_all()
    page.route_web_socket(re.compile("/desk"), lambda socket: socket.connect_to_server())
    text_is(page, "#stop-state", "The stop was in force, and Bob has cleared it since")


def test_a_stop_goes_through_while_the_site_is_on_its_way(open_phone, bridge, desk):
    page = open_phone(bridge, "?nothing", expected=GATEWAY_LOST)
    page.route("**/field/site.json", lambda route: None)
    page.reload()
    text_is(page, "#connection", "connecting")
    page.locator("#stop").tap()
    wait_until(
        lambda: page.wait_for_timeout(50) or desk.ask("hello", {"operator": "Bob"})["emergency"]["in_force"]
    )
    text_is(page, "#stop-state", "^STOP IN FORCE")


def test_no_other_robot_comes_under_a_finger_on_the_list(page, bridge, desk):
    heard = []
    page.on("websocket", lambda socket: socket.on("framereceived", lambda frame: heard.append(frame)))
    page.reload()
    is_ready(page)
    page.locator("#menu-button").tap()
    text_is(page, "#robots", "r1: fresh")
    box = page.locator("#robots button", has_text="r1:").bounding_box()
    with finger_down(page, box["x"] + 60, box["y"] + box["height"] / 2):
        # It comes before r1 in the list.
        bridge.robot("a1").plug_in(7)
        wait_until(
            lambda: (
                page.wait_for_timeout(50) or any(isinstance(one, bytes) and b'"a1"' in one for one in heard)
            )
        )
    text_is(page, "#robot-name", "^r1$")


def test_a_target_is_where_the_finger_came_down(page, bridge):
    select(page, "r2")
    page.locator("#target").tap()
    with finger_down(page, *middle(page, "#target-panel", 40)):
        # As anything else that moves the map does.
        page.evaluate("document.getElementById('whole').click()")
    text_is(page, "#target-help", r"To 46\.8\d+, 16\.8\d+")
    lat, lng = map(float, re.findall(r"\d+\.\d{4,}", page.locator("#target-help").inner_text()))
    # 40 points are some 20 m east of r2, which no test here moves.
    assert (lat, lng) == pytest.approx((46.88055, 16.84449), abs=0.0002)


def was_removed(desk, robot):
    """Remove a robot, unless it has not been silent for long enough."""
    try:
        return desk.ask("remove_robots", {"robots": [robot]})
    except RefusedError:
        return None


def test_a_robot_that_was_removed_is_no_longer_chosen(page, bridge, desk):
    wire = bridge.robot("gone")
    wire.plug_in(8)
    select(page, "gone")
    wire.close()
    wait_until(lambda: was_removed(desk, "gone"), 30)
    text_is(page, "#banners", "gone was removed")
    assert page.locator("#robot").is_hidden()


def coloured(page, *colour):
    """Return how many points of the robots' canvas have that colour."""
    return page.evaluate(
        """([r, g, b]) => { const c = document.querySelector('#map .leaflet-marker-pane canvas');
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
        let n = 0; for (let k = 0; k < d.length; k += 4) n += d[k + 3] > 200
          && Math.abs(d[k] - r) + Math.abs(d[k + 1] - g) + Math.abs(d[k + 2] - b) < 30; return n; }""",
        colour,
    )


READ_FRAME = """async (bytes) => {
  const { tableOf } = await import("/field/connection.js");
  return [...tableOf(new Uint8Array(bytes).buffer).robots.values()];
}"""


def test_a_robot_that_may_be_elsewhere_is_not_said_to_be_fresh_where_it_is_shown(page, bridge, desk):
    wire = bridge.robot("leaper")
    wire.plug_in(9)

    def at(x):
        """Have it say where it is, and not be silent, which would be another state."""
        wire.tell("SendPos", {"x": x, "y": 80.0, "theta": 0.5, "v": 0.0})
        page.wait_for_timeout(50)

    def says(selector, pattern, x):
        def holds():
            at(x)
            return re.search(pattern, page.locator(selector).inner_text())

        wait_until(holds)

    at(60.0)
    select(page, "leaper")
    says("#robot-facts", "^fresh · heard", 60.0)
    assert coloured(page, *AMBER) == 0
    says("#robot-facts", r"^may be elsewhere · heard .* km outside", 1e7)
    assert page.locator("#robot-facts").inner_text().count("km outside") == 1
    wait_until(lambda: at(1e7) or coloured(page, *AMBER) > 20)
    page.locator("#menu-button").tap()
    says("#robots", "leaper: may be elsewhere", 1e7)
    says("#alarms", "leaper may be elsewhere", 1e7)
    says("#robots", "leaper: fresh", 60.5)
    says("#alarms", r"^(?![\s\S]*leaper may be)", 60.5)
    wait_until(lambda: at(60.5) or coloured(page, *AMBER) == 0)
    wire.close()
    wait_until(lambda: was_removed(desk, "leaper"), 30)


def test_it_is_known_of_very_many_robots_too(page):
    robots = Robots()
    for name in ("r1", "r2"):
        robots.ready(name, 1, "websocket", 100.0)
        robots.observe(name, SendPos(1.0, 2.0, 0.5, 0.0), "websocket", 100.0)
    robots.disbelieve("r2", "websocket", 100.0, "it leapt")
    frame = table_frame(100.0, robots.changed(-1), 100.0, form=PositionForm.PLACES)
    first, second = page.evaluate(READ_FRAME, list(frame))
    assert first == {"robot": "r1", "state": "fresh", "x": 1, "y": 2, "theta": 0.5}
    assert second == {**first, "robot": "r2", "doubt": "it leapt"}


def test_a_page_that_slept_reads_nothing_that_lay_on_its_link(page):
    links = []
    page.on("websocket", lambda link: links.append(link))
    page.evaluate(SLEPT)
    wait_until(lambda: page.wait_for_timeout(50) or links)
    is_ready(page)


def test_time_in_which_the_phone_slept_counts(page, bridge):
    select(page, "r1")
    bridge.kill_gateway()
    try:
        page.locator("#connection.down").wait_for(timeout=SLOW)
        page.evaluate(SLEPT)
        text_is(page, "#banners", r"where they were 6\d\d s ago")
        text_is(page, "#robot-facts", r"heard 6\d\d s ago")
    finally:
        bridge.start_gateway()
    page.locator("#connection.up").wait_for(timeout=SLOW)


def test_nothing_goes_to_another_fleet_than_the_one_that_was_seen(page, bridge, site):
    """From here on another frame and another database are served."""
    choose_target(page, "r1")
    bridge.kill_gateway()
    text_is(page, "#banners", "does not answer")
    bridge.database = bridge.database.replace(".db", "-other.db")
    settings = site / "site.toml"
    settings.write_text(settings.read_text().replace("640420.0", "640410.0"))
    page.route("**/field/site.json", lambda route: route.abort())
    bridge.start_gateway()
    page.locator("#connection.up").wait_for(timeout=SLOW)
    wait_until(lambda: len(bridge.desk("y").ask("get_positions", {})["robots"]) >= 3, 30)
    text_is(page, "#banners", "Another site, or another fleet, is served now")
    assert page.locator("#target-panel").is_hidden() and page.locator("#robot").is_hidden()
    page.locator("#menu-button").tap()
    text_is(page, "#robots", "r1: fresh")
    page.locator("#menu-button").tap()
    # Where these metres are is not known before the site is there.
    assert drawn(page) == 0
    page.unroute_all()
    wait_until(lambda: page.wait_for_timeout(50) or drawn(page) > 500, 30)
    assert ("r1", "SetPosEnd") not in commands(bridge)
