"""The program behind `make test-newer` touches no folder but its own, and leaves nothing when it is stopped.

Debian is not built here: `debootstrap` and `chroot` are stand-ins; namespaces, mounts and signals are real.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path
from typing import TextIO

import pytest

ENTERS_NAMESPACES = (
    os.geteuid() == 0
    and subprocess.run(["unshare", "--mount", "--pid", "--fork", "true"], check=False).returncode == 0
)
needs_namespaces = pytest.mark.skipif(not ENTERS_NAMESPACES, reason="namespaces and mounts need root")
FOLDERS = "proc sys dev tmp usr/sbin etc/ssl/certs"


@pytest.fixture
def newer(root, tmp_path):
    """Start the program with stand-ins (name: shell text) on PATH; its folder is tmp_path/place."""
    programs = tmp_path / "bin"
    programs.mkdir()
    started = []

    def start(given: dict[str, str], **environment: str) -> subprocess.Popen[str]:
        stand_ins = {"id": "echo 0", "git": "", "debootstrap": "exit 9", "chroot": "exit 9", **given}
        for name, text in stand_ins.items():
            (programs / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
            (programs / name).chmod(0o755)
        process = subprocess.Popen(
            [root / "tools" / "newer.sh"],
            env={
                **os.environ,
                "PATH": f"{programs}:{os.environ['PATH']}",
                "PLACE": str(tmp_path / "place"),
                **environment,
            },
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def said(process: subprocess.Popen[str]) -> str:
    """What the program said until its end, which is a failure."""
    output, _ = process.communicate(timeout=240)
    assert process.returncode != 0, output
    return output


def wait_until_gone(held: TextIO) -> None:
    """Return when the last process that had locked the file is gone."""
    give_up = time.monotonic() + 240
    while time.monotonic() < give_up:
        with contextlib.suppress(BlockingIOError):
            return fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        time.sleep(0.02)
    pytest.fail("a process of the run that was stopped is still there")


def wait_for(file: Path, process: subprocess.Popen[str]) -> None:
    while not file.exists():
        assert process.poll() is None, process.communicate()
        time.sleep(0.02)


def test_without_root_it_says_how_to_become_it(newer):
    assert "Run: sudo make test-newer" in said(newer({"id": "echo 1000"}))


def test_without_debootstrap_it_says_how_to_get_it(newer, tmp_path):
    few = tmp_path / "few"
    few.mkdir()
    (few / "dirname").symlink_to(shutil.which("dirname"))
    (few / "id").symlink_to(tmp_path / "bin" / "id")
    assert "Run: apt-get install debootstrap" in said(newer({}, PATH=str(few)))


@pytest.mark.parametrize("place", ["here", "./here", "/"])
def test_a_place_that_is_no_absolute_path_is_refused(newer, place):
    assert f"PLACE={place} is no absolute path" in said(newer({}, PLACE=place))


def test_a_folder_that_is_in_use_for_something_else_is_left_alone(newer, tmp_path):
    letter = tmp_path / "place" / "letter"
    letter.parent.mkdir()
    letter.write_text("mine")
    assert "holds something that this program did not put there" in said(newer({}))
    assert letter.read_text() == "mine"
    assert [entry.name for entry in letter.parent.iterdir()] == ["letter"]


def test_only_one_run_at_a_time_has_the_folder(newer, tmp_path):
    with (tmp_path / "place.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        assert "another run is at work" in said(newer({}))


@needs_namespaces
def test_what_a_stopped_build_left_is_built_anew(newer, tmp_path):
    place = tmp_path / "place"
    place.mkdir()
    (place / ".fleet-newer").touch()
    (place / "half").touch()
    assert "debootstrap failed" in said(newer({"debootstrap": "echo the mirror is gone; exit 1"}))
    assert [entry.name for entry in place.iterdir()] == [".fleet-newer"]
    assert "the mirror is gone" in (tmp_path / "place.log").read_text()


@needs_namespaces
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL])
def test_a_run_that_is_stopped_leaves_neither_process_nor_mount(newer, tmp_path, how):
    alive = tmp_path / "alive"
    work = (
        f'grep -h SigIgn /proc/self/status >{tmp_path}/deaf; exec 8>{alive}; flock 8; touch "{alive}.now"; '
        "sleep 1000 & exec sleep 1000"
    )
    mounts = Path("/proc/self/mountinfo").read_text()
    process = newer(
        {"debootstrap": f'cd "$3" && mkdir -p {FOLDERS}', "chroot": work},
    )
    wait_for(Path(f"{alive}.now"), process)

    process.send_signal(how)
    said_last = said(process)

    with alive.open() as held:
        wait_until_gone(held)
    assert Path("/proc/self/mountinfo").read_text() == mounts
    assert how == signal.SIGKILL or "nothing of the run is left" in said_last
    deaf_to = int((tmp_path / "deaf").read_text().split()[1], 16)
    assert not deaf_to & (1 << (signal.SIGINT - 1)), "the tests in there would not hear Ctrl-C"
