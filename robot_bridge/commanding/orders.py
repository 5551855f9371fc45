"""What operators order robots to do: understood, checked against robot and site, and put into the book."""

from __future__ import annotations

import uuid
from dataclasses import replace

from ..errors import RefusedError
from ..messages import (
    COMMANDS,
    Abort,
    AbortTask,
    Command,
    CommandReport,
    MessageError,
    Send,
    TargetPosition,
    to_json,
)
from ..places import check_places, places_of
from ..robots import Robots
from ..served_site import ServedSite
from ..store import commands
from ..store.database import Database
from ..wire import decode_answer
from .book import CommandBook, Order


class Orders:
    """Takes operators' orders. Each method returns when what it ordered is stored.

    All raise RefusedError for what cannot be done, MessageError for what cannot be understood, StoreError
    when it cannot be stored.
    """

    def __init__(self, site: ServedSite, robots: Robots, book: CommandBook, database: Database) -> None:
        self._site = site
        self._robots = robots
        self._book = book
        self._database = database

    async def send(self, send: Send, operator: str) -> CommandReport:
        """Issue one command; asked again it is answered as it stands, whatever would be refused by now."""
        try:
            order = self._order(send.command, send.robot, send.op, send.params, operator)
        except RefusedError as refusal:
            return await self._issued_before(send.command, refusal)
        told = [f"override: {send.override}" if send.override else None, send.reason]
        reason = "; ".join(text for text in told if text) or None
        fenced = send.override is None
        order = replace(order, reason=reason, expires_in=send.expires_in, fenced=fenced)
        return (await self._book.issue([order]))[0]

    async def set_positions(self, positions: list[TargetPosition], operator: str) -> list[CommandReport]:
        """Issue a target for each robot, all of them or none."""
        names = [position.robot for position in positions]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise RefusedError(
                f"positions: {', '.join(twice)} is named more than once; give each robot one target"
            )
        orders = []
        for position in positions:
            target = {name: value for name, value in to_json(position).items() if name != "robot"}
            order = self._order(str(uuid.uuid4()), position.robot, "SetPosEnd", target, operator)
            orders.append(replace(order, fenced=True))
        return await self._book.issue(orders)

    async def abort(self, request: AbortTask, operator: str) -> CommandReport:
        """Tell a robot to abort its task, or to abort one command if that still is its task."""
        try:
            order = self._order(request.command, self._robot_of(request), Abort.__name__, {}, operator)
        except RefusedError as refusal:
            return await self._issued_before(request.command, refusal)
        order = replace(order, reason=request.reason, aborts=request.aborts)
        return (await self._book.issue([order]))[0]

    async def abort_all(
        self, operator: str, command: str | None = None, reason: str | None = None
    ) -> list[CommandReport]:
        """Tell every robot to abort its task; asked again with the same ``command`` id it changes nothing."""
        command = command or str(uuid.uuid4())
        ids = {name: uuid.uuid5(uuid.NAMESPACE_OID, f"{command} {name}") for name in self._robots.names()}
        return await self._book.issue(
            [Order(str(id), name, Abort(), operator, reason) for name, id in ids.items()]
        )

    async def _issued_before(self, command: str, refusal: RefusedError) -> CommandReport:
        """Return a command as it stands if it was issued before; raises ``refusal`` otherwise.

        Whoever got no answer asks again, and the site, the robots or the task may be others by now.
        """
        known = await self._database.run(commands.find, command)
        if known is None:
            raise refusal
        return known

    def _robot_of(self, request: AbortTask) -> str:
        robot = request.robot or self._book.robot_of(request.aborts or "")
        if robot is None:
            raise RefusedError(
                f"command {request.aborts} has ended or was never issued, so there is nothing to abort"
            )
        return robot

    def _order(self, id: str, robot: str, op: str, params: dict[str, object], operator: str) -> Order:
        self._robots.check_known(robot)
        if op not in COMMANDS:
            raise MessageError(f"op {op!r} cannot be sent to a robot; choose one of {', '.join(COMMANDS)}")
        message = decode_answer(op, params)
        assert isinstance(message, Command)
        if isinstance(message, Abort) and message.emergency:
            raise MessageError("Abort: emergency is for every robot; ask for emergency_stop")
        check_places(self._site, places_of(message))
        return Order(id, robot, message, operator)
