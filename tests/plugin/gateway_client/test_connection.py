"""The link to a gateway: what it says when it fails, and that nothing is lost or done twice."""

from __future__ import annotations

import asyncio
import errno
import gc
import socket
import threading
import time
import warnings

import pytest
from fleet_supervisor.plugin.gateway_client import connection as connection_module
from fleet_supervisor.plugin.gateway_client.connection import ConnectionThread
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase, explain
from fleet_supervisor.plugin.gateway_client.fleet_state import OperatorRequest
from fleet_supervisor.plugin.ui.errors import AddressError, NotSentError
from fleet_supervisor.plugin.ui.vendored import websocket_library
from fleet_supervisor.robot_bridge.core.clock import steady_time
from qgis.PyQt.QtCore import QThread

from tests.support.patience import START


@pytest.fixture
def connection(qgis_app):
    made = ConnectionThread()
    yield made
    made.shut_down()
    assert not made.findChildren(QThread)


def phase_of(connection):
    return connection.collect_updates().link.phase


def reason_when(connection, wait, phase):
    found = []

    def there():
        link = connection.collect_updates().link
        found.append(link)
        return link.phase is phase

    wait(there, 8, what=str(phase))
    return found[-1].reason


def test_an_order_that_is_too_large_comes_back_and_keeps_no_other_from_the_gateway(
    connection, gateway, wait, monkeypatch
):
    # The gateway ends the link over it, not the desk, whose abort waits for a busy machine.
    monkeypatch.setattr(connection_module, "STOP_PATIENCE", START)
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED, what="the link")
    now = steady_time()
    connection.submit(OperatorRequest("large", "submit_plan", {"plan": "x" * 2_000_000}, now))
    connection.submit(OperatorRequest("a2", "abort", {"robot": "r1"}, now))
    answers = {}

    def answered():
        for one in connection.collect_updates().answers:
            answers[one.order.key] = one.error
        return len(answers) == 2

    wait(answered, 15, what="both answers")
    assert "no message as large as this one of 2001 kB" in answers["large"] and answers["a2"] is None
    assert gateway.requests_of("abort") == [{"robot": "r1"}]


def test_a_gateway_is_greeted_and_its_site_and_robots_arrive(connection, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    connection.open(gateway.url, "anna")
    robots, sites = {}, []

    def arrived():
        news = connection.collect_updates()
        robots.update({name: news.robots.report(row) for row, name in enumerate(news.robots.names)})
        sites.extend([news.site] if news.site else [])
        return robots

    wait(arrived, what="r1")
    assert sites == [gateway.site]
    assert robots["r1"] == gateway.robots["r1"]
    assert gateway.requests[0] == ("hello", {"operator": "anna", "protocol": 1})


def test_nothing_listening_is_said_with_place_and_remedy(connection, wait):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    connection.open(f"ws://127.0.0.1:{port}/desk", "anna")
    reason = reason_when(connection, wait, ConnectionPhase.RETRYING)
    assert reason.startswith(f"Nothing listens at 127.0.0.1:{port}.")
    assert "robot-bridge serve" in reason


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (
            # As asyncio writes them: of one address in place of the reason, of several with their numbers.
            OSError(errno.EHOSTUNREACH, "Connect call failed ('10.9.0.2', 8765)"),
            "10.9.0.2:8765 cannot be reached: No route to host. Check network and URL.",
        ),
        (
            OSError(
                "Multiple exceptions: [Errno 111] Connect call failed ('::1', 8765, 0, 0), "
                "[Errno 111] Connect call failed ('127.0.0.1', 8765)"
            ),
            "Nothing listens at 10.9.0.2:8765. Start the gateway",
        ),
        (
            OSError(
                "Multiple exceptions: [Errno 113] Connect call failed ('10.9.0.2', 8765), "
                "[Errno 101] Connect call failed ('fd00::2', 8765, 0, 0)"
            ),
            "10.9.0.2:8765 cannot be reached: Multiple exceptions: [Errno 113]",
        ),
    ],
)
def test_a_computer_that_is_off_is_not_taken_for_one_without_a_gateway(error, says):
    exceptions = websocket_library().exceptions
    assert str(explain(error, "ws://10.9.0.2:8765/desk", exceptions)).startswith(says)


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("http://127.0.0.1:8765/desk", "begins with http"),
        ("127.0.0.1:8765", "ws://"),
        ("", "is empty"),
        ("ws:///desk", "names no host"),
        ("ws://host:abc/desk", "cannot be read"),
        ("ws://host:99999/desk", "cannot be read"),
        ("ws://ho st/desk", "names no host"),
    ],
)
def test_a_url_that_cannot_be_a_gateways_is_refused_with_an_example(connection, url, says):
    with pytest.raises(AddressError, match=says) as caught:
        connection.open(url, "anna")
    assert "ws://127.0.0.1:8765/desk" in str(caught.value)
    assert not connection.is_open


