"""Who gets in with which token, and how soon one that is taken away holds no more; real programs."""

from __future__ import annotations

import json
import threading
import time

import pytest
from websockets.sync.client import connect

from robot_bridge.gateway.auth.accounts import TokenKind, new_token
from tests.support.bridge.bridge_accounts import bearing
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_sockets import frame, plain_socket
from tests.support.patience import BUSY
from tests.support.wire import RefusedError, is_refused, is_shut


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(scope="module")
def accounts(bridge, accounts_of):
    """Accounts on the bridge; Ada is the supervisor, r1 a robot with a token."""
    return accounts_of(bridge)


@pytest.fixture(scope="module")
def ada(bridge, accounts):
    token = accounts.operator("Ada", "supervisor")
    wait_until(lambda: is_shut(bridge.desk))
    return token


@pytest.fixture(scope="module")
def r1(accounts):
    return accounts.robot("r1")


def test_without_accounts_the_desk_is_open_and_the_first_account_closes_it(
    start_bridge, sample_site, accounts_of, close_code, refused
):
    bridge = start_bridge(sample_site)
    desk, robot = bridge.desk("Anyone"), bridge.robot("r9")
    robot.plug_in(1)
    assert desk.ask("hello", {"operator": "Anyone"})["role"] == "supervisor"
    accounts = accounts_of(bridge)
    accounts.operator("Ada", "supervisor")
    code, reason, _ = close_code(desk)
    assert (code, reason) == (4003, "accounts are in use now: connect with a token")
    status, text = refused(bridge.desk)
    assert (status, text[:12]) == (401, "No token cam")
    robot.ask("Alive")
    accounts.robot("r1")
    assert close_code(robot)[0] == 4003
    assert refused(lambda: bridge.robot("r9"))[0] == 401
    accounts.do("operators", "revoke", "Ada")
    time.sleep(1)
    assert refused(bridge.desk)[0] == 401
    bridge.end()


@pytest.mark.parametrize(
    ("header", "says"),
    [
        (None, "No token came with the request"),
        ("Bearer", "No token came"),
        ("Basic QWRhOnNlY3JldA==", "No token came"),
        ("Bearer fleet_op_guess", "This token is not known"),
        ("Bearer ' or 1=1 --", "This token is not known"),
        ("Bearer " + "x" * 4000, "This token is not known"),
        ("Bearer \xe4\xff", "This token is not known"),
    ],
)
@pytest.mark.parametrize("path", ["/desk", "/robot"])
def test_whoever_has_no_right_token_is_told_so(bridge, ada, r1, refused, path, header, says):
    headers = {} if header is None else {"Authorization": header}
    status, text = refused(lambda: connect(f"{bridge.address}{path}", additional_headers=headers))
    if status != 429:
        assert status == 401
        assert text.startswith(says)


def wait_for_patience(bridge, headers, path="/desk"):
    """Wait until refused logins from here are answered in full again."""
    from websockets.exceptions import InvalidStatus

    for _ in range(30):
        try:
            connect(f"{bridge.address}{path}", **headers).close()
            return None
        except InvalidStatus as error:
            if error.response.status_code != 429:
                return error.response.status_code, bytes(error.response.body).decode()
        time.sleep(1)
    raise AssertionError("refused for too long")


def test_too_many_wrong_tokens_are_answered_shortly_and_leave_few_traces(bridge, ada, accounts, refused):
    wrong = bearing(new_token(TokenKind.OPERATOR))
    began = time.monotonic()
    statuses = [refused(lambda: bridge.desk(**wrong))[0] for _ in range(40)]
    minutes = (time.monotonic() - began) / 60
    # One more is heard in six seconds: on a busy machine that may be the last.
    assert 429 in statuses[-3:]
    assert statuses.count(401) <= 10 + 10 * minutes + 1
    # Whoever has a token that holds comes in all the same.
    assert bridge.desk(**ada).site["id"] == "sample"
    lines = accounts.do("audit", "--who", "nobody").splitlines()
    assert 1 <= len(lines) <= 20
    assert all("refused" in line for line in lines)
    assert new_token(TokenKind.OPERATOR)[:12] not in "\n".join(lines).replace("fleet_op_guess", "")


