"""A desk of several gateways: which one it goes on at, what it tells of that, and what it refuses."""

from __future__ import annotations

import asyncio
import time

import pytest
from fleet_supervisor.plugin.gateway_client.connection import ConnectionThread
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase
from fleet_supervisor.plugin.gateway_client.fleet_state import OperatorRequest
from fleet_supervisor.plugin.settings.profile import GATEWAYS, GatewayConnection, KnownGateways
from fleet_supervisor.robot_bridge.core.clock import steady_time
from fleet_supervisor.robot_bridge.core.reconnection import FleetGateways
from qgis.core import QgsSettings

from tests.plugin.conftest import SmallGateway
from tests.support.patience import BUSY

FLEET, OTHER_FLEET = "0b6ad7c2", "5f0b6f6f"
SOON = 2.0
"""Seconds, of an idle machine, after which a desk is at another gateway."""


@pytest.fixture
def pair(site):
    """Gateways a and b of one fleet; both tell of both."""
    both = [SmallGateway(site) for _ in range(2)]
    for one in both:
        one.start()
    for name, one, other in (("a", *both), ("b", *both[::-1])):
        one.database = FLEET
        one.who = {"gateway": name, "gateways": [one.url, other.url]}
    yield both
    for one in both:
        one.stop()


class Link:
    """A connection, and the newest that it said."""

    def __init__(self, wait):
        self.connection, self._wait = ConnectionThread(), wait
        self.status, self.answers, self.reasons = None, [], []

    @property
    def known(self):
        return self.connection._worker._client._addresses.known

    def look(self):
        update = self.connection.collect_updates()
        self.answers += update.answers
        self.status = update.link
        self.reasons.append(update.link.reason)
        return update.link

    def wait_for(self, phase, instead=None, seconds=8):
        def there():
            link = self.look()
            return link.phase is phase and (instead is None or bool(link.instead) is instead)

        self._wait(there, seconds, what=f"{phase}, not {self.status}")
        return self.status

    def wait_for_reason(self, text):
        self._wait(lambda: text in self.look().reason, 8, what=text)

    def ask(self, key, method, params):
        self.connection.submit(OperatorRequest(key, method, params, steady_time()))


@pytest.fixture
def link(qgis_app, pair, wait):
    """A desk at gateway a."""
    link = Link(wait)
    link.connection.open(pair[0].url, "anna")
    assert link.wait_for(ConnectionPhase.CONNECTED).instead == ""
    wait(lambda: pair[0].subscriptions, what="the subscription")
    yield link
    link.connection.shut_down()


def close_all(gateway, code):
    for socket in list(gateway._sockets):
        asyncio.run_coroutine_threadsafe(socket.close(code), gateway._loop)


def test_it_goes_on_at_the_other_gateway_soon_and_says_where_it_is(link, pair):
    a, b = pair
    a.stop()
    began = time.monotonic()
    instead = link.wait_for(ConnectionPhase.CONNECTED, instead=True).instead
    assert time.monotonic() - began < SOON * BUSY
    assert instead == f"at b (127.0.0.1:{b.port}); a did not answer"
    # The one that was given is tried first when that is lost, and nothing is instead of it then.
    a.start()
    b.stop()
    link.wait_for(ConnectionPhase.CONNECTED, instead=False)


def test_it_does_not_come_back_to_a_gateway_that_says_that_it_ends(link, pair):
    a, _ = pair
    close_all(a, 1012)
    link.wait_for(ConnectionPhase.CONNECTED, instead=True)
    assert len(a.requests_of("hello")) == 1


def test_addresses_that_are_told_later_count(link, pair, site, wait):
    a, b = pair
    late = SmallGateway(site)
    late.start()
    late.database = FLEET
    a.tell("gateways", {"gateway": "a", "gateways": [a.url, late.url]})
    wait(lambda: late.url in link.known, what="the address")
    b.stop()
    a.stop()
    try:
        instead = link.wait_for(ConnectionPhase.CONNECTED, instead=True).instead
        assert instead == f"at 127.0.0.1:{late.port}; a did not answer"
    finally:
        late.stop()


def test_what_was_not_answered_is_asked_there_under_its_id_and_what_was_is_not(link, pair, wait):
    a, b = pair
    a.mute.add("abort_all")
    link.ask("s1", "emergency_stop", {"command": "s1"})
    wait(lambda: link.look() and link.answers, what="the answer")
    link.ask("c1", "abort_all", {"command": "c1"})
    wait(lambda: a.requests_of("abort_all"), what="the request")
    a.stop()
    link.wait_for(ConnectionPhase.CONNECTED, instead=True)
    wait(lambda: link.look() and len(link.answers) == 2, what="the answer")
    assert b.requests_of("abort_all") == [{"command": "c1"}] and b.requests_of("emergency_stop") == []
    assert [one.error for one in link.answers] == [None, None]


