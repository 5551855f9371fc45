"""The field page in a real Chromium of a phone's size, on a real gateway with reference robots."""

from __future__ import annotations

import json
import re
import signal

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import BUSY
from tests.support.phone import GATEWAY_LOST
from tests.support.processes import freeze

SLOW = BUSY * 15_000
AHEAD = "Date.now = (now => () => now() + 3.2e10)(Date.now)"
"""A phone whose clock is a year ahead."""
SELDOM = ["--rate", "2"]
"""How often robots say where they are, in Hz: the page shows them once a second."""


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def accounts(bridge, accounts_of):
    return accounts_of(bridge)


@pytest.fixture(scope="module")
def tokens(accounts):
    """Tokens by role."""
    roles = ("viewer", "operator", "supervisor")
    return {role: accounts.do("operators", "add", role.title(), "--role", role) for role in roles}


@pytest.fixture(scope="module")
def robots(bridge, tokens, accounts, tmp_path_factory):
    """Three robots at known places."""
    folder, processes = tmp_path_factory.mktemp("robots"), {}
    for name, pose in {"r1": (20.0, 8.0, 0.0), "r2": (100.0, 60.0, 1.5), "r3": (150.0, 120.0, 3.0)}.items():
        file = folder / name
        file.write_text(accounts.do("robots", "token", name), encoding="utf-8")
        file.chmod(0o600)
        processes[name] = bridge.start_robot(name, pose, options=["--token-file", file, *SELDOM])
    desk = bridge.desk(additional_headers={"Authorization": f"Bearer {tokens['supervisor']}"})
    desk.ask("subscribe", {"rate": 2})
    desk.wait_for_robots("r1", "r2", "r3")
    desk.processes = processes
    return desk


@pytest.fixture(scope="module")
def chromium(robots, chromium):
    """The browser, after all that asyncio is asked to run: playwright holds this thread's loop."""
    return chromium


@pytest.fixture
def desk(robots):
    """A supervisor's desk with no stop in force, now and afterwards."""
    yield robots
    if robots.ask("hello", {"operator": "x"})["emergency"]["in_force"]:
        robots.ask("clear_emergency_stop", {"reason": "the test is over"})


@pytest.fixture
def phone(open_phone, bridge, tokens, desk):
    """Open the page as somebody of a role who is signed in: ``phone("operator")``."""

    def open_signed_in(role, **how):
        page = open_phone(bridge, f"#token={tokens[role]}", **how)
        page.locator("#connection.up").wait_for(timeout=SLOW)
        return page

    return open_signed_in


def text_is(page, selector, pattern):
    """Wait until the element's text has ``pattern``."""
    found = page.locator(selector)
    try:
        found.filter(has_text=re.compile(pattern)).first.wait_for(timeout=SLOW)
    except Exception as error:
        raise AssertionError(f"{selector} says {found.all_inner_texts()}, not {pattern}") from error


def is_connected(page):
    text_is(page, "#connection", "^connected$")


def select(page, robot):
    page.locator("#menu-button").tap()
    page.locator("#robots button", has_text=re.compile(f"^{robot}:")).tap()
    text_is(page, "#robot-name", f"^{robot}$")


def newest(desk, before):
    """Return a command that was not there ``before``."""
    return next((one for id, one in desk.commands.items() if id not in before), None)


def tell_of_site(page, tokens, **other):
    """Have the page told something else of the site from now on."""
    bearer = {"Authorization": f"Bearer {tokens['operator']}"}
    told = page.context.request.get(f"{page.url}/site.json", headers=bearer).json() | other
    page.route("**/field/site.json", lambda route: route.fulfill(json=told))


def drawn(page):
    """Return how many coloured points the robots' canvas has."""
    return page.evaluate(
        """() => { const c = document.querySelector('#map .leaflet-marker-pane canvas');
        const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
        let n = 0; for (let k = 3; k < d.length; k += 4) n += d[k] > 200; return n; }"""
    )


def test_the_token_of_the_address_signs_in_and_is_gone_from_it(phone, tokens):
    page = phone("operator")
    assert page.url.endswith("/field")
    assert page.title() == "Sample proving ground and campus"
    wait_until(lambda: drawn(page) > 500)
    page.reload()
    is_connected(page)
    assert page.evaluate("localStorage.getItem('fleet-field-token')") is None


