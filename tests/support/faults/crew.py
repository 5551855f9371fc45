"""Robots, a thread each: ``python -m tests.support.faults.crew FILE`` runs them until it is ended.

The file holds a :class:`Plan` as JSON.
"""

from __future__ import annotations

import json
import signal
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

from tests.support.faults.journal import Journal, entries
from tests.support.faults.mind import Mind
from tests.support.faults.wires import SqlRobot, WebSocketRobot


@dataclass(frozen=True)
class Plan:
    """Robots by name: where each connects (``ws://`` or a database) and where it stands at first.

    ``life`` counts how often this crew was started. One that ``remembers`` goes on by its journal.
    """

    robots: dict[str, tuple[str, tuple[float, float]]]
    journal: str
    life: int
    remembers: bool


def run(plan: Plan) -> None:
    """Let the robots live until SIGTERM."""
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    file = Path(plan.journal)
    past = list(entries(file)) if plan.remembers else []
    journal = Journal(file, life=plan.life)
    threads = []
    for name, (url, home) in plan.robots.items():
        mind = Mind(name, (home[0], home[1]), journal, plan.life, past)
        robot = (WebSocketRobot if url.startswith("ws") else SqlRobot)(mind, url, ended)
        threads.append(threading.Thread(target=robot.run, name=name))
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


if __name__ == "__main__":
    run(Plan(**json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))))
