"""The log: lines for people or JSON for programs, neither with a secret in it."""

import io
import json
import logging
import os
import re

import pytest

from robot_bridge.core.logs import MOST_UNWRITTEN, BackgroundStream, set_up_log, without_secrets
from robot_bridge.gateway.auth.accounts import TokenKind, new_token


@pytest.fixture
def root_log():
    root = logging.getLogger()
    before = root.handlers[:], root.level
    yield logging.getLogger("robot_bridge.test")
    root.handlers[:], root.level = before[0], before[1]


def test_json_lines_hold_time_level_logger_and_text(root_log):
    stream = io.StringIO()
    set_up_log("json", "info", stream)
    root_log.info("robot %r said\nwhat č", "r1")
    root_log.debug("not this")
    (line,) = stream.getvalue().splitlines()
    entry = json.loads(line)
    assert entry.pop("time").endswith("+00:00")
    assert entry == {"level": "info", "logger": "robot_bridge.test", "message": "robot 'r1' said\nwhat č"}


def test_what_a_driver_raises_as_well_is_no_line(root_log):
    """psycopg warns of each failure of many statements: once a second for as long as a right is missing."""
    stream = io.StringIO()
    set_up_log(stream=stream)
    logging.getLogger("psycopg").warning("error ignored terminating pipeline: pipeline aborted")
    assert stream.getvalue() == ""


def test_an_exception_is_part_of_its_line(root_log):
    stream = io.StringIO()
    set_up_log("json", stream=stream)
    try:
        raise ValueError("postgresql://fleet:hunter2@db/fleet")
    except ValueError:
        root_log.exception("sql link: unexpected")
    entry = json.loads(stream.getvalue())
    assert "Traceback" in entry["exception"] and "hunter2" not in stream.getvalue()


@pytest.mark.parametrize("form", ["text", "json"])
@pytest.mark.parametrize("kind", list(TokenKind))
def test_a_token_is_not_in_the_log(root_log, form, kind):
    stream, token = io.StringIO(), new_token(kind)
    set_up_log(form, stream=stream)
    root_log.warning("refused: %s", token)
    root_log.warning("Authorization: Bearer %s", token)
    assert token not in stream.getvalue() and token[-20:] not in stream.getvalue()
    assert stream.getvalue().count("***") == 2


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("postgresql+psycopg://fleet:hun:ter2@db/f", "postgresql+psycopg://fleet:***@db/f"),
        ("mariadb://fleet:p%40ss@127.0.0.1:3306/f", "mariadb://fleet:***@127.0.0.1:3306/f"),
        ("password=hunter2 host=db", "password=*** host=db"),
        ("password = 'two words' host=db", "password = *** host=db"),
        ("authorization: bearer abc.def", "authorization: bearer ***"),
        ("sqlite:////srv/fleet/fleet.db", "sqlite:////srv/fleet/fleet.db"),
        ("ws://127.0.0.1:8765/robot?robot=r1", "ws://127.0.0.1:8765/robot?robot=r1"),
        ("wrong token: have it rotated", "wrong token: have it rotated"),
    ],
)
def test_what_looks_like_a_password_is_masked_and_nothing_else(text, shown):
    assert without_secrets(text) == shown


FORGED = "r1\n2026-11-23 12:00:00,000 WARNING all is well\r\x1b[2J\x9b31m\u202e\u2028\x00"


@pytest.mark.parametrize("form", ["text", "json"])
def test_no_text_from_outside_makes_a_line_of_the_log(root_log, form):
    stream = io.StringIO()
    set_up_log(form, stream=stream)
    root_log.warning("robot %s: refused", FORGED)
    (line,) = stream.getvalue().splitlines()
    assert line.isprintable()
    assert "all is well" in line
    if form == "json":
        assert json.loads(line)["message"] == f"robot {FORGED}: refused"


def test_nor_does_one_inside_a_traceback(root_log):
    stream = io.StringIO()
    set_up_log("text", stream=stream)
    try:
        raise ValueError(FORGED)
    except ValueError:
        root_log.exception("link sql: unexpected")
    first, *rest = stream.getvalue().splitlines()
    assert first.endswith("ERROR link sql: unexpected")
    assert all(line.startswith("    ") and line.isprintable() for line in rest)


@pytest.fixture
def pipe():
    read, write = os.pipe()
    with os.fdopen(read, encoding="utf-8") as reader, os.fdopen(write, "w", encoding="utf-8") as writer:
        yield reader, writer


def test_lines_beyond_those_that_wait_are_dropped_and_counted_when_the_rest_is_read(root_log, pipe):
    reader, writer = pipe
    stream = BackgroundStream("standard error", writer)
    with pytest.raises(TypeError, match="written as text"):
        stream.write(b"")
    set_up_log(stream=stream)
    count = 2 * MOST_UNWRITTEN // 100
    for number in range(count):
        stream.write(f"{number:99}\n")
    stream.finish(0.0)
    kept = 0
    while kept < count and (line := reader.readline()).strip() == str(kept):
        kept += 1
    assert MOST_UNWRITTEN // 100 <= kept < count
    assert f"ERROR {count - kept} lines of standard error were dropped" in line
    root_log.error("the next one")
    assert re.search("ERROR the next one$", reader.readline())


def test_lines_that_a_file_refuses_are_counted_once_it_takes_others(root_log, pipe):
    reader, writer = pipe
    full = os.open("/dev/full", os.O_WRONLY)
    kept = os.dup(writer.fileno())
    os.dup2(full, writer.fileno())
    stream = BackgroundStream("standard error", writer)
    set_up_log(stream=stream)
    root_log.error("not to be read \ud800")
    stream.finish(60.0)
    os.dup2(kept, writer.fileno())
    for file in (full, kept):
        os.close(file)
    root_log.error("one \ud800")
    assert "ERROR one" in reader.readline()
    # The refused one, and the one that says why it was.
    assert "2 lines of standard error were dropped" in reader.readline()