BUSY_AND_QUIET = """async () => {
  const { PositionBudget } = await import("/field/budget.js");
  const budget = new PositionBudget(), steps = [];
  let bytes = 0;
  const pass = (seconds, each) => {
    for (let k = 0; k < seconds; k++) {
      bytes += each(budget.step);
      if (budget.note(bytes)) steps.push([budget.step.form, budget.step.rate]);
    }
    return steps.splice(0);
  };
  // A robot's place is 20 bytes, and all of it 120.
  const robots = (n) => ({ form, rate }) => n * (form === "columns" ? 120 : 20) * rate;
  return [pass(300, robots(100)), pass(60, robots(2000)), pass(900, robots(2000)), pass(600, robots(10)),
          pass(600, robots(180))];
}"""


def test_a_phone_asks_for_less_while_there_is_much_and_for_more_when_that_is_over(phone):
    few, burst, many, quiet, between = phone("viewer").evaluate(BUSY_AND_QUIET)
    assert few == []
    assert burst == [["places", 1], ["places", 0.5], ["places", 0.25]]
    assert many == []
    assert quiet == [["places", 0.5], ["places", 1], ["columns", 1]]
    # Too much of all of it, little enough of places: tried, and then tried more and more seldom.
    assert between[::2] == [["places", 1]] * len(between[::2]) and between[1::2] == [["columns", 1]] * len(
        between[1::2]
    )
    assert 1 <= len(between) <= 8


def test_a_token_in_the_query_is_not_used_and_the_page_says_why(open_phone, bridge, tokens, robots):
    page = open_phone(bridge, f"?token={tokens['operator']}")
    text_is(page, "#login-reason", "logs and histories")
    assert "token" not in page.url
    assert page.locator("#connection").inner_text() == "not signed in"


def test_a_wrong_token_is_told_and_the_right_one_typed_in(open_phone, bridge, tokens, robots):
    page = open_phone(bridge, "#token=fleet_op_wrong_token", expected=("401",))
    text_is(page, "#login-reason", "This token is not known")
    page.locator("#token").fill(tokens["viewer"])
    page.locator("#remember").check()
    page.locator("#login-form button").tap()
    is_connected(page)
    assert page.evaluate("localStorage.getItem('fleet-field-token')") == tokens["viewer"]
    page.locator("#menu-button").tap()
    page.locator("#sign-out").tap()
    text_is(page, "#login-title", "Sign in")
    assert page.evaluate("localStorage.length + sessionStorage.length") == 1  # the language


def test_a_token_that_is_revoked_ends_the_session_with_the_reason(open_phone, bridge, desk):
    token = desk.ask("add_operator", {"operator": "Temp", "role": "operator"})["token"]
    page = open_phone(bridge, f"#token={token}")
    is_connected(page)
    desk.ask("revoke_token", {"operator": "Temp"})
    text_is(page, "#login-reason", "revoked")
    page.locator("#stop").tap(force=True)
    text_is(page, "#stop-state", "NOT STOPPED: this phone is not signed in")


def test_a_target_is_tapped_confirmed_and_reached(phone, desk):
    page = phone("operator")
    select(page, "r1")
    page.locator("#target").tap()
    assert page.locator("#send").is_disabled()
    # The robot is in the middle of what is seen of the map; 40 points are some 20 m.
    above = page.locator("#map").bounding_box()
    below = page.locator("#target-panel").bounding_box()
    page.touchscreen.tap(above["x"] + above["width"] / 2 + 40, (above["y"] + below["y"]) / 2)
    text_is(page, "#target-help", r"To 46\.88\d+, 16\.84\d+")
    before = set(desk.commands)
    page.locator("#send").tap()
    report = desk.until(lambda: newest(desk, before))
    assert (report["robot"], report["op"], report["params"]["cone"]) == ("r1", "SetPosEnd", False)
    assert report["steps"][0]["by"] == "Operator"
    desk.wait_for_step(report["command"], "reached", 60)
    text_is(page, "#robot-task", "SetPosEnd, reached")


