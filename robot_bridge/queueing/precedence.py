"""What has to be done before a task: by whichever robot, and whenever that is given to one."""

from __future__ import annotations

from ..messages import QueueTask, TaskState
from ..queues.edits import Whereabouts
from ..queues.queue import QueuedTask
from ..store import queues
from ..store.database import Database
from .book import QueueBook

_SAID = 2
"""Tasks that are named of those that are waited for; the others are counted."""


class Precedence:
    """Tells which tasks are still waited for; those that are done once are never asked for again."""

    def __init__(self, book: QueueBook, database: Database) -> None:
        self._book = book
        self._database = database
        self._done: set[str] = set()

    async def waits_for(self, robot: str, task: QueueTask) -> str | None:
        """Return in words what ``task`` of ``robot`` waits for, None when all of that is done.

        What was taken out of its queue, or passed over, is not done: that nobody waits for it any more is for
        people to say. Raises StoreError.
        """
        wanted = [id for id in task.after or () if id not in self._done]
        if not wanted:
            return None
        queued = {one.id: (name, one) for name in self._book.names() for one in self._book.get(name).tasks}
        elsewhere = [id for id in wanted if id not in queued]
        known = await self._database.read(queues.whereabouts, elsewhere) if elsewhere else {}
        done = {id for id, found in known.items() if found.state is TaskState.DONE}
        left = [id for id in wanted if id not in done]
        if not left:
            # It is sent now, and asks no more.
            self._done.difference_update(task.after or ())
            return None
        self._done |= done
        told = []
        for id in left[:_SAID]:
            name, one = queued.get(id, ("", None))
            told.append(_gone(id, known.get(id)) if one is None else _queued(name, one, mine=name == robot))
        return _in_words(told, len(left))


def _in_words(told: list[str], count: int) -> str:
    more = f" and {count - len(told)} more" if count > len(told) else ""
    return f"waits for {', '.join(told)}{more}"


def _queued(robot: str, task: QueuedTask, *, mine: bool) -> str:
    name = f"cone {task.task.cone}" if task.task.cone else f"task {task.id}"
    if mine:
        return f"{name}, which comes later in this queue: move it to the front"
    if task.state is TaskState.FAILED:
        return f"{name} of {robot}, which failed"
    return f"{name} of {robot}"


def _gone(id: str, found: Whereabouts | None) -> str:
    if found is None:
        return f"task {id}, which no robot has been given"
    return f"task {id}, which was {found.state.value} at {found.robot}: give this task anew without it"
