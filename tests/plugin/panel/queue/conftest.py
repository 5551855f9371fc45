"""The small gateway, with queues that change by the rules of the real one."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.robot_bridge.core.errors import RefusedError
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.queues import QueueTask, TaskKind
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from fleet_supervisor.robot_bridge.gateway.model import task_queue
from fleet_supervisor.robot_bridge.gateway.model.task_queue import Queue, queue_report
from fleet_supervisor.robot_bridge.gateway.queues import task_life
from fleet_supervisor.robot_bridge.protocol.jsonrpc import OUTDATED, REFUSED


class SmallQueues:
    """Keeps queues in memory and sends nothing to anybody."""

    def __init__(self, gateway):
        self._gateway = gateway
        self._queues: dict[str, Queue] = {}
        self.quiet = False
        """Whether what others change is told to nobody, as before it has arrived."""
        gateway.answers.update(
            {
                "get_queue": self._all,
                "pause_queue": self._pause,
                "pause_robot": self._halt,
                "add_tasks": self._edit(self._added),
                "move_task": self._edit(lambda q, p: task_queue.move_task(q, p["task"], p.get("before"))),
                "remove_task": self._edit(lambda q, p: task_queue.remove_task(q, p["task"])),
                "make_current": self._edit(lambda q, p: task_queue.move_task_first(q, p["task"])),
                "resume_queue": self._edit(lambda q, p: task_queue.resume_queue(q, "anna", time.time())),
            }
        )

    def get(self, robot: str) -> Queue:
        return self._queues.get(robot, Queue(robot))

    def give(self, robot: str, tasks: list[QueueTask], by: str = "anna") -> None:
        """Add tasks as another desk would."""
        self._put(task_queue.add_tasks(self.get(robot), tasks, None, {}, by, time.time()))

    def fail(self, robot: str, why: str) -> None:
        """Let the robot refuse what it does."""
        self._put(task_life.mark_failed(self.get(robot), why, time.time(), skips=False).queue)

    def lose(self, robot: str) -> None:
        """Tell that a robot is not heard any more."""
        self._gateway.tell("queue", to_json(queue_report(self.get(robot), RobotState.LOST)))

    def _put(self, queue: Queue) -> None:
        queue = self._begun(queue)
        if not self.quiet:
            self._gateway.tell("queue", _report(queue))

    def _begun(self, queue: Queue) -> Queue:
        """Keep a queue; one that runs begins with its first task."""
        if queue.running and queue.tasks and queue.current is None:
            queue = task_life.mark_sent(queue, time.time())
        self._queues[queue.robot] = queue
        return queue

    def _all(self, params: dict) -> dict:
        return {"result": {"queues": [_report(queue) for queue in self._queues.values()]}}

    def _pause(self, params: dict) -> dict:
        queue = self.get(params["robot"]).paused("paused by anna", "anna", time.time())
        return {"result": _report(self._begun(queue))}

    def _halt(self, params: dict) -> dict:
        """As the real one where nothing was sent beside the queue."""
        queue = self.get(params["robot"])
        halted = task_life.pause_with_task(queue, [], "paused by anna", "anna", time.time())
        return {"result": _report(self._begun(halted))}

    def _added(self, queue: Queue, params: dict) -> Queue:
        tasks = [QueueTask(**{**task, "kind": TaskKind(task["kind"])}) for task in params["tasks"]]
        return task_queue.add_tasks(queue, tasks, params.get("before"), {}, "anna", time.time())

    def _edit(self, edit):
        def answer(params: dict) -> dict:
            queue = self.get(params["robot"])
            if params["revision"] != queue.revision:
                text = f"the queue is at revision {queue.revision}, not {params['revision']}"
                return {"error": {"code": OUTDATED, "message": text, "data": _report(queue)}}
            try:
                return {"result": _report(self._begun(edit(queue, params)))}
            except RefusedError as error:
                return {"error": {"code": REFUSED, "message": str(error)}}

        return answer


def _report(queue: Queue) -> dict:
    return to_json(queue_report(queue, RobotState.FRESH))


@pytest.fixture
def gateway(gateway):
    gateway.queues = SmallQueues(gateway)
    return gateway