def test_coordinates_of_four_systems_name_the_same_place(phone, desk):
    from pyproj import Transformer

    page = phone("operator")
    select(page, "r1")
    places = {"EPSG:4326": ("16.8433051", "46.8800859"), "EPSG:32633": ("640450", "5193488")}
    for crs in ("EPSG:23700", "EPSG:3857"):
        east, north = Transformer.from_crs("EPSG:32633", crs, always_xy=True).transform(640450, 5193488)
        places[crs] = f"{east:.3f}", f"{north:.3f}".replace(".", ",")
    for crs, (x, y) in places.items():
        page.locator("#coordinates").tap()
        page.locator("#place-crs").select_option(crs)
        page.locator("#place-x").fill("here")
        page.locator("#send").tap()
        text_is(page, "#target-answer", "here is not a number")
        page.locator("#place-x").fill(x)
        page.locator("#place-y").fill(y)
        before = set(desk.commands)
        page.locator("#send").tap()
        report = desk.until(lambda before=before: newest(desk, before))
        assert report["params"]["x"] == pytest.approx(30, abs=0.05)
        assert report["params"]["y"] == pytest.approx(8, abs=0.05)


def test_what_the_gateway_refuses_is_said_and_can_be_corrected(phone, desk):
    page = phone("operator")
    select(page, "r1")
    page.locator("#coordinates").tap()
    page.locator("#place-x").fill("2.1")
    page.locator("#place-y").fill("41.4")
    page.locator("#send").tap()
    text_is(page, "#target-answer", "Refused: .*not on the site|Refused: .*outside")
    assert page.locator("#send").is_enabled() and page.locator("#place-x").input_value() == "2.1"


def test_pause_resume_and_abort_reach_the_robot(phone, desk):
    page = phone("operator")
    desk.send("far-away-1", "r2", "SetPosEnd", x=20.0, y=60.0)
    select(page, "r2")
    page.locator("#pause").tap()
    desk.until(lambda: desk.queues.get("r2", {}).get("state") == "paused")
    page.locator("#resume").tap()
    desk.until(lambda: desk.queues["r2"]["state"] == "running")
    page.locator("#abort").tap()

    def aborts():
        return [one for one in desk.commands.values() if (one["robot"], one["op"]) == ("r2", "Abort")]

    desk.until(lambda: any("field page" in str(one["steps"]) for one in aborts()))


def test_a_viewer_may_look_and_the_stop_says_at_once_that_it_does_not(phone, desk):
    page = phone("viewer")
    select(page, "r1")
    assert page.locator("#abort").is_disabled() and page.locator("#target").is_disabled()
    text_is(page, "#robot-answer", "may only look")
    page.locator("#stop").tap()
    text_is(page, "#stop-state", "NOT STOPPED: your role, viewer, may not stop robots")
    assert not desk.ask("hello", {"operator": "x"})["emergency"]["in_force"]


def test_the_stop_reaches_every_robot_and_a_supervisor_clears_it_by_two_presses(phone, desk):
    page = phone("supervisor")
    page.locator("#stop").tap()
    text_is(page, "#stop-state", r"STOP IN FORCE, by Supervisor: 3 of 3 robots have answered")
    desk.until(lambda: desk.emergency["in_force"] and desk.emergency["acknowledged"] == 3)
    page.locator("#clear").tap()
    text_is(page, "#clear", "Press again")
    assert desk.ask("hello", {"operator": "x"})["emergency"]["in_force"]
    page.locator("#clear").tap()
    desk.until(lambda: not desk.emergency["in_force"])
    text_is(page, "#connection", "^connected$")
    page.locator("#clear").wait_for(state="hidden", timeout=SLOW)


def test_a_robot_that_stood_and_is_not_heard_any_more_is_named(phone, desk):
    page = phone("operator")
    page.locator("#stop").tap()
    text_is(page, "#stop-state", r"3 of 3 robots have answered, 3 stand\.$")
    freeze(desk.processes["r3"].pid)
    try:
        text_is(page, "#stop-state", r"3 robots have answered, 2 stand\. Not heard now, may move: r3$")
    finally:
        desk.processes["r3"].send_signal(signal.SIGCONT)
    text_is(page, "#stop-state", r"3 stand\.$")


