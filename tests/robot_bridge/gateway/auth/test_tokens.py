"""Tokens, buckets, and who may listen where: what needs no database and no socket."""

from __future__ import annotations

import hashlib

import pytest

from robot_bridge.core.errors import AccessError
from robot_bridge.core.reconnection import ClientCredentials, read_token
from robot_bridge.gateway.auth.accounts import TokenKind, bearer, digest, new_token
from robot_bridge.gateway.auth.client_connection import RateLimit
from robot_bridge.gateway.auth.port import check_reach


def test_no_token_comes_twice_and_each_says_whose_kind_it_is():
    made = {new_token(TokenKind.OPERATOR) for _ in range(1000)}
    assert len(made) == 1000
    assert all(token.startswith("fleet_op_") for token in made)
    assert new_token(TokenKind.ROBOT).startswith("fleet_robot_")


def test_a_token_has_256_random_bits():
    import base64

    secret = new_token(TokenKind.OPERATOR).removeprefix("fleet_op_")
    assert len(base64.urlsafe_b64decode(secret + "=")) == 32


def test_what_is_kept_is_the_sha256():
    assert digest("fleet_op_x") == hashlib.sha256(b"fleet_op_x").hexdigest()


@pytest.mark.parametrize(
    ("header", "token"),
    [
        ("Bearer abc", "abc"),
        ("bearer  abc ", "abc"),
        ("Basic abc", None),
        ("Bearer", None),
        ("Bearer ", None),
        ("", None),
        (None, None),
        ("abc", None),
    ],
)
def test_only_a_bearers_token_is_read(header, token):
    assert bearer(header) == token


def test_a_bucket_lets_a_burst_through_and_then_its_rate(clock):
    bucket = RateLimit(10.0, 3, clock)
    assert [bucket.consume() for _ in range(4)] == [True, True, True, False]
    assert bucket.wait() == pytest.approx(0.1)
    clock.advance(0.11)
    assert [bucket.consume(), bucket.consume()] == [True, False]
    clock.advance(1000)
    assert [bucket.consume() for _ in range(4)] == [True, True, True, False]


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "127.9.9.9"])
def test_on_this_computer_alone_nothing_is_needed(host):
    check_reach(host, tls=False, accounts=False)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5"])
def test_beyond_it_tls_and_accounts_are(host):
    with pytest.raises(AccessError, match="tls create"):
        check_reach(host, tls=False, accounts=True)
    with pytest.raises(AccessError, match="operators add"):
        check_reach(host, tls=True, accounts=False)
    check_reach(host, tls=True, accounts=True)


def test_a_robots_token_does_not_travel_for_everybody_to_read(tmp_path):
    file = tmp_path / "token"
    file.write_text("fleet_robot_x\n")
    file.chmod(0o600)
    with pytest.raises(AccessError, match="use wss://"):
        ClientCredentials(file).options("ws://gateway.example.org/robot")
    options = ClientCredentials(file).options("ws://127.0.0.1:8765/robot")
    assert options == {"additional_headers": {"Authorization": "Bearer fleet_robot_x"}}
    assert "ssl" in ClientCredentials(file).options("wss://gateway.example.org/robot")


@pytest.mark.parametrize("content", ["", " \n", "two words", "schlüssel"])
def test_a_file_without_a_token_is_named(tmp_path, content):
    file = tmp_path / "token"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(AccessError, match="holds no token"):
        read_token(file)
    with pytest.raises(AccessError, match="No such file"):
        read_token(tmp_path / "none")


def test_a_token_file_that_others_can_read_is_warned_of(tmp_path, caplog):
    file = tmp_path / "token"
    file.write_text("t")
    file.chmod(0o644)
    read_token(file)
    assert "chmod 600" in caplog.text
