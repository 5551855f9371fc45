"""Robots, a thread each: the program :data:`CREW` with a file as its word runs them until it is ended.

The file holds a :class:`Plan` as JSON.
"""

from __future__ import annotations

import json
import signal
import sys
import threading
from dataclasses import dataclass
from pathlib import Path

from tests.support.faults.mind import Journal, Mind, entries
from tests.support.forked_programs import Program
from tests.support.robots.robot_lives import MindOverSql, MindOverWebSocket

CREW = Program(
    (
        "tests.support.faults.crew",
        # What is imported only where it is needed.
        "encodings.idna",
        "psycopg",
        "pymysql",
        "websockets.sync.client",
    )
)


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
        robot = (MindOverWebSocket if url.startswith("ws") else MindOverSql)(mind, url)
        threads.append(threading.Thread(target=robot.run, args=(ended,), name=name))
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def main() -> None:
    """Run the robots of the file that the command names."""
    run(Plan(**json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))))