def test_what_moves_and_which_gateways_were_not_reached_is_said(phone):
    report = {
        **{"in_force": True, "stop": "s", "by": "Ada", "stored": True, "waiting": [], "refused": []},
        **{"robots": 60, "acknowledged": 60, "standing": 3, "unheard": [], "unheard_more": 0},
        **{"moving": [f"m{k}" for k in range(50)], "moving_more": 7},
        "gateways": {"reached": 1, "of": 2, "missing": ["east"]},
    }
    said = phone("operator").evaluate(
        """async (report) => {
          const { EmergencyStop } = await import("/field/stop.js");
          const parts = { button: document.createElement("button"), state: document.createElement("p"),
                          clear: document.createElement("button") };
          new EmergencyStop({ isUp: true }, parts, () => "operator").update(report);
          return parts.state.textContent;
        }""",
        report,
    )
    assert said.endswith(
        "3 stand. MOVING: m0, m1, m2, m3, m4 +52 At 1 of 2 gateways. "
        "NOT REACHED: gateways east. Watch their robots."
    )


def test_an_operator_stops_and_is_not_offered_to_clear(phone, desk):
    page = phone("operator")
    page.locator("#stop").focus()
    page.keyboard.press("Enter")
    text_is(page, "#stop-state", "STOP IN FORCE, by Operator")
    assert page.locator("#clear").is_hidden()


def test_the_stop_is_pressed_with_a_second_thumb_while_the_first_holds_the_map(phone, desk):
    page = phone("operator")
    session = page.context.new_cdp_session(page)
    box, stop = page.locator("#map").bounding_box(), page.locator("#stop").bounding_box()
    on_map = {"x": box["x"] + 100, "y": box["y"] + 200, "id": 1}
    on_stop = {"x": stop["x"] + stop["width"] / 2, "y": stop["y"] + stop["height"] / 2, "id": 2}
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [on_map]})
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [on_map, on_stop]})
    # Neither thumb has left the glass.
    desk.until(lambda: desk.emergency["in_force"] and desk.emergency["by"] == "Operator")
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def test_a_stop_without_an_answer_says_so_and_is_sent_until_there_is_one(phone, desk, bridge):
    page = phone("operator")
    freeze(bridge.gateway.pid)
    try:
        page.locator("#stop").tap()
        text_is(page, "#stop-state", "NOT CONFIRMED for .*own stop buttons")
        text_is(page, "#banners", "does not answer")
    finally:
        bridge.gateway.send_signal(signal.SIGCONT)
    text_is(page, "#stop-state", "^STOP IN FORCE")
    stops = bridge.sql(
        "select count(*) from emergency_stops where \"by\" = 'Operator' and cleared_at is null"
    )
    assert stops == [(1,)]


def test_a_clock_of_the_phone_that_is_wrong_changes_no_age(phone, desk):
    page = phone("operator")
    page.evaluate(AHEAD)
    select(page, "r3")
    text_is(page, "#robot-facts", r"fresh · heard [0-3] s ago")


def test_positions_are_asked_for_every_600_ms_where_that_is_chosen(phone, desk):
    page = phone("operator")
    sent = []
    page.on("websocket", lambda socket: socket.on("framesent", lambda frame: sent.append(frame)))
    page.reload()
    is_connected(page)
    page.locator("#menu-button").tap()
    page.locator("#updates").select_option("poll")
    wait_until(lambda: page.wait_for_timeout(50) or sum("get_positions" in str(frame) for frame in sent) >= 4)
    text_is(page, "#robots", "r1: fresh")


def test_the_page_speaks_the_languages_of_its_users(phone, desk):
    page = phone("operator", locale="hu-HU")
    text_is(page, "#stop", "VÉSZLEÁLLÍTÁS")
    assert page.evaluate("document.documentElement.lang") == "hu"
    page.locator("#menu-button").tap()
    texts = {"ca": "ATURADA D'EMERGÈNCIA", "es": "PARADA DE EMERGENCIA", "en": "EMERGENCY STOP"}
    for language, stop in texts.items():
        page.locator("#language").select_option(language)
        text_is(page, "#stop", stop)


def test_a_background_map_that_is_down_is_said_and_takes_nothing_else_along(phone, desk, tokens):
    page = phone("operator", expected=("404", "ERR_"))
    tiles = {"url": "/nothing/{z}/{x}/{y}.png", "attribution": "x", "largest_zoom": 19}
    tell_of_site(page, tokens, tiles=tiles)
    page.reload()
    is_connected(page)
    text_is(page, "#banners", "background map does not answer")
    wait_until(lambda: drawn(page) > 500)


