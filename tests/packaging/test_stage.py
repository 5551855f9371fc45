"""The demonstration claims only what happened, and leaves no process behind."""

from __future__ import annotations

import contextlib
import copy
import os
import re
import select
import signal
import subprocess
import sys
import time

import pytest

from tests.support.errors import StageError
from tests.support.patience import BUSY
from tests.support.processes import Processes, is_running
from tests.support.session import follow
from tests.support.verdict import Errand, judge

SLEEP = [sys.executable, "-c", "import time; print('ready', flush=True); time.sleep(60)"]
STUBBORN = [
    sys.executable,
    "-c",
    "import signal, time; signal.signal(15, signal.SIG_IGN)\nprint('ready', flush=True); time.sleep(60)",
]
INTERRUPTED = """\
import sys, time
from pathlib import Path
from tests.support.processes import Processes, leave_on_signals
leave_on_signals()
with Processes(Path(sys.argv[1])) as processes:
    print(processes.start("one", sys.argv[2:]).pid, flush=True)
    time.sleep(60)
"""
ENDING = """\
import sys
from tests.support.errors import StageError
from tests.support.program import ended
def work():
    {work}
sys.exit(ended("show", work, "logs: here"))
"""


def test_an_exception_ends_every_process(tmp_path):
    with pytest.raises(ZeroDivisionError), Processes(tmp_path) as processes:
        pids = [processes.start(name, SLEEP).pid for name in ("one", "two")]
        processes.wait_for_line("two", "ready", 10)
        raise ZeroDivisionError
    assert not any(map(is_running, pids))


def test_a_process_that_ignores_sigterm_is_killed(tmp_path, monkeypatch):
    monkeypatch.setattr("tests.support.processes.PATIENCE_S", 0.2)
    with Processes(tmp_path) as processes:
        pid = processes.start("stubborn", STUBBORN).pid
        processes.wait_for_line("stubborn", "ready", 10)
    assert not is_running(pid)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_signal_ends_every_process(tmp_path, root, number):
    env = {**os.environ, "PYTHONPATH": str(root)}
    command = [sys.executable, "-c", INTERRUPTED, tmp_path, *SLEEP]
    with subprocess.Popen(
        command, env=env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as outer:
        pid = int(outer.stdout.readline())
        outer.send_signal(number)
        assert outer.wait(BUSY * 10) != 0
    assert not is_running(pid)


def test_a_killed_program_leaves_no_process_behind(tmp_path, root):
    env = {**os.environ, "PYTHONPATH": str(root)}
    command = [sys.executable, "-c", INTERRUPTED, tmp_path, *STUBBORN]
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True) as outer:
        ended = os.pidfd_open(int(outer.stdout.readline()))
        while "ready" not in (tmp_path / "one.log").read_text():
            assert outer.poll() is None
            time.sleep(0.05)
        outer.kill()
    try:
        assert select.select([ended], [], [], 30) == ([ended], [], [])
    finally:
        with contextlib.suppress(ProcessLookupError):
            signal.pidfd_send_signal(ended, signal.SIGKILL)
        os.close(ended)


FORKING = """\
import sys, time
from pathlib import Path
from tests.support.processes import Processes
processes = Processes(Path(sys.argv[1]))
processes.__enter__()
robot = processes.start_bridge("robot", ["robot", "--url", "ws://127.0.0.1:1/robot", "--name", "r1"])
processes.wait_for_line("robot", "127.0.0.1:1", 60)
print(robot.pid, flush=True)
time.sleep(60)
"""


def test_a_forked_program_is_a_child_that_ends_with_its_status(tmp_path):
    with Processes(tmp_path) as processes:
        assert processes.start_bridge("version", ["--version"]).wait(60) == 0
        assert re.fullmatch(r"\d+\.\d+\S*\n", processes.log("version").read_text())
        assert processes.start_bridge("wrong", ["serve", "--site", tmp_path / "none"]).wait(60) == 1
        assert processes.log("wrong").read_text().startswith(f"robot-bridge: {tmp_path}/none is no folder")
        killed = processes.start_bridge("robot", ["robot", "--url", "ws://127.0.0.1:1/robot", "--name", "r1"])
        processes.wait_for_line("robot", "127.0.0.1:1", 60)
        os.kill(killed.pid, signal.SIGKILL)
        assert killed.wait(60) == -signal.SIGKILL