class Babbler:
    """A TCP server that answers everything with the same bytes."""

    def __init__(self, says: bytes):
        self._says = says
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port = self._listening.getsockname()[1]
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while True:
            try:
                peer, _ = self._listening.accept()
            except OSError:
                return
            with peer:
                peer.recv(4096)
                peer.sendall(self._says)

    def close(self):
        # close() alone leaves the thread in accept().
        self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        self._thread.join(2)


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n", "(HTTP 404)"),
        (b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nhi", "HTTP 200"),
        (b"SSH-2.0-OpenSSH_9.2\r\n", "does not speak WebSocket"),
        (b"", "does not speak WebSocket"),
    ],
)
def test_what_is_no_gateway_is_named_and_tried_again(connection, wait, answer, says):
    babbler = Babbler(answer)
    connection.open(f"ws://127.0.0.1:{babbler.port}/desk", "anna")
    reason = reason_when(connection, wait, ConnectionPhase.RETRYING)
    babbler.close()
    assert says in reason
    assert str(babbler.port) in reason


@pytest.mark.parametrize(
    "frame",
    ["garbage", "[1]", '{"id": 1, "result": {"protocol": 1}}', "[" * 2000, b"\xff" * 40, b"\2\0\0\0{}"],
)
def test_a_websocket_that_does_not_speak_the_desks_protocol_is_named(connection, gateway, wait, frame):
    gateway.raw = frame
    connection.open(gateway.url, "anna")
    reason = reason_when(connection, wait, ConnectionPhase.RETRYING)
    assert "not the desk's protocol" in reason
    assert gateway.url in reason