def test_a_page_of_an_older_version_offers_the_new_one(phone, desk, tokens):
    page = phone("operator")
    tell_of_site(page, tokens, gateway="9.9")
    page.reload()
    text_is(page, "#banners", "upgraded from .* to 9.9")
    page.unroute_all()
    with page.expect_navigation():
        page.locator("#banners button").tap()
    is_connected(page)
    assert page.locator("#banners").inner_text() == ""


ALL_RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]
OF_COLOURS = {"type": "rule", "values": ["color-contrast", "link-in-text-block"]}
"""What a dark page can have wrong that a light one has right."""


def test_axe_finds_nothing_on_any_view(phone, desk, open_phone, bridge):
    axe_core = pytest.importorskip("axe_core_python.sync_playwright", reason="axe looks for barriers")
    page = phone("supervisor", bypass_csp=True)
    found = {}

    def look(view):
        for scheme, rules in (("light", ALL_RULES), ("dark", OF_COLOURS)):
            page.emulate_media(color_scheme=scheme)
            answer = axe_core.Axe().run(page, options={"runOnly": rules})
            for one in answer["violations"]:
                found[view, scheme, one["id"]] = [node["target"] for node in one["nodes"]]
        page.emulate_media(color_scheme="light")

    look("map")
    page.locator("#menu-button").tap()
    look("menu")
    page.locator("#robots button").first.tap()
    look("robot")
    page.locator("#coordinates").tap()
    look("target")
    page.locator("#cancel").tap()
    page.locator("#stop").tap()
    text_is(page, "#stop-state", "STOP IN FORCE")
    look("stopped")
    page.locator("#menu-button").tap()
    page.locator("#sign-out").tap()
    look("login")
    assert found == {}


@pytest.fixture
def notify(phone):
    """The page of a viewer, and what sends it notifications of alarms in place of its gateway."""
    page, sockets = phone("viewer"), []

    def pass_on(socket):
        gateway = socket.connect_to_server()
        kept_back = ('"geofence"', '"nearness"')
        gateway.on_message(
            lambda frame: (
                None
                if isinstance(frame, str) and any(f'"method":{name}' in frame for name in kept_back)
                else socket.send(frame)
            )
        )
        sockets.append(socket)

    page.route_web_socket(re.compile("/desk"), pass_on)
    page.reload()
    page.locator("#connection.up").wait_for(timeout=SLOW)

    def send(method, **params):
        sockets[-1].send(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}))

    return page, send


def test_alarms_that_are_not_listed_are_counted(notify):
    page, send = notify
    near = {"seen": "anna", "robot": "r2", "metres": 5.0, "seconds": 0.0, "x": 1.0, "y": 2.0, "since": 3.0}
    send("nearness", t=1.0, metres=5.0, within_s=10.0, alarms=[near] * 60, more=7)
    text_is(page, "#menu-button", re.compile(r"\(67 !\)"))
    page.locator("#menu-button").click()
    rows = page.locator("#alarms li")
    assert rows.count() == 51 and rows.last.text_content() == "17 more alarms"


def test_the_geofences_alarms_that_are_not_listed_are_counted(notify):
    page, send = notify
    inside = {"robot": "r2", "kind": "keepout", "name": "Basin", "since": 1.0, "x": 1.0, "y": 2.0}
    alarms = [{**inside, "action": "none", "outcome": "none", "current": True}] * 300
    send("geofence", t=1.0, alarms=alarms, more=2700, keepouts=1, obstacles=0, unjudged=[], unjudged_more=0)
    text_is(page, "#menu-button", re.compile(r"\(3000 !\)"))


def test_a_gateway_that_is_gone_is_said_and_found_again(open_phone, bridge, tokens, robots):
    """The last one here: it ends the supervisor's desk."""
    page = open_phone(bridge, f"#token={tokens['operator']}", expected=GATEWAY_LOST)
    is_connected(page)
    bridge.kill_gateway()
    text_is(page, "#banners", "does not answer. Robots are shown where they were")
    text_is(page, "#connection", "no answer for")
    bridge.start_gateway()
    is_connected(page)
    text_is(page, "#connection", "^connected$")