def test_one_that_serves_another_fleet_by_now_is_refused(link, pair):
    """It has the port of the one that was named."""
    a, b = pair
    b.database = OTHER_FLEET
    a.stop()
    link.wait_for_reason("serves another fleet than the gateway that named it")
    assert b.requests_of("subscribe") == []
    a.start()
    link.wait_for(ConnectionPhase.CONNECTED, instead=False)


def test_one_that_refuses_keeps_the_desk_from_no_other(link, pair):
    a, b = pair
    b.protocol = 2
    a.stop()
    link.wait_for_reason("speaks protocol 2")
    link.wait_for_reason(f"Nothing listens at 127.0.0.1:{a.port}")
    assert "speaks protocol 2" in link.status.reason
    a.start()
    link.wait_for(ConnectionPhase.CONNECTED)
    # The given one refuses by now: the desk goes on at the other.
    b.protocol, a.protocol = 1, 2
    a.stop()
    a.start()
    assert link.wait_for(ConnectionPhase.CONNECTED, instead=True).instead.endswith("a refuses this desk")


def test_where_all_refuse_the_operator_reads_why_each_does(link, pair):
    a, b = pair
    a.protocol, b.protocol = 2, 3
    a.stop()
    a.start()
    reason = link.wait_for(ConnectionPhase.FAILED).reason
    assert f"{a.url} speaks protocol 2" in reason and f"{b.url} speaks protocol 3" in reason
    assert len(b.requests_of("hello")) == 1


@pytest.mark.parametrize(("code", "says"), [(4003, "new token"), (4004, "ended your session")])
def test_who_was_sent_away_by_a_supervisor_does_not_come_back_by_another_gateway(link, pair, code, says):
    a, b = pair
    close_all(a, code)
    assert says in link.wait_for(ConnectionPhase.FAILED).reason
    assert b.requests == []


def test_a_desk_that_is_opened_while_its_gateway_is_dead_goes_to_one_that_was_known(qgis_app, pair, wait):
    a, b = pair
    a.stop()
    link = Link(wait)
    link.connection.open(a.url, "anna", known=FleetGateways(FLEET, (b.url,)))
    assert link.wait_for(ConnectionPhase.CONNECTED, instead=True).instead.startswith("at b ")
    link.connection.shut_down()


def test_one_that_was_known_and_serves_another_fleet_by_now_is_refused(qgis_app, pair, wait):
    a, b = pair
    a.stop()
    b.database = OTHER_FLEET
    link = Link(wait)
    link.connection.open(a.url, "anna", known=FleetGateways(FLEET, (b.url,)))
    link.wait_for_reason("serves another fleet")
    assert b.requests_of("subscribe") == []
    link.connection.shut_down()


def test_the_window_keeps_what_gateways_told_and_connects_by_it(plugin, pair, wait):
    a, b = pair
    desk = plugin.window.desk
    panel = plugin.window.dock.connection_panel
    panel.use(GatewayConnection("pair", a.url, "anna"))
    connect = plugin.window.actions.connect
    connect.trigger()
    wait(lambda: KnownGateways().of(a.url) == FleetGateways(FLEET, (b.url,)), what="what is kept")
    connect.trigger()
    a.stop()
    connect.trigger()
    wait(lambda: desk.state.link.instead.startswith("at b "), what="the other gateway")
    # Of one that serves its fleet alone there is nothing to keep.
    KnownGateways().keep(a.url, FleetGateways(FLEET))
    assert KnownGateways().of(a.url) is None


def test_what_is_kept_and_makes_no_sense_is_passed_over(iface):
    for kept in (
        *("", "{", "[]"),
        '{"database": 1, "gateways": []}',
        '{"database": "x", "gateways": ["http://y"]}',
    ):
        QgsSettings().setValue(f"{GATEWAYS}/ws%3A%2F%2Fa", kept)
        assert KnownGateways().of("ws://a") is None, kept


def test_an_older_gateway_tells_of_no_other(qgis_app, pair, wait):
    a, b = pair
    a.who = {}
    link = Link(wait)
    link.connection.open(a.url, "anna")
    link.wait_for(ConnectionPhase.CONNECTED)
    a.stop()
    link.wait_for_reason("Nothing listens")
    a.start()
    link.wait_for(ConnectionPhase.CONNECTED, instead=False)
    assert b.requests == []
    link.connection.shut_down()
