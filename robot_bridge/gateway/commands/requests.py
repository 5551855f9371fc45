"""Operators' orders to robots: decoded, checked against robot and site, and issued as commands."""

from __future__ import annotations

import asyncio
import logging
import uuid
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from types import NoneType
from typing import Any, TypeVar

from sqlalchemy import Connection

from ...core.errors import (
    STORED_LATER,
    DataRefusedError,
    RefusedError,
    StoreError,
    UncertainError,
    listed_names,
    unstored_abort,
    with_abort_sent,
)
from ...core.logs import log_and_continue, log_unforeseen
from ...core.messages.base import MessageError, check_crs, to_json
from ...core.messages.commands import (
    AbortAll,
    AbortTask,
    CommandReport,
    Commands,
    GetCommands,
    Send,
    SetPositions,
)
from ...core.messages.robots import COMMANDS, Abort, SetPath
from ...protocol.codec import decode_command
from ..model.events import handles
from ..model.robots import Robots
from ..site.places import ServedSite, check_places, command_in_site_frame, places_of, targets_in_site_frame
from ..storage.database import Database, start_task
from ..storage.repositories import commands
from ..storage.repositories.requests import ORDERS
from . import persistence
from .active_command import CommandOrder
from .service import CommandService

log = logging.getLogger(__name__)

T = TypeVar("T")

STORED_WITHIN = 1.0
"""seconds after which an Abort that is not stored yet is sent over open connections as well, and written
alone for robots that read the database: its command needs tables that somebody may have locked."""
NOTED_WITHIN = 0.5
"""seconds that an answer waits for the note of what is not stored."""


