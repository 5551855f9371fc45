"""Queues of robots as tests of them meet them: tasks at four places, an operator, robots that obey."""

from __future__ import annotations

from robot_bridge.core.messages.queues import GetQueue, QueueTask, ResumeQueue, SetQueue, TaskKind
from robot_bridge.core.messages.records import GetPlacements
from robot_bridge.gateway.storage.repositories import records

PLACES = {"a": (50.0, 40.0), "b": (60.0, 40.0), "c": (60.0, 50.0), "d": (70.0, 50.0)}


def task(id, kind="drive", **more):
    x, y = PLACES[id[0]]
    return QueueTask(f"task-{id:0>4}", x, y, kind=TaskKind(kind), **more)


class Line:
    """The queues of a yard, as an operator and a robot meet them."""

    def __init__(self, yard):
        self.yard = yard
        self.pushed = []
        yard.fleet.listeners.add(self)

    def notify(self, method, key, params):
        if method == "queue":
            self.pushed.append(params)

    @property
    def queues(self):
        return self.yard.fleet.queues

    async def advance(self):
        """Let the gateway do what is due."""
        self.yard.fleet.driving.schedule_all()
        for _ in range(4):
            await self.yard.fleet.driving.advance()

    async def set(self, *tasks, robot="r1", revision=None):
        revision = (await self.report(robot)).revision if revision is None else revision
        report = await self.queues.set(SetQueue(robot, revision, list(tasks)), "Ada")
        await self.advance()
        return report

    async def report(self, robot="r1", **how):
        (report,) = (await self.queues.read(GetQueue(robot, **how))).queues
        return report

    async def states(self, robot="r1"):
        report = await self.report(robot)
        return {one.task[-1]: one.state.value for one in [*report.tasks, *report.ended]}

    async def resume(self, robot="r1"):
        await self.queues.resume(ResumeQueue(robot, (await self.report(robot)).revision), "Ada")
        await self.advance()

    async def reach(self, x, y, robot="r1"):
        """Let the robot take on what waits for it, and stand at (x, y)."""
        ops = await self.yard.acknowledge_all(robot)
        await self.yard.at(x, y, robot=robot)
        await self.advance()
        return ops

    async def sent(self, robot="r1"):
        """Return where robot's commands were to go, oldest first."""
        found = [c for c in await self.yard._stored() if c.robot == robot]
        return [(c.params["x"], c.params["y"]) if "x" in c.params else c.op for c in found]


LANE = [(20.0, 40.0), (40.0, 41.0), (50.0, 40.0)]


async def drive(line, path, end, robot="r1"):
    """Let the robot take its path on, drive along it and stand at its end."""
    ops = await line.yard.acknowledge_all(robot)
    for x, y in path:
        await line.yard.at(x, y, v=1.0, robot=robot)
    await line.yard.at(*end, robot=robot)
    await line.advance()
    return ops


async def place(line, robot="r1", id="a", at=(50.0, 40.1), **more):
    await line.set(task(id, "place", **more), robot=robot)
    await line.reach(*at, robot=robot)


async def placed(line, **which):
    return await line.yard.database.run(records.newest_placed_cones, GetPlacements(**which))