def test_numbers_that_are_none_are_the_gateways_fault_and_no_crash(connection, gateway, make_robot, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    wait(lambda: gateway._sockets)
    gateway.show(make_robot("r1", x=float("nan")))
    assert "x of robot r1 is nan" in reason_when(connection, wait, ConnectionPhase.RETRYING)


def test_another_protocol_ends_the_attempts_and_says_what_to_update(connection, gateway, wait):
    gateway.protocol = 2
    connection.open(gateway.url, "anna")
    reason = reason_when(connection, wait, ConnectionPhase.FAILED)
    assert "speaks protocol 2, this plugin protocol 1" in reason
    assert len(gateway.requests_of("hello")) == 1


@pytest.mark.parametrize(
    ("url", "desk"),
    [
        ("ws://127.0.0.1:8765/robot", "ws://127.0.0.1:8765/desk"),
        ("wss://fleet.example/site-1/robot/", "wss://fleet.example/site-1/desk"),
        ("ws://127.0.0.1:8765/link", "ws://127.0.0.1:8765/desk"),
    ],
)
def test_the_address_of_robots_is_refused_with_that_of_operators(connection, url, desk):
    with pytest.raises(AddressError, match=f"where robots connect; operators connect to {desk}. Write that"):
        connection.open(url, "anna")
    assert not connection.is_open


def test_what_knows_no_desk_ends_the_attempts_and_names_the_path(connection, gateway, wait):
    """As a gateway answers at the address of robots, behind whatever path a proxy gave that."""
    gateway.answers["hello"] = lambda _params: {"error": {"code": -32601, "message": "unknown operation"}}
    connection.open(gateway.url, "anna")
    reason = reason_when(connection, wait, ConnectionPhase.FAILED)
    assert "knows no desk" in reason and "ws://127.0.0.1:8765/desk" in reason
    assert len(gateway.requests_of("hello")) == 1


def test_a_hello_that_cannot_be_right_is_not_said_for_ever(connection, gateway, wait):
    """As a gateway answers at the address of links, behind whatever path a proxy gave that."""
    error = {"code": -32602, "message": "hello: Object missing required field `kind`"}
    gateway.answers["hello"] = lambda _params: {"error": error}
    connection.open(gateway.url, "anna")
    assert "required field `kind`" in reason_when(connection, wait, ConnectionPhase.FAILED)
    assert len(gateway.requests_of("hello")) == 1


def test_a_gateway_that_turns_the_desk_away_is_quoted(connection, gateway, wait):
    gateway.refuse["hello"] = "operator 'anna' is not known here; ask the site's supervisor"
    connection.open(gateway.url, "anna")
    assert "operator 'anna' is not known here" in reason_when(connection, wait, ConnectionPhase.RETRYING)


def test_a_killed_gateway_is_found_again_on_its_port(connection, gateway, make_robot, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.stop()
    wait(lambda: phase_of(connection) is ConnectionPhase.RETRYING, 3)
    gateway.show(make_robot("r9"))
    gateway.start()
    robots = set()

    def again():
        news = connection.collect_updates()
        robots.update(news.robots.names)
        return news.link.phase is ConnectionPhase.CONNECTED and "r9" in robots

    wait(again, 6, what="the second link")
    assert len(gateway.requests_of("hello")) == 2


def test_an_unanswered_order_is_repeated_with_its_id_and_done_once(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.mute.add("send")
    params = {"command": "command-1", "robot": "r1", "op": "SetPosEnd", "params": {"x": 1.0, "y": 2.0}}
    connection.submit(OperatorRequest("command-1", "send", params, steady_time()))
    wait(lambda: gateway.requests_of("send"))
    gateway.stop()
    wait(lambda: phase_of(connection) is ConnectionPhase.RETRYING, 3)
    gateway.mute.clear()
    gateway.start()
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers, 6, what="the answer")
    assert [params["command"] for params in gateway.requests_of("send")] == ["command-1", "command-1"]
    assert list(gateway.commands) == ["command-1"]
    assert answers[0].result["state"] == "queued"


def test_an_answered_order_is_not_repeated_on_the_next_link(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    params = {"command": "command-1", "robot": "r1", "op": "Abort", "params": {}}
    connection.submit(OperatorRequest("command-1", "send", params, steady_time()))
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers)
    gateway.stop()
    wait(lambda: phase_of(connection) is ConnectionPhase.RETRYING, 3)
    gateway.start()
    wait(lambda: len(gateway.requests_of("get_commands")) == 2, 6)
    assert len(gateway.requests_of("send")) == 1


def test_an_order_that_became_old_without_a_link_is_handed_back_and_not_sent(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.mute.add("send")
    params = {"command": "command-1", "robot": "r1", "op": "Abort", "params": {}}
    connection.submit(OperatorRequest("command-1", "send", params, steady_time() - 60.0))
    wait(lambda: gateway.requests_of("send"))
    gateway.stop()
    wait(lambda: phase_of(connection) is ConnectionPhase.RETRYING, 3)
    gateway.start()
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers, 6)
    assert "it was not repeated" in answers[0].error
    assert len(gateway.requests_of("send")) == 1


def test_an_abort_that_became_old_is_not_called_an_old_target(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.mute.add("send")
    params = {"command": "command-1", "robot": "r1", "op": "Abort", "params": {}}
    connection.submit(OperatorRequest("command-1", "send", params, steady_time() - 60.0))
    wait(lambda: gateway.requests_of("send"))
    gateway.stop()
    gateway.start()
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers, 6)
    assert "ask again if it shall still stop" in answers[0].error and "drive off" not in answers[0].error


def test_a_stop_does_not_wait_for_the_next_attempt(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.stop()
    found = []

    def waits_long():
        found[:] = [connection.collect_updates().link]
        return found[0].wait(steady_time()) > 2.5

    wait(waits_long, 20, "a long wait")
    gateway.start()
    connection.submit(OperatorRequest("stop-1234", "emergency_stop", {"command": "stop-1234"}, lasting=True))
    wait(lambda: gateway.requests_of("emergency_stop"), what="the stop")
    assert steady_time() < found[0].next_try


def test_a_refusal_of_what_was_sent_on_a_lost_link_says_that_it_may_be_done(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.mute.add("remove_task")
    connection.submit(OperatorRequest("remove", "remove_task", {"robot": "r1"}, steady_time()))
    wait(lambda: gateway.requests_of("remove_task"))
    gateway.stop()
    gateway.mute.clear()
    gateway.refuse["remove_task"] = "task 1 is not in the queue"
    gateway.start()
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers, 6)
    assert answers[0].may_be_done and "may have been done then" in answers[0].error
    connection.submit(OperatorRequest("again", "remove_task", {"robot": "r1"}, steady_time()))
    wait(lambda: answers.extend(connection.collect_updates().answers) or len(answers) == 2)
    assert not answers[1].may_be_done and answers[1].error == "task 1 is not in the queue"


def test_another_link_tells_what_became_of_what_was_asked_on_the_one_before(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.mute.add("emergency_stop")
    stop = OperatorRequest("stop-1234", "emergency_stop", {"command": "stop-1234"}, steady_time())
    connection.submit(stop)
    wait(lambda: gateway.requests_of("emergency_stop"))
    connection.open(gateway.url, "anna")
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers)
    assert answers[0].order.key == "stop-1234" and "is not known" in answers[0].error


def test_closing_hands_back_what_was_not_answered(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    gateway.mute.add("send")
    params = {"command": "command-1", "robot": "r1", "op": "Abort", "params": {}}
    connection.submit(OperatorRequest("command-1", "send", params, steady_time()))
    wait(lambda: gateway.requests_of("send"))
    connection.close()
    answers = []
    wait(lambda: answers.extend(connection.collect_updates().answers) or answers)
    assert "whether it arrived is not known" in answers[0].error


def test_without_a_link_nothing_can_be_submitted(connection):
    with pytest.raises(NotSentError, match="not connected"):
        connection.submit(OperatorRequest("key", "abort_all"))


def test_a_slow_reader_gets_the_newest_state_and_no_queue(connection, gateway, make_robot, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    wait(lambda: gateway._sockets)
    for x in range(2000):
        gateway.show(make_robot("r1", x=float(x)))
    heard = []

    def newest():
        if found := connection.collect_updates().robots:
            heard.append((len(found), found.report(0).x))
        return heard and heard[-1][1] == 1999.0

    wait(newest)
    assert {count for count, _ in heard} == {1}
    assert len(heard) < 200


def test_a_gateway_that_hangs_is_noticed_within_five_seconds(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    release = threading.Event()
    gateway._loop.call_soon_threadsafe(release.wait)
    began = time.monotonic()
    wait(lambda: phase_of(connection) is not ConnectionPhase.CONNECTED, 10, what="the silence")
    took = time.monotonic() - began
    release.set()
    assert took < 15


def test_opening_and_closing_never_wait_for_the_network(connection):
    # A host that swallows everything: packets to TEST-NET-1 are answered by nobody.
    for call in (lambda: connection.open("ws://192.0.2.1:8765/desk", "anna"), connection.close):
        began = time.monotonic()
        call()
        assert time.monotonic() - began < 8


def test_a_fault_in_the_worker_becomes_a_state_and_not_a_crash(connection, gateway, wait, monkeypatch):
    async def broken(client):
        await asyncio.sleep(0)
        raise RuntimeError("a screw came loose")

    monkeypatch.setattr("fleet_supervisor.plugin.gateway_client.connection.GatewayClient.run", broken)
    connection.open(gateway.url, "anna")
    assert "a screw came loose" in reason_when(connection, wait, ConnectionPhase.FAILED)


def test_every_thread_has_ended_after_shut_down(connection, gateway, wait):
    before = threading.active_count()
    for _ in range(3):
        connection.open(gateway.url, "anna")
        wait(lambda: phase_of(connection) is ConnectionPhase.CONNECTED)
    workers = [connection._worker, *connection._ending]
    connection.shut_down()
    assert all(worker.isFinished() for worker in workers)
    assert threading.active_count() <= before


def test_a_link_that_is_cut_off_because_it_does_not_close_leaves_no_socket_behind(connection, gateway, wait):
    connection.open(gateway.url, "anna")
    wait(lambda: connection.collect_updates().link.phase is ConnectionPhase.CONNECTED)
    release = threading.Event()
    gc.collect()  # what earlier tests left does not count here
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        gateway._loop.call_soon_threadsafe(release.wait)
        connection.shut_down()
        release.set()
        gc.collect()
    left = [str(one.message) for one in warned if issubclass(one.category, ResourceWarning)]
    assert [line for line in left if "socket" in line.lower()] == []