def test_a_forked_program_dies_with_the_program_that_asked_for_it(tmp_path, root):
    asking = subprocess.Popen(
        [sys.executable, "-c", FORKING, tmp_path], cwd=root, stdout=subprocess.PIPE, text=True
    )
    pid = int(asking.stdout.readline())
    assert is_running(pid)
    asking.kill()
    asking.wait(60)
    asking.stdout.close()
    until = time.monotonic() + 60
    while is_running(pid) and time.monotonic() < until:
        time.sleep(0.05)
    assert not is_running(pid)


def test_a_process_that_ends_too_early_is_told_with_its_last_words(tmp_path):
    with Processes(tmp_path) as processes:
        processes.start("short", [sys.executable, "-c", "import sys; sys.exit('no such site')"])
        with pytest.raises(StageError, match=r"(?s)short ended with status 1 .*no such site"):
            processes.wait_for_line("short", "listening", 10)
        with pytest.raises(StageError, match="short ended with status 1"):
            processes.require_running()
        processes.require_running(but=["short"])


def test_waiting_for_a_line_has_an_end(tmp_path):
    with Processes(tmp_path) as processes:
        processes.start("silent", SLEEP)
        began = time.monotonic()
        with pytest.raises(StageError, match="silent was not ready after 0 s"):
            processes.wait_for_line("silent", "never said", 0.2)
        assert time.monotonic() - began < 30


# Like a session inside QGIS that never comes to its end.
HANGS = """
import faulthandler, json, signal, sys, time
faulthandler.register(signal.SIGUSR1, file=2)
open(sys.argv[1], "w").write(json.dumps({"step": "connected"}) + "\\n")
def wait_for_ever():
    time.sleep(60)
wait_for_ever()
"""


def test_what_never_ends_tells_where_it_is(tmp_path):
    journal = tmp_path / "journal"
    with Processes(tmp_path) as processes:
        qgis = processes.start("qgis", [sys.executable, "-c", HANGS, journal])
        with pytest.raises(StageError, match=r'(?s)not done after 3 s.*"connected".*in wait_for_ever'):
            list(follow(processes, qgis, journal, 3.0))


REACHED = Errand("r1", (58.0, 8.0), "reached")
COMMAND = {
    "robot": "r1",
    "op": "SetPosEnd",
    "params": {"x": 58.1, "y": 8.0, "cone": True},
    "steps": [
        {"state": state, "at": 100.0 + number}
        for number, state in enumerate(("queued", "delivered", "acknowledged", "reached"))
    ],
}
POSES = {"r1": {"x": 58.05, "y": 8.0}}


def test_a_reached_target_is_accepted_with_its_figures():
    outcome = judge(REACHED, [COMMAND, {"robot": "r1", "op": "Abort"}], POSES, 0.2)
    assert outcome.after == {"delivered": 1.0, "acknowledged": 2.0, "reached": 3.0}
    assert outcome.off_target == pytest.approx(0.05)


def with_steps(*states: str) -> dict:
    command = copy.deepcopy(COMMAND)
    command["steps"] = [{"state": state, "at": 100.0} for state in states]
    return command


WRONG = [
    ([], POSES, "knows 0 commands for r1"),
    ([COMMAND, COMMAND], POSES, "knows 2 commands for r1"),
    ([with_steps("queued", "delivered", "acknowledged")], POSES, "queued → delivered → acknowledged, not"),
    ([with_steps("queued", "delivered", "acknowledged", "aborted")], POSES, "aborted, not"),
    ([with_steps("queued", "acknowledged", "delivered", "reached")], POSES, "went queued → acknowledged"),
    ([COMMAND], {"r1": {"x": 58.4, "y": 8.0}}, r"stands 0\.30 m from its target"),
    ([{**COMMAND, "params": {"x": 60.0, "y": 8.0}}], POSES, r"\(58\.0, 8\.0\) was clicked"),
]


@pytest.mark.parametrize(("commands", "poses", "complaint"), WRONG)
def test_anything_else_is_refused(commands, poses, complaint):
    with pytest.raises(StageError, match=complaint):
        judge(REACHED, commands, poses, 0.2)


@pytest.mark.parametrize(
    ("work", "status", "told"),
    [
        ("pass", 0, ""),
        ("raise StageError('there is no screen')", 1, "show: error: there is no screen\n(logs: here)\n"),
        ("raise KeyboardInterrupt", 130, ""),
        ("import os; os.kill(os.getpid(), 15)", 128 + 15, ""),
    ],
)
def test_a_program_ends_with_its_status_and_what_went_wrong_in_one_line(root, work, status, told):
    program = [sys.executable, "-c", ENDING.format(work=work)]
    done = subprocess.run(program, cwd=root, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (status, told)
