"""What is asked all the time is found by an index, and not by going through what grows with the years."""

from __future__ import annotations

import pytest
from sqlalchemy import event

from robot_bridge.core.messages.records import GetPlacements
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.repositories import commands, metadata, queues, records, trajectories
from robot_bridge.gateway.storage.repositories import commands as tracks
from robot_bridge.gateway.storage.repositories.trajectories import PageMark, TrajectoryQuery

LONG = {"commands", "command_steps", "queue_tasks", "placements", "trajectories", "observations", "audit"}
"""Tables that grow."""
QUESTIONS = {
    "the message of a late acknowledgement": (commands.find_messages, [("r1", 7), ("r2", 8), ("r3", 9)]),
    "what is open": (commands.still_open,),
    "the newest commands": (commands.newest, None, 200),
    "the newest commands of a robot": (commands.newest, "r1", 200),
    "a robot's track": (tracks.last_given_track, "r1", ["SetPosEnd", "SetPath"]),
    "where a robot has been": (trajectories.read, TrajectoryQuery(("r1",), since=1.0), 100, PageMark(2.0, 3)),
    "where all have been": (trajectories.read, TrajectoryQuery(since=1.0), 100, PageMark(2.0, 3)),
    "whether a robot was ever seen": (trajectories.never_seen, ["r1"]),
    "all queues": (queues.load,),
    "a queue": (queues.load, ["r1"]),
    "a robot's tasks that ended": (queues.newest_ended, "r1", 20),
    "where tasks are": (queues.whereabouts, ["task-0001"]),
    "what a robot told before": (records.find_reported, "r1", "1"),
    "a page of placed cones": (records.newest_placed_cones, GetPlacements(before=9)),
    "when something was stored last": (metadata.newest_time,),
    "commands to be deleted": (commands.forget, 1.0, 100),
    "positions to be deleted": (trajectories.forget, 1.0, 100),
    "tasks to be deleted": (queues.forget, 1.0, 100),
    "cones to be deleted": (records.forget, 1.0, 100),
    "images to be deleted": (records.forget_images, 1.0, 100),
}

FEW = {"what is open", "all queues", "a queue"}
"""What is found is few, and may be sorted."""


@pytest.fixture(scope="module")
def address(tmp_path_factory) -> str:
    address = f"sqlite:///{tmp_path_factory.mktemp('indexes')}/fleet.db"
    run_once(address, revisions.create)
    return address


def plan_of(connection, ask, *arguments) -> list[str]:
    """Return how SQLite goes about each statement of a question."""
    asked = []
    event.listen(
        connection, "before_cursor_execute", lambda _c, _cursor, text, given, *_: asked.append((text, given))
    )
    ask(connection, *arguments)
    explained = [
        connection.exec_driver_sql(f"explain query plan {text}", given) for text, given in list(asked)
    ]
    return [row[3] for plan in explained for row in plan]


@pytest.mark.parametrize("question", QUESTIONS)
def test_it_is_found_by_an_index(address, question):
    ask, *arguments = QUESTIONS[question]
    plan = run_once(address, plan_of, ask, *arguments)
    assert plan
    for step in plan:
        words = step.split()
        through_all = words[0] == "SCAN" and words[1] in LONG and "USING" not in words
        assert not through_all, f"{step}: {plan}"
        assert "FOR ORDER BY" not in step or question in FEW, plan
