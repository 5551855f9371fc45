"""What a robot of these tests does and remembers, whatever wire it speaks.

It acts on a message when it sees its id for the first time, and writes that down first. Commands carry their
number in their x: ``FIRST_X + number * STEP_X``.
"""

from __future__ import annotations

import hashlib
import json
import os
import random
import time
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from tests.support.robots.robot_lives import Said

FIRST_X, STEP_X = 10.0, 0.005
"""metres: the x of command 0, and what each further one adds."""
POSE_EVERY, OBJECT_EVERY = 0.25, 2.0
LONGEST_DRIVE = 0.4
JPEG = bytes.fromhex("ffd8ffe000104a464946")


def number_of(params: Mapping[str, Any]) -> int:
    """Return the number of the command whose parameters these are."""
    x = params["points"][0][0] if "points" in params else params["x"]
    return round((x - FIRST_X) / STEP_X)


class Journal:
    """What robots write down before they do it: a file of JSON lines that only grows.

    Each is one write: a killed process leaves whole lines.
    """

    def __init__(self, file: Path, **always: Any) -> None:
        self._always = always
        self._file = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)

    def note(self, robot: str, what: str, **details: Any) -> None:
        """Write one line."""
        line = {"at": time.time(), "robot": robot, "what": what, **self._always, **details}
        os.write(self._file, json.dumps(line).encode() + b"\n")


def entries(file: Path) -> Iterator[dict[str, Any]]:
    """Yield what was written so far, oldest first."""
    if file.is_file():
        for line in file.read_bytes().splitlines():
            yield json.loads(line)


class Mind:
    """One robot. ``past`` is its journal: one that remembers goes on as if it had not died."""

    def __init__(
        self, name: str, home: tuple[float, float], journal: Journal, life: int, past: Iterable[Any]
    ):
        self.name = name
        self._journal = journal
        self._life = life
        self._random = random.Random(f"{name} {life}")
        self.magic = 0
        self._seen: set[int] = set()
        self._database: str | None = None
        self._place = self._goal = home
        self._there_at = 0.0
        self._pose_at = 0.0
        self._object_at = time.time() + self._random.uniform(0, OBJECT_EVERY)
        self._sources = 0
        self._telling: Said | None = None
        for entry in past:
            self._remember(entry)
        if not self.magic:
            self.magic = self._random.randrange(1, 2**40)
        self.note("life", magic=self.magic)

    def note(self, what: str, **details: Any) -> None:
        """Write into the journal."""
        self._journal.note(self.name, what, **details)

    def hear(self, id: int, op: str, params: Mapping[str, Any]) -> None:
        """Do what message ``id`` says, unless it has come before."""
        if id in self._seen:
            self.note("again", id=id, op=op)
            return
        self._seen.add(id)
        if op == "Abort":
            self.note("acted", id=id, op=op)
            self._stand()
        elif op in ("SetPosEnd", "SetPath"):
            self.note("acted", id=id, op=op, number=number_of(params), goal=_end(params))
            self._drive(_end(params))
        else:
            self.note("took", id=id, op=op)

    def belongs_to(self, database: str | None) -> None:
        """Take note of the database's id; it is the same one all the time."""
        if database is not None and self._database not in (None, database):
            self.note("wrong", text=f"the database's id changed from {self._database} to {database}")
        self._database = database or self._database

    def pose(self, now: float) -> dict[str, Any] | None:
        """Return where the robot is, if it is time to say so."""
        arrived = self._place != self._goal and now >= self._there_at
        if now < self._pose_at and not arrived:
            return None
        self._pose_at = now + POSE_EVERY
        if arrived:
            self._place = self._goal
        speed = 0.0 if self._place == self._goal else 0.5
        return {"x": self._place[0], "y": self._place[1], "theta": 0.0, "v": speed, "t": now}

    def request(self, now: float) -> Said | None:
        """Return the object or the image that is told now."""
        if self._telling is None and now >= self._object_at:
            self._object_at = now + OBJECT_EVERY
            self._telling = self._saw()
        told = self._telling
        if told is None or now < told.say_at:
            return None
        told.say_at = float("inf")
        return told

    def acknowledged(self) -> None:
        """Note that the gateway acknowledged what was told."""
        if self._telling is not None:
            image = self._telling.image
            digest = None if image is None else hashlib.sha256(image).hexdigest()
            self.note("accepted", object=self._telling.params["object"], image=digest)
            self._telling = None

    def unsent(self, after: float = 0.0) -> None:
        """Tell the last observation again: it is not known whether it was taken."""
        if self._telling is not None:
            self._telling.say_at = time.time() + after

    def _saw(self) -> Said:
        self._sources += 1
        params = {
            "x": round(self._random.uniform(5, 195), 3),
            "y": round(self._random.uniform(5, 155), 3),
            "object": f"{self.name}-{self._life}-{self._sources}",
            "source": str(self._sources),
        }
        self.note("telling", source=params["source"])
        if self._random.random() < 0.3:
            return Said("SendImage", params, JPEG + self._random.randbytes(5000))
        return Said("SetObject", params)

    def _drive(self, goal: tuple[float, float]) -> None:
        self._goal = goal
        self._there_at = time.time() + self._random.uniform(0, LONGEST_DRIVE)
        self._pose_at = 0.0

    def _stand(self) -> None:
        self._goal = self._place
        self._pose_at = 0.0

    def _remember(self, entry: dict[str, Any]) -> None:
        if entry["robot"] != self.name:
            return
        if entry["what"] == "life":
            self.magic = entry["magic"]
        elif entry["what"] in ("acted", "took"):
            self._seen.add(entry["id"])
            if entry["what"] == "acted":
                self._goal = tuple(entry.get("goal", self._place))
        elif entry["what"] == "telling":
            self._sources = max(self._sources, int(entry["source"]))
        elif entry["what"] == "pose":
            self._place = tuple(entry["place"])


def _end(params: Mapping[str, Any]) -> tuple[float, float]:
    x, y = params["points"][-1] if "points" in params else (params["x"], params["y"])
    return (x, y)
