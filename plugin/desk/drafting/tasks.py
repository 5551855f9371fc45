"""Drafts as tasks of a robot's queue."""

from __future__ import annotations

import uuid

from ....robot_bridge.messages import QueueTask, TaskKind
from ...errors import NotSentError
from ...language import tr
from ..drafts import CONE, START, TARGETS, Draft


def tasks_of(draft: Draft) -> list[QueueTask]:
    """Return what a robot has to do for a draft, one after the other.

    :raises NotSentError: for what is no task.
    """
    if draft.kind == START:
        raise NotSentError(tr("A start position is no task: Send tells the robot at once."))
    if draft.kind in (CONE, TARGETS):
        names = draft.names or (None,) * len(draft.points)
        return [
            QueueTask(str(uuid.uuid4()), x, y, kind=TaskKind.PLACE, cone=name)
            for (x, y), name in zip(draft.points, names, strict=True)
        ]
    x, y = draft.points[-1]
    return [QueueTask(str(uuid.uuid4()), x, y, path=list(draft.points))]
