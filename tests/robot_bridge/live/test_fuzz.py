"""Whatever comes in, the gateway answers the next question of whoever asks, and never with a traceback.

350 cases here, as every account on each kind of database; ``make bench PARTS=attack`` tries 20 000.
"""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.support.bridge.bridge_programs import wait_until
from tests.support.hostile.fuzzing import handshakes, knock, try_cases
from tests.support.hostile.siege import GENEROUS, WORST_ROWS, Siege, cases, unread_rows
from tests.support.processes import Processes
from tests.support.wire import is_shut

SAID, WAITING, BESIDE = 50, 25, 15
"""cases on each kind of database: said one by one, waiting at the start, written beside an emergency stop."""


@pytest.fixture(scope="module", params=["sqlite", "postgresql", "mariadb"])
def siege(request, limited_site, new_database, tmp_path_factory):
    url, admin = new_database.another(request.param), None
    if request.param != "sqlite":
        admin = request.getfixturevalue(f"{request.param}_server").admin_url(url)
    with Processes(tmp_path_factory.mktemp("siege") / "logs") as processes:
        siege = Siege(processes, limited_site(GENEROUS), url, admin)
        yield siege
        siege.close()


def test_every_account_may_say_anything_and_commands_and_stops_go_on(siege):
    try_cases(SAID, cases(siege.kind), siege.say)
    siege.check()


def test_a_stop_goes_out_beside_rows_of_any_kind(siege):
    beside = [("sql", row) for row in WORST_ROWS]
    try_cases(BESIDE, unread_rows, beside.append)
    siege.check(beside)


def test_a_gateway_that_was_killed_comes_back_to_rows_of_any_kind(siege):
    siege.kill()
    for row in WORST_ROWS:
        siege.say(("sql", row), unread=True)
    try_cases(WAITING, unread_rows, lambda case: siege.say(case, unread=True))
    siege.start()
    siege.check()


@pytest.fixture(scope="module")
def guarded(start_bridge, limited_site, accounts_of):
    """A gateway whose desk and robots have tokens that nobody here knows."""
    bridge = start_bridge(limited_site(GENEROUS))
    accounts = accounts_of(bridge)
    accounts.operator("Ada", "supervisor")
    accounts.robot("r1")
    wait_until(lambda: is_shut(bridge.desk))
    wait_until(lambda: is_shut(lambda: bridge.robot("r1")))
    return bridge


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=False)
@given(request=handshakes)
def test_anybody_may_knock_with_anything_and_gets_in_without_a_token_never(guarded, request):
    answer = knock("127.0.0.1", guarded.port, request)
    assert not answer.startswith(b"HTTP/1.1 101"), answer
    assert not answer.startswith(b"HTTP/1.1 500"), answer


def test_the_gateway_that_was_knocked_at_is_still_there(guarded):
    assert guarded.gateway.poll() is None


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.mark.parametrize(("path", "size"), [("/robot", 6 << 20), ("/desk", 1 << 20)])
def test_a_frame_that_is_too_large_ends_its_connection_and_no_other(bridge, path, size):
    with connect(f"{bridge.address}{path}", compression=None) as wire:
        with pytest.raises(ConnectionClosed) as caught:
            wire.send('{"jsonrpc": "2.0", "method": "' + "x" * size + '"}')
            while True:
                wire.recv(5)
        assert caught.value.rcvd.code == 1009
    assert "robots" in bridge.desk().ask("get_positions")
