"""Orders made into what is to be stored of them, or why they are refused."""

from __future__ import annotations

import dataclasses
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass

from ..command_life.open_command import NOTHING, Order, drafted, recalled, superseded
from ..command_life.open_commands import OpenCommands
from ..errors import RefusedError
from ..messages import Ability, Abort, Command
from ..robots import Robots
from .reader import CommandReader
from .writing import Draft

_NEEDED: dict[str, Ability] = {"SetPosEnd": "targets", "SetPath": "paths", "SetPosIni": "start"}
"""What a robot has to be able to do for each message."""


@dataclass(frozen=True)
class Rules:
    """Whether a message may be sent to a robot now.

    ``check`` raises RefusedError where it must not; ``consider`` is awaited before, for what of that takes
    long. ``fence`` tells of orders that are fenced why each must not be sent, None where it may.
    """

    check: Callable[[Command], None]
    consider: Callable[[Command], Awaitable[None]]
    fence: Callable[[Sequence[Order]], Awaitable[Sequence[RefusedError | None]]]


class Drafting(CommandReader):
    """Holds orders against the rules and what their robots are doing, and says what they end."""

    def __init__(self, open_commands: OpenCommands, robots: Robots, rules: Rules) -> None:
        super().__init__(open_commands)
        self._robots = robots
        self._rules = rules
        self.waits: Callable[[str], bool] = lambda _robot: False
        """Tells whether a robot waits for another: that ends with whatever else it is told."""

    async def consider(self, orders: Sequence[Order]) -> list[RefusedError | None]:
        """Find out what takes long about orders; return why each must not be sent, None where it may be."""
        for order in orders:
            await self._rules.consider(order.message)
        refusals = iter(await self._rules.fence([order for order in orders if order.fenced]))
        return [next(refusals) if order.fenced else None for order in orders]

    def draft(self, order: Order, refusal: RefusedError | None, now: float) -> Draft:
        """Return the draft of an order, refused by ``refusal`` or by what holds now."""
        try:
            self._rules.check(order.message)
            self._check_ability(order)
            self._check_task(order)
        except RefusedError as error:
            refusal = refusal or error
        mine = self._open.of(order.robot)
        command = dataclasses.replace(drafted(order, now), handed=self._robots.pose(order.robot))
        ended, recalls = superseded(order, mine, now), recalled(order, mine, now)
        return Draft(order, command, ended, recalls, refusal, self.waits(order.robot))

    async def consider_way(self, way: Command) -> None:
        """Find out what takes long about a way that a robot is to be told."""
        await self._rules.consider(way)

    def check_way(self, robot: str, task: str, way: Command) -> None:
        """Raise RefusedError where a robot must not be told the ``way`` to its ``task``, or has another."""
        self._rules.check(way)
        if not self.is_carrying_out(robot, task):
            raise _told_otherwise(robot)

    def _check_task(self, order: Order) -> None:
        if order.instead_of is not None and not self._is_open_to(order.robot, order.instead_of):
            raise _told_otherwise(order.robot)
        if order.aborts is not None and order.aborts != self.busy_with(order.robot):
            raise RefusedError(
                f"command {order.aborts} is no longer what robot {order.robot!r} is doing; look at the log, "
                "and abort the robot if it is to stop all the same"
            )

    def _check_ability(self, order: Order) -> None:
        """Raise RefusedError for what the robot said in Ready that it cannot do."""
        name, message = order.robot, order.message
        if name not in self._robots or isinstance(message, Abort):
            return
        robot = self._robots.get(name)
        if self._robots.is_only_seen(name):
            raise RefusedError(f"robot {name!r} is only seen: its link {robot.link} takes no commands for it")
        needed = _NEEDED[type(message).__name__]
        if not robot.can(needed):
            raise RefusedError(
                f"robot {name!r} does not take {type(message).__name__}, only what it said in Ready: "
                f"{robot.abilities}"
            )
        if (getattr(message, "cone", None) or getattr(message, "collect", None)) and not robot.can("cones"):
            raise RefusedError(f"robot {name!r} places and collects no cones; send it there without one")

    def _is_open_to(self, robot: str, task: str) -> bool:
        if task == NOTHING:
            return not any(c.is_motion or c.is_abort for c in self._open.of(robot))
        return self.is_carrying_out(robot, task)


def _told_otherwise(robot: str) -> RefusedError:
    return RefusedError(f"robot {robot!r} has been told otherwise in the meantime")
