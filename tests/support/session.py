"""Runs one session of ``inside_qgis`` in a QGIS Desktop of its own, and passes on what happens in it."""

from __future__ import annotations

import json
import signal
import subprocess
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tests.support.errors import StageError
from tests.support.processes import Processes
from tests.support.qgis import Profile, program
from tools.plugin_files import ROOT

SESSIONS = ROOT / "tests" / "support" / "inside_qgis"
BROKEN = "An error occurred during execution of following code"
"""What QGIS prints when the script itself cannot be run; nothing would come of waiting for it."""


def start_qgis(
    processes: Processes,
    profile: Profile,
    session: str,
    plan: Mapping[str, object],
    display: str | None,
    *,
    path: str | None = None,
    settings: Mapping[str, str] | None = None,
) -> subprocess.Popen[bytes]:
    """Open QGIS Desktop and let ``session`` (a file of tests/support/inside_qgis) work by ``plan`` in it.

    ``plan["journal"]`` names the file that the session writes down in what happened. ``path`` is where QGIS
    finds other programs, in place of this program's PATH; ``settings`` is what else its environment holds.
    """
    journal = Path(str(plan["journal"]))
    journal.unlink(missing_ok=True)
    plan_file = journal.with_name("plan.json")
    plan_file.write_text(json.dumps(plan, indent=2), encoding="utf-8")
    env = profile.environment(packages=False) | {"FLEET_DEMO_PLAN": str(plan_file)} | dict(settings or {})
    if display is not None:
        env |= {"DISPLAY": display, "QT_QPA_PLATFORM": "xcb"}
    if path is not None:
        env |= {"PATH": path}
    options = ["--nologo", "--noversioncheck", "--profile", "default", "--code", SESSIONS / session]
    return processes.start("qgis", [program("qgis"), *options], env=env)


def play(
    processes: Processes,
    folder: Path,
    session: str,
    plan: Mapping[str, object],
    seconds: float,
    *,
    display: str | None,
    killed: Collection[str] = (),
    settings: Mapping[str, str] | None = None,
) -> Iterator[dict[str, Any]]:
    """Let ``session`` work by ``plan`` in a QGIS with a profile in ``folder``, and :func:`follow` it.

    :param display: the screen that it opens on; None for the user's own.
    """
    journal = folder / "journal.jsonl"
    told = {"journal": str(journal), **plan}
    profile = Profile(folder / "profile", link=False)
    qgis = start_qgis(processes, profile, session, told, display, settings=settings)
    return follow(processes, qgis, journal, seconds, killed)


def follow(
    processes: Processes,
    qgis: subprocess.Popen[bytes],
    journal: Path,
    seconds: float,
    killed: Collection[str] = (),
) -> Iterator[dict[str, Any]]:
    """Yield each entry of ``journal`` as it comes, until QGIS ends.

    :raises StageError: when the session failed, QGIS ended in another way than by itself, or ``seconds``
        passed, or a process that it needs has ended; those in ``killed`` may.
    """
    until = time.monotonic() + seconds
    read = 0
    while True:
        ended = qgis.poll()
        entries = journal.read_text(encoding="utf-8").splitlines() if journal.exists() else []
        for line in entries[read:]:
            entry = json.loads(line)
            if "failed" in entry:
                raise StageError(f"inside QGIS: {entry['failed']}")
            yield entry
        read = len(entries)
        if ended is not None:
            break
        if time.monotonic() > until:
            where = _where_it_is(processes, qgis, entries)
            raise StageError(f"QGIS was not done after {seconds:.0f} s; {where}")
        if not read and BROKEN in processes.log("qgis").read_text(encoding="utf-8", errors="replace"):
            raise StageError(f"QGIS could not run the session's script; its output: {processes.log('qgis')}")
        processes.require_running(but=("qgis", *killed))
        time.sleep(0.1)
    if ended != 0:
        output = processes.log("qgis").read_text(encoding="utf-8", errors="replace")
        raise StageError(f"QGIS ended with status {ended}; its output ends:\n{output[-4000:]}")


def _where_it_is(processes: Processes, qgis: subprocess.Popen[bytes], entries: Sequence[str]) -> str:
    """Return what QGIS said last, and what its threads are at."""
    qgis.send_signal(signal.SIGUSR1)
    time.sleep(1.0)
    output = processes.log("qgis").read_text(encoding="utf-8", errors="replace")
    return f"it wrote down last: {entries[-1] if entries else 'nothing'}; its output ends:\n{output[-4000:]}"