class CommandRequests:
    """Handles operators' orders. Each method returns when its commands are stored.

    All raise RefusedError for an order that cannot be done, MessageError for an invalid one, StoreError when
    it cannot be stored.
    """

    def __init__(
        self, site: ServedSite, robots: Robots, commands: CommandService, database: Database
    ) -> None:
        self._site = site
        self._robots = robots
        self._commands = commands
        self._database = database
        self._links: list[Callable[[str, str], bool]] = []

    def reach(self, link: Callable[[str, str], bool]) -> None:
        """Call ``link`` with a robot and the id of a call when an Abort cannot be stored.

        It sends the Abort over the robot's open connection, and returns whether there is one.
        """
        self._links.append(link)

    @handles(Send)
    async def send(self, send: Send, operator: str) -> CommandReport:
        """Issue one command; a repeated request returns its state, even if it would be refused by now."""
        with self._commands.drafting.asking(send) as asked:
            return await self._send(send, operator, asked)

    async def _send(self, send: Send, operator: str, asked: float) -> CommandReport:
        try:
            order = await self._order(send.command, send.robot, send.op, send.params, operator)
        except RefusedError as refusal:
            return await self._issued_before(send.command, send.robot, send.op, refusal)
        remarks = [f"override: {send.override}" if send.override else None, send.reason]
        reason = "; ".join(text for text in remarks if text) or None
        fenced = send.override is None
        order = replace(order, reason=reason, expires_in=send.expires_in, fenced=fenced, asked=asked)
        issue = self._issue_aborts if isinstance(order.message, Abort) else self._commands.issue
        return (await issue([order]))[0]

    @handles(SetPositions)
    async def set_positions(self, request: SetPositions, operator: str) -> Commands:
        """Issue a target for each robot, all of them or none."""
        with self._commands.drafting.asking(request) as asked:
            return await self._set_positions(request, operator, asked)

    async def _set_positions(self, request: SetPositions, operator: str, asked: float) -> Commands:
        positions = request.positions
        request.check_named_once()
        for position in positions:
            self._robots.check_known(position.robot)
        orders = []
        for position in await targets_in_site_frame(self._site, positions):
            target = {name: value for name, value in to_json(position).items() if name != "robot"}
            order = await self._order(str(uuid.uuid4()), position.robot, "SetPosEnd", target, operator)
            orders.append(replace(order, fenced=True, asked=asked))
        return Commands(await self._commands.issue(orders))

    @handles(AbortTask)
    async def abort(self, request: AbortTask, operator: str) -> CommandReport:
        """Send a robot an Abort of its task, or of one command if that still is its task."""
        try:
            order = await self._order(request.command, self._robot_of(request), Abort.__name__, {}, operator)
        except RefusedError as refusal:
            return await self._issued_before(request.command, request.robot, Abort.__name__, refusal)
        order = replace(order, reason=request.reason, aborts=request.aborts)
        return (await self._issue_aborts([order]))[0]

    @handles(AbortAll)
    async def abort_all(self, request: AbortAll, operator: str) -> Commands:
        """Send every robot an Abort; repeated with the same ``command`` id it changes nothing."""
        command = request.command or str(uuid.uuid4())
        ids = {name: uuid.uuid5(uuid.NAMESPACE_OID, f"{command} {name}") for name in self._robots.commanded()}
        orders = [CommandOrder(str(id), name, Abort(), operator, request.reason) for name, id in ids.items()]
        return Commands(await self._issue_aborts(orders))

    @handles(GetCommands)
    async def newest(self, request: GetCommands) -> Commands:
        """Return the newest commands first, of one robot or of all."""
        return Commands(await self._database.run(commands.newest, request.robot, request.limit))

    async def _issue_aborts(self, orders: list[CommandOrder]) -> list[CommandReport]:
        """Store Aborts; those that are not stored within a second are sent by themselves as well."""
        return await self.send_if_unstored(orders, start_task(self._commands.issue(orders)))

    async def send_if_unstored(
        self, orders: list[CommandOrder], storing: asyncio.Task[T], *, is_pause: bool = False
    ) -> T:
        """Return the result of ``storing``: of Aborts, or with ``is_pause`` of the pause of a robot.

        An Abort is noted before it is sent, a pause becomes one when it has failed.

        :raises StoreError, RefusedError, MessageError: with the robots that an Abort was sent to. Errors of
            ``storing`` that nobody foresaw are logged, and raised as StoreError.
        """
        await asyncio.wait({storing}, timeout=STORED_WITHIN)
        sent: list[str] = []
        if not storing.done() or not isinstance(storing.exception(), (NoneType, RefusedError, MessageError)):
            noting = None if is_pause else self._commands.keep_aborts(orders)
            sent = [order.robot for order in orders if self._send_unstored(order)]
            sent += await self._write_unstored(orders, storing)
            await _wait_for_note(noting)
        try:
            result = await storing
        except (RefusedError, MessageError) as error:
            self._commands.release_aborts(orders)
            if not sent:
                raise
            log.warning("%s: sent an Abort for what was refused then", listed_names(sent))
            refused = MessageError if isinstance(error, MessageError) else RefusedError
            raise refused(with_abort_sent(error, sent)) from error
        except Exception as error:
            text = error if isinstance(error, StoreError) else log_unforeseen(log, "storing an Abort")
            is_refused = isinstance(error, DataRefusedError)
            if is_refused:
                self._commands.release_aborts(orders)
            elif is_pause:
                await _wait_for_note(self._commands.keep_aborts(orders))
            what = _sent_in_words(sent, is_pause=is_pause, is_lasting=not is_refused)
            kind = UncertainError if is_pause and isinstance(error, UncertainError) else StoreError
            raise kind(f"{text}. {what}") from error
        self._commands.release_aborts(orders)
        return result

    def _send_unstored(self, order: CommandOrder) -> bool:
        is_sent = False
        for link in self._links:
            with log_and_continue(log, f"sending robot {order.robot!r} an Abort that is not stored"):
                is_sent |= link(order.robot, f"abort-{order.command}")
        return is_sent

    async def _write_unstored(self, orders: list[CommandOrder], storing: asyncio.Task[Any]) -> list[str]:
        """Write Aborts without their commands for robots on SQL; return those for which that was done.

        Once ``storing`` has succeeded nothing is written: it would withdraw what was asked for since.
        """

        def write(connection: Connection, robots: Sequence[str], withdrawn: Sequence[str]) -> None:
            if not (storing.done() and not storing.cancelled() and storing.exception() is None):
                persistence.write_bare_aborts(connection, robots, withdrawn, emergency=False)

        # Some may have been removed meanwhile, or are another gateway's.
        on_sql = set(self._robots.readers())
        readers = [order for order in orders if order.robot in on_sql]
        done: list[str] = []
        for withdrawn in ((), ORDERS):
            # One that aborts a single command withdraws no other.
            robots = [order.robot for order in readers if (order.aborts is None) == bool(withdrawn)]
            try:
                if robots:
                    # What keeps the commands from being stored may keep the other connection waiting.
                    await self._database.run_aside(write, robots, withdrawn)
                    done += robots
            except StoreError as error:
                log.error("Aborts of %s cannot be written: %s", listed_names(robots), error)
            except Exception:
                # What nobody foresaw of one robot ends this for none: those kept are stored one by one.
                log.exception("Aborts of %s cannot be written", listed_names(robots))
        return done

    async def _issued_before(
        self, command: str, robot: str | None, op: str, refusal: RefusedError
    ) -> CommandReport:
        """Return the present state of a command if it was issued before; raises ``refusal`` otherwise.

        A client without an answer repeats its request, when site, robots or task may have changed.
        """
        known = await self._database.run(commands.find, command)
        if known is None or known.op != op or robot not in (None, known.robot):
            raise refusal
        return known

    def _robot_of(self, request: AbortTask) -> str:
        robot = request.robot or self._commands.robot_of(request.aborts or "")
        if robot is None:
            raise RefusedError(
                f"command {request.aborts} has ended or was never issued, so there is nothing to abort"
            )
        return robot

    async def _order(
        self, id: str, robot: str, op: str, params: dict[str, object], operator: str
    ) -> CommandOrder:
        self._robots.check_known(robot)
        if op not in COMMANDS:
            raise MessageError(f"op {op!r} cannot be sent to a robot; choose one of {', '.join(COMMANDS)}")
        crs = params.get("crs")
        if not (crs is None or isinstance(crs, str)):
            raise MessageError(f"{op}: crs is {crs!r:.40}; give a code such as 'EPSG:4326', or none")
        check_crs(crs)
        message = decode_command(op, {name: value for name, value in params.items() if name != "crs"})
        if isinstance(message, Abort) and message.emergency:
            raise MessageError("Abort: emergency is for every robot; ask for emergency_stop")
        message = await command_in_site_frame(self._site, message, crs)
        if isinstance(message, SetPath) and (message.cone or message.collect):
            self._check_cone(robot)
        check_places(self._site, places_of(message))
        return CommandOrder(id, robot, message, operator)

    def _check_cone(self, robot: str) -> None:
        """Raise RefusedError for a robot that would drive a path and ignore the cone at its end."""
        if not self._robots.get(robot).places_on_paths:
            raise RefusedError(
                f"SetPath: robot {robot!r} has not declared in Ready that it takes cones with a path "
                "(path_cones), so it would not do what is to be done at the end: take it for a SetPosEnd, or "
                "give it a task with a path"
            )


async def _wait_for_note(writing: Future[bool] | None) -> None:
    """Wait until Aborts are noted, but not long: a disk that hangs must not keep back the answer."""
    if writing is not None:
        await asyncio.wait({asyncio.wrap_future(writing)}, timeout=NOTED_WITHIN)


def _sent_in_words(sent: Sequence[str], *, is_pause: bool, is_lasting: bool) -> str:
    recipients = f"sent to {listed_names(sent)} all the same" if sent else "sent to no robot"
    later = f"; {STORED_LATER}" if is_lasting else ""
    return f"{unstored_abort(recipients, is_pause=is_pause)}{later}"