@pytest.mark.parametrize(
    ("request_text", "status"),
    [
        ("GET /desk HTTP/1.1\r\nAuthorization: Bearer a\r\nAuthorization: Bearer b\r\n\r\n", b"400"),
        ("GET /d\u00e4sk HTTP/1.1\r\n\r\n", b"400"),
        ("GET //[ HTTP/1.1\r\n\r\n", b"400"),
        ("GET /desk?token=fleet_op_x HTTP/1.1\r\n\r\n", b"4"),
        ("GET /nothing HTTP/1.1\r\n\r\n", b"404"),
    ],
)
def test_a_request_that_cannot_be_understood_is_answered_with_what_is_wrong(
    bridge, ada, request_text, status
):
    from tests.support.hostile.fuzzing import knock

    answer = knock("127.0.0.1", bridge.port, request_text.encode(), 3)
    assert answer.split()[1].startswith(status), answer


def test_a_robots_token_opens_no_desk_and_an_operators_no_robot(bridge, ada, r1):
    status, text = wait_for_patience(bridge, r1, "/desk")
    assert (status, text) == (
        401,
        "This token is a robot's, and /desk takes an operator's. Ask whoever runs the site for a token.\n",
    )
    assert wait_for_patience(bridge, ada, "/robot")[0] == 401


def test_a_robot_is_who_its_token_says_and_nobody_else(bridge, r1, refused):
    robot = bridge.robot(**r1)
    assert robot.plug_in(7)["robot"] == "r1"
    status, text = refused(lambda: bridge.robot("r2", **r1))
    assert (status, text) == (403, "This token is robot r1's, not r2's; give each robot its own.\n")
    robot.ask("Alive")


def test_an_expired_token_opens_nothing(bridge, accounts, ada):
    late = accounts.operator("Late", "viewer", "--expires-days", str(1 / 86400))
    time.sleep(1.1)
    status, text = wait_for_patience(bridge, late)
    assert (status, text[:34]) == (401, "This token of Late has expired. As")


def test_a_token_that_expires_ends_its_connection(bridge, accounts, close_code):
    desk = bridge.desk(**accounts.operator("Soon", "viewer", "--expires-days", str(3 / 86400)))
    code, reason, _ = close_code(desk, 6)
    assert (code, reason) == (4003, "this token of Soon has expired")


def test_a_new_token_works_at_once(bridge, accounts, ada):
    for number in range(3):
        assert bridge.desk(**accounts.operator(f"New {number}", "viewer")).site


def test_revoking_ends_open_connections_within_a_second(bridge, accounts, ada, refused, close_code):
    bob = accounts.operator("Bob", "operator")
    desks = [bridge.desk(**bob) for _ in range(3)]
    ended = {}

    def wait(number):
        ended[number] = (*close_code(desks[number], 20), time.time())

    threads = [threading.Thread(target=wait, args=(number,)) for number in range(3)]
    for thread in threads:
        thread.start()
    accounts.do("operators", "revoke", "Bob")
    for thread in threads:
        thread.join()
    ((revoked_at,),) = bridge.sql("select revoked_at from tokens where owner = 'Bob'")
    assert {(code, reason) for code, reason, *_ in ended.values()} == {
        (4003, "this token of Bob was revoked")
    }
    assert len(ended) == 3
    assert max(at for *_, at in ended.values()) - revoked_at < BUSY
    assert wait_for_patience(bridge, bob)[1].startswith("This token of Bob was revoked.")


def test_a_revoked_token_ends_what_it_opened_where_ended_sessions_cannot_be_read(
    bridge, accounts, close_code
):
    desk = bridge.desk(**accounts.operator("Guy", "viewer"))
    told = "sessions that were ended elsewhere go on until then"
    bridge.sql("alter table sessions rename to away")
    try:
        wait_until(lambda: told in bridge.output())
        accounts.do("operators", "revoke", "Guy")
        assert close_code(desk)[:2] == (4003, "this token of Guy was revoked")
    finally:
        bridge.sql("alter table away rename to sessions")
    (said,) = [line for line in bridge.output().splitlines() if told in line]
    assert "no such table: sessions" in said


