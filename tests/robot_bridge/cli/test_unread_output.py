"""Programs whose standard output and standard error nobody reads: a terminal after Ctrl+S, a full pipe."""

import fcntl
import os
import re

import pytest

from tests.support.forked_programs import BRIDGE, start_forked
from tests.support.operators import Desk
from tests.support.patience import START
from tests.support.robots.robot_wires import RobotWire
from tests.support.wire import RefusedError

PIPE = 4096


@pytest.fixture
def start():
    """Start programs that print into a pipe; return each with both ends of its pipe."""
    started = []

    def start(*words, full=False):
        read, write = os.pipe()
        fcntl.fcntl(write, fcntl.F_SETPIPE_SZ, PIPE)
        if full:
            fill(write)
        with os.fdopen(os.dup(write), "wb") as log:
            process = start_forked(BRIDGE, words, log, {})
        started.append((process, read, write))
        return started[-1]

    yield start
    for process, read, write in started:
        process.kill()
        process.wait()
        os.close(read)
        os.close(write)


def fill(write):
    """Write into a pipe until it is full."""
    # Opened once more: only this end does not wait.
    end = os.open(f"/proc/self/fd/{write}", os.O_WRONLY | os.O_NONBLOCK)
    with pytest.raises(BlockingIOError):
        while True:
            os.write(end, b"x" * PIPE)
    os.close(end)


def test_a_gateway_whose_log_nobody_reads_stops_robots_and_ends(start, site, tmp_path):
    where = ("--site", site, "--port", "0", "--database", f"sqlite:///{tmp_path}/fleet.db")
    gateway, read, write = start("serve", *where)
    said = ""
    while (found := re.search(r"listening on (ws://\S+)\n", said)) is None:
        said += os.read(read, PIPE).decode()
    fill(write)
    with RobotWire(f"{found[1]}/robot?robot=r1") as robot, Desk(f"{found[1]}/desk", "op") as desk:
        robot.plug_in(1)
        # Each is a line of the log.
        for _ in range(3):
            with pytest.raises(RefusedError):
                robot.ask("Nonsense", {})
        desk.ask("emergency_stop", {})
        robot.wait_for("Abort")
    gateway.terminate()
    assert gateway.wait(START) == 0


@pytest.mark.parametrize(
    "words",
    [("serve", "--site", "none"), ("link", "tracker", "--config", "none.toml"), ("robot", "--name", "r1")],
    ids=lambda words: words[0],
)
def test_a_program_with_an_error_ends_where_nobody_reads_it(start, words):
    program, _, _ = start(*words, full=True)
    assert program.wait(START) == 1


def test_an_error_at_the_start_is_read_before_the_end(start):
    program, read, _ = start("robot", "--name", "r1")
    assert program.wait(START) == 1
    assert os.read(read, PIPE) == b"robot-bridge: a robot has one link: give either --url or --database\n"