def test_a_revoked_robot_is_cut_off_also_when_it_does_not_agree(bridge, accounts):
    headers = accounts.robot("r5")["additional_headers"]
    raw = plain_socket(bridge, "/robot", f"Authorization: {headers['Authorization']}")
    ask = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "Ready", "params": {"magic": 5}})
    raw.sendall(frame(ask))
    accounts.do("robots", "revoke", "r5")
    until = time.monotonic() + 2 * BUSY
    # A client that goes on talking instead of answering the close.
    with pytest.raises(ConnectionError):
        while time.monotonic() < until:
            raw.sendall(frame("{}"))
            time.sleep(0.05)


def test_another_role_holds_for_open_connections(bridge, accounts):
    desk = bridge.desk(**accounts.operator("Eve", "viewer"))
    with pytest.raises(RefusedError, match="Eve is viewer"):
        desk.ask("abort_all")
    accounts.do("operators", "role", "Eve", "operator")
    wait_until(lambda: not is_refused(desk, "abort_all"))
    accounts.do("operators", "role", "Eve", "viewer")
    wait_until(lambda: is_refused(desk, "abort_all"))
    with pytest.raises(RefusedError, match="Eve is viewer"):
        desk.ask("abort_all")


def test_sessions_are_listed_and_ended_on_the_command_line_and_at_the_desk(bridge, accounts, ada, close_code):
    supervisor = bridge.desk(**ada)
    victims = [bridge.desk(**accounts.operator(f"Guest {n}", "viewer")) for n in range(2)]

    def listed():
        lines = [line.split("\t") for line in accounts.do("sessions", "list").splitlines()]
        return {name: id for id, name, *_ in lines}

    wait_until(lambda: {"Ada", "Guest 0", "Guest 1"} <= set(listed()))
    by_name = listed()
    accounts.do("sessions", "end", by_name["Guest 0"][:8], "--reason", "shift is over")
    assert close_code(victims[0])[:2] == (4004, "shift is over")
    at_desk = {s["operator"]: s["session"] for s in supervisor.ask("get_sessions")["sessions"]}
    supervisor.ask("end_session", {"session": at_desk["Guest 1"]})
    assert close_code(victims[1])[:2] == (4004, "ended by a supervisor (Ada)")

    def reasons():
        ended = supervisor.ask("get_sessions", {"ended": True})["sessions"]
        return {session["operator"]: session.get("reason") for session in ended}

    wait_until(lambda: reasons().get("Guest 0") == "shift is over")
    assert "Guest 0" not in {s["operator"] for s in supervisor.ask("get_sessions")["sessions"]}


def test_a_gateway_that_is_killed_leaves_no_session_open(start_bridge, sample_site, accounts_of):
    bridge = start_bridge(sample_site)
    accounts = accounts_of(bridge)
    bridge.desk(**accounts.operator("Ada", "viewer"))
    wait_until(lambda: accounts.do("sessions", "list"))
    bridge.kill_gateway()
    bridge.start_gateway()
    assert accounts.do("sessions", "list") == ""
    assert "the gateway ended" in accounts.do("sessions", "list", "--all")
    bridge.end()


def test_the_command_line_says_what_it_did_in_the_audit_log_without_a_token(bridge, accounts, ada):
    text = accounts.do("audit")
    assert "operators add\tAda\tdone\tsupervisor" in text
    assert "robots token\tr1\tdone" in text
    token = ada["additional_headers"]["Authorization"].split()[1]
    assert token not in text
    assert token not in bridge.output()
    done = accounts.run("audit", "--since", "yesterday")
    assert done.returncode == 1
    assert "is no time; write it like" in done.stderr


def test_an_account_that_did_nothing_is_told_from_one_that_is_unknown(accounts, ada):
    assert accounts.do("audit", "--who", "Ada", "--since", "2100-01-01") == ""
    done = accounts.run("audit", "--who", "Adda")
    assert done.returncode == 1
    assert "nobody called 'Adda' is known here; known are: " in done.stderr
