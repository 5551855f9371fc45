"""Client of the gateway's ``/link``: the robots that it speaks for; no message is executed twice."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from typing import Any

import msgspec

from ...core.clock import LONGEST_PAUSE_S
from ...core.logs import log_and_continue
from ...core.messages.administration import SiteReport, site_report
from ...core.messages.base import MessageError, check_robot_name, to_json
from ...core.messages.links import (
    LINK_PROTOCOL,
    GetAreas,
    LinkHello,
    LinkStatus,
    Playback,
    Released,
    SiteAreas,
)
from ...core.messages.robots import Abort, Alive, OpAck, Ready, Request, SendGPS, SendPos, Start, Stopped
from ...core.messages.safety import Ability
from ...core.sites.frame import SiteFrame
from ...protocol import jsonrpc
from ...protocol.codec import decode_answer, params_of
from .adapter import Adapter, summary
from .errors import CommandRefusedError, FrameChangedError
from .frames import LinkFrame
from .link_websocket import LinkWebSocket
from .linked_robots import Commanding, Kept, LinkedRobot, frame_of, gps_call
from .memory import LinkMemory
from .settings import LinkSettings

log = logging.getLogger(__name__)

SAY_AGAIN = 1.0
"""seconds until a message that the gateway could not store is sent again."""
MEMORY_EVERY = 2.0
"""seconds between attempts to write what a full disk refused."""


class LinkClient:
    """The robots that an adapter speaks for at the gateway: its :class:`.adapter.Link`.

    Of messages received while this program stood still for ``longest_pause_s`` seconds only an Abort is
    executed: see :class:`.link_websocket.LinkWebSocket`.
    """

    def __init__(
        self,
        settings: LinkSettings,
        adapter: Adapter,
        memory: LinkMemory,
        longest_pause_s: float = LONGEST_PAUSE_S,
    ) -> None:
        self.name = settings.name
        self._settings = settings
        self._adapter = adapter
        self._memory = memory
        self._connection = LinkWebSocket(settings, longest_pause_s)
        self._robots: dict[str, LinkedRobot] = {}
        self._commanding = self._new_commanding()
        self._calming: dict[str, asyncio.Task[None]] = {}
        """Tasks that stop robots adrift."""
        self._is_welcome = False
        self._status = LinkStatus(ok=True)
        self._reported_fault: str | None = None
        self._refused: dict[str, str] = {}
        """Why the gateway refuses robots, such as one whose name another link speaks for."""
        self._site: SiteReport | None = None
        self._frame: LinkFrame | None = None
        self._is_known = asyncio.Event()
        self._areas: dict[asyncio.Future[SiteAreas], tuple[float, float, float, float]] = {}
        """Requests for areas of the site without an answer yet."""
        self.largest_image_bytes = 0

    # --- information for the adapter ---

    @property
    def settings(self) -> LinkSettings:
        """The settings that every link has."""
        return self._settings

    @property
    def site(self) -> SiteReport:
        """The site: its bounds, CRS, origin and rotation."""
        assert self._site is not None, "known once site_known has returned"
        return self._site

    @property
    def frame(self) -> LinkFrame:
        """The frame of the link's robots on this site."""
        assert self._frame is not None, "known once site_known has returned"
        return self._frame

    @property
    def is_connected(self) -> bool:
        """Whether the gateway has admitted this link."""
        return self._is_welcome

    @property
    def robots(self) -> list[str]:
        """The robots that it speaks for."""
        return list(self._robots)

    async def site_known(self) -> None:
        """Wait until the gateway has sent its site."""
        await self._is_known.wait()

    # --- reports on robots ----------------------------------------------------------------------------

    def add(self, robot: str, abilities: Sequence[Ability] = (), *, path_cones: bool = False) -> None:
        """Speak for ``robot`` from now on; send Ready again for one whose abilities changed."""
        known = self._robots.get(robot)
        if known is not None:
            if known.change(tuple(abilities), path_cones) and self._is_welcome:
                known.lose()
                self._send_ready(known)
            return
        check_robot_name(robot)
        self._robots[robot] = known = LinkedRobot(robot, tuple(abilities), path_cones)
        self._memory.magic(robot)
        if self._is_welcome:
            self._send_ready(known)

    def remove(self, robot: str) -> None:
        """Stop speaking for ``robot``."""
        known = self._robots.pop(robot, None)
        self._record_refusal(robot, None)
        if known is not None:
            self._commanding.drop(robot)
            for kept in known.kept:
                kept.answer.cancel()

    def restarted(self, robot: str) -> None:
        """Record that the robot has restarted: open messages are sent again."""
        known = self._robots[robot]
        self._memory.renew(robot)
        self._commanding.drop(robot)
        if self._is_welcome:
            known.lose()
            self._send_ready(known)

    def adrift(self, robot: str) -> None:
        """Record that ``robot`` may execute a task not requested under this name: it is stopped first."""
        self._memory.set_adrift(robot)
        known = self._robots.get(robot)
        if known is not None and self._is_welcome:
            known.lose()
            self._send_ready(known)

    def position(self, robot: str, position: SendPos | SendGPS) -> None:
        """Report the position of ``robot``."""
        known = self._robots[robot]
        known.place(position)
        self._connection.write_soon()

    def alive(self, robot: str) -> None:
        """Report that ``robot`` is alive."""
        self._robots[robot].is_alive = True
        self._connection.write_soon()

    def stopped(self, robot: str) -> None:
        """Report that ``robot`` stands and is idle."""
        self._keep(robot, Stopped())

    def give_up(self, robot: str, command: int, reason: str) -> None:
        """Report that ``robot`` gave up an accepted command."""
        if not self._memory.has_begun(robot, command):
            # From another database, in which this id is another command's.
            log.warning(
                "robot %s gave up message %d, which is none of this gateway: %s", robot, command, reason
            )
            return
        self._keep(robot, OpAck(id=command, ok=False, reason=reason))

    async def ask(self, robot: str, request: Request) -> OpAck:
        """Send an acknowledged request; return the acknowledgement."""
        return await self._keep(robot, request)

    async def areas(self, box: tuple[float, float, float, float]) -> SiteAreas:
        """Request the site's keepouts and roads in a box."""
        answer: asyncio.Future[SiteAreas] = asyncio.get_running_loop().create_future()
        self._areas[answer] = box
        if self._is_welcome:
            self._ask_areas(answer)
        try:
            return await answer
        finally:
            del self._areas[answer]

    def report(
        self,
        *,
        ok: bool,
        text: str | None = None,
        counts: dict[str, float] | None = None,
        reached: bool = False,
    ) -> None:
        """Report the state of the link's own side."""
        status = LinkStatus(ok, text, counts or {}, None if ok else reached or None)
        if status != self._status:
            self._status = status
            if self._is_welcome:
                self._send_status()

    # --- the connection -------------------------------------------------------------------------------------

    async def run(self) -> None:
        """Carry messages until cancelled; raises LinkError for faults that a person must put right."""
        watching = asyncio.create_task(self._watch_memory())
        try:
            await self._connection.run(self)
        finally:
            watching.cancel()

    def lose(self) -> None:
        """Handle a lost connection: no robot is admitted until the next one."""
        self._is_welcome = False
        self._refused.clear()
        for robot in self._robots.values():
            robot.lose()

    def pass_over(self, seconds: float) -> None:
        """Drop commands not begun: this program stood still for so many ``seconds``."""
        for name in self._robots:
            self._commanding.drop(name, f"the link stood still for {seconds:.0f} s before it was begun")

    def news(self) -> list[str | bytes]:
        """Return the frames with new positions of robots."""
        if not self._is_welcome:
            return []
        frames: list[str | bytes] = []
        placed, fresh = [], [robot for robot in self._robots.values() if robot.admitted and robot.fresh]
        for robot in fresh:
            robot.fresh = robot.is_alive = False
            if isinstance(robot.position, SendPos):
                placed.append((robot.name, robot.position))
            elif robot.position is not None:
                frames.append(gps_call(robot.name, robot.position))
        if placed:
            frames.append(frame_of(placed))
        for robot in self._robots.values():
            if robot.admitted and robot.is_alive:
                robot.is_alive = False
                frames.append(jsonrpc.call(Alive.__name__, {"robot": robot.name}))
        return frames

    # --- incoming messages ---

    def handle(self, call: jsonrpc.Call) -> None:
        """Process a call of the gateway; raises LinkError and MessageError."""
        params = dict(call.params) if isinstance(call.params, dict) else {}
        robot = params.pop("robot", None)
        # In Start, and in a notification when they have changed.
        self._connection.addresses.learn(params.get("gateways"))
        if call.method == Start.__name__:
            hello = to_json(LinkHello(LINK_PROTOCOL, self._adapter.kind))
            self._connection.call(LinkHello.method, hello, self._welcomed)
        elif call.method == Playback.method:
            self._connection.post(self._played(call.id, params))
        elif call.method == Released.__name__:
            self._released(str(robot), str(params.get("reason")))
        elif call.method == Abort.__name__ and robot is None:
            for name, known in list(self._robots.items()):
                if not known.is_only_seen:
                    # An error with one robot must not keep the stop from others.
                    with log_and_continue(log, f"stopping robot {name!r}"):
                        self._stop(name, f"{name}/{params.get('call')}", emergency=True)
            with log_and_continue(log, "stopping robots that the gateway does not know yet"):
                self._adapter.stop_unannounced()
        elif robot in self._robots:
            self._receive_answer(robot, call, params)
        elif call.id is not None:
            text = f"this link does not speak for robot {robot!r}"
            self._connection.post(jsonrpc.error(call.id, jsonrpc.REFUSED, text))

    def _played(self, id: int | str | None, params: dict[str, Any]) -> str:
        """Return the reply to a change of playback by the gateway."""
        try:
            return jsonrpc.result(id, to_json(self._adapter.playback(msgspec.convert(params, Playback))))
        except (msgspec.ValidationError, MessageError, CommandRefusedError) as error:
            return jsonrpc.error(id, jsonrpc.REFUSED, str(error))

    def _receive_answer(self, robot: str, call: jsonrpc.Call, params: dict[str, Any]) -> None:
        try:
            answer = decode_answer(call.method, params)
        except MessageError as error:
            # From a newer gateway, which would repeat it for ever unless refused.
            log.error("robot %s: the gateway said what this link does not know: %s", robot, error)
            if call.id is not None:
                text = f"this link does not know it: {error}"
                self._connection.post(jsonrpc.error(call.id, jsonrpc.REFUSED, text))
            return
        if isinstance(answer, Abort):
            self._stop(robot, call.id, emergency=answer.emergency)
        else:
            self._commanding.enqueue(robot, call.id, answer)

    def _stop(self, robot: str, call: int | str | None, *, emergency: bool) -> None:
        if self._robots[robot].is_only_seen:
            self._connection.post(jsonrpc.result(call, to_json(OpAck())), urgent=True)
        else:
            self._commanding.stop(robot, call, emergency=emergency)

    def _welcomed(self, reply: jsonrpc.Reply) -> None:
        if reply.error is not None or not isinstance(reply.result, dict):
            log.error("the gateway does not take this link: %s", reply.error)
            return
        site = site_report(reply.result["site"])
        self._use_site(site, str(reply.result["database"]))
        self.largest_image_bytes = int(reply.result.get("largest_image_bytes", 0))
        self._site = site
        self._is_welcome = True
        self._connection.addresses.answered()
        self._is_known.set()
        self._send_status()
        for robot in list(self._robots.values()):
            self._send_ready(robot)
        for answer in self._areas:
            self._ask_areas(answer)

    def _use_site(self, site: SiteReport, database: str) -> None:
        """Use a site and a database; raises FrameChangedError if the site's frame is another one."""
        frame = SiteFrame(site.crs, site.origin, site.rotation)
        before = self._site
        if before is None:
            self._frame = LinkFrame(self._settings.frame, frame, str(self._settings.file))
            if self._frame.fit is not None:
                log.warning("%s", self._frame.fit.text)
        elif (before.crs, before.origin, before.rotation) != (site.crs, site.origin, site.rotation):
            raise FrameChangedError(f"link {self.name} starts again: the site has another frame than before")
        if self._memory.use_database(database, f"{frame} {self._settings.frame}"):
            self._forget()

    def _forget(self) -> None:
        """Drop requests of, and messages for, a gateway on another database: they are not valid here."""
        self._commanding.close()
        self._commanding = self._new_commanding()
        for robot in self._robots.values():
            kept, robot.kept = robot.kept, []
            for one in kept:
                if not one.answer.done():
                    one.answer.set_exception(CommandRefusedError("the gateway has another database by now"))

    def _new_commanding(self) -> Commanding:
        return Commanding(self._adapter, self._memory, self._settings.answer_within_s, self._connection.post)

    def _ask_areas(self, answer: asyncio.Future[SiteAreas]) -> None:
        params = to_json(GetAreas(self._areas[answer]))
        self._connection.call(GetAreas.method, params, lambda reply: _areas_came(answer, reply))

    def _released(self, robot: str, reason: str) -> None:
        known = self._robots.get(robot)
        if known is None:
            return
        log.warning("robot %s: %s", robot, reason)
        known.lose()
        self._adapter.refused(robot, reason)
        self._ready_later(known)

    # --- robots ---------------------------------------------------------------------------------------------

    def _send_status(self) -> None:
        status, self._reported_fault = self._status, self._memory.fault
        if self._reported_fault is not None:
            text = f"{self._reported_fault}; its robots take on nothing, and can be stopped"
            status = LinkStatus(False, "; ".join(filter(None, (text, status.text))), status.counts, True)
        if self._refused:
            text = f"not let in: {summary([f'{robot}: {why}' for robot, why in self._refused.items()])}"
            reached = True if status.ok else status.reached
            status = LinkStatus(False, "; ".join(filter(None, (status.text, text))), status.counts, reached)
        self._connection.post(jsonrpc.call(LinkStatus.method, to_json(status) | {"counts": status.counts}))

    async def _watch_memory(self) -> None:
        while True:
            await asyncio.sleep(MEMORY_EVERY)
            # Nobody awaits this task: after an error the memory would be written no more.
            with log_and_continue(log, "writing the link's memory again"):
                await self._memory.recover()
                if self._is_welcome and self._memory.fault != self._reported_fault:
                    self._send_status()

    def _send_ready(self, robot: LinkedRobot) -> None:
        if not self._is_welcome or self._robots.get(robot.name) is not robot or robot.admitted:
            return
        if self._memory.is_adrift(robot.name) and not robot.is_only_seen:
            if robot.name not in self._calming:
                self._calming[robot.name] = asyncio.create_task(self._calm(robot))
            return
        params = {"robot": robot.name, **to_json(robot.ready(self._memory.magic(robot.name)))}
        self._connection.call(Ready.__name__, params, lambda reply: self._readied(robot, reply))

    async def _calm(self, robot: LinkedRobot) -> None:
        """Stop a robot adrift before any command to it; its open commands have failed."""
        log.warning("robot %s may do what it was asked before all changed: it is stopped", robot.name)
        try:
            refusal = await self._commanding.calm(robot.name)
        finally:
            del self._calming[robot.name]
        self._memory.clear_adrift(robot.name)
        how = "it was stopped" if refusal is None else f"its stop was not confirmed, look after it: {refusal}"
        if robot.name in self._robots:
            for id in self._memory.taken_on(robot.name):
                self.give_up(robot.name, id, f"the link's settings or site have changed: {how}")
        self._send_ready(robot)

    def _readied(self, robot: LinkedRobot, reply: jsonrpc.Reply) -> None:
        ack = reply.result if isinstance(reply.result, dict) else {}
        if reply.error is None and ack.get("ok", True):
            self._connection.addresses.learn(ack.get("gateways"))
            robot.admit()
            self._record_refusal(robot.name, None)
            self._adapter.admitted(robot.name)
            self._connection.write_soon()
            for kept in robot.unsent():
                self._send(robot, kept)
            return
        reason = reply.error or str(ack.get("reason"))
        log.warning("robot %s is not let in: %s", robot.name, reason)
        self._record_refusal(robot.name, reason)
        self._adapter.refused(robot.name, reason)
        self._ready_later(robot)

    def _record_refusal(self, robot: str, reason: str | None) -> None:
        """Report to operators which robots are refused, and why."""
        known = robot in self._refused
        if reason is None or robot not in self._robots:
            self._refused.pop(robot, None)
        else:
            self._refused[robot] = reason
        if self._is_welcome and known != (robot in self._refused):
            self._send_status()

    def _ready_later(self, robot: LinkedRobot) -> None:
        asyncio.get_running_loop().call_later(robot.next_wait(), self._send_ready, robot)

    def _keep(self, robot: str, request: Request) -> asyncio.Future[OpAck]:
        known = self._robots[robot]
        answer: asyncio.Future[OpAck] = asyncio.get_running_loop().create_future()
        # Possibly not awaited: errors are logged anyway.
        answer.add_done_callback(lambda done: done.cancelled() or done.exception())
        kept = Kept(request, answer)
        known.keep(kept)
        if known.admitted:
            self._send(known, kept)
        return answer

    def _send(self, robot: LinkedRobot, kept: Kept) -> None:
        if not robot.admitted or kept not in robot.kept:
            return
        # Its earlier position is sent first.
        if robot.fresh and isinstance(robot.position, SendPos):
            robot.fresh = False
            self._connection.post(jsonrpc.call("SendPos", {"robot": robot.name, **to_json(robot.position)}))
        method, params = type(kept.request).__name__, {"robot": robot.name, **params_of(kept.request)}
        kept.call = self._connection.call(method, params, lambda reply: self._answered(robot, kept, reply))

    def _answered(self, robot: LinkedRobot, kept: Kept, reply: jsonrpc.Reply) -> None:
        if reply.code in (jsonrpc.INTERNAL_ERROR, jsonrpc.TOO_MANY):
            kept.call = None
            asyncio.get_running_loop().call_later(SAY_AGAIN, self._send, robot, kept)
            return
        if kept in robot.kept:
            robot.kept.remove(kept)
        if kept.answer.done():
            return
        if reply.error is not None:
            what = type(kept.request).__name__
            log.warning("robot %s: the gateway refuses %s: %s", robot.name, what, reply.error)
            kept.answer.set_exception(CommandRefusedError(reply.error))
            return
        ack = decode_answer(OpAck.__name__, reply.result)
        ack = ack if isinstance(ack, OpAck) else OpAck()
        self._connection.addresses.learn(ack.gateways)
        kept.answer.set_result(ack)


def _areas_came(answer: asyncio.Future[SiteAreas], reply: jsonrpc.Reply) -> None:
    if answer.done():
        return
    if reply.error is not None:
        answer.set_exception(CommandRefusedError(reply.error))
        return
    try:
        answer.set_result(msgspec.convert(reply.result, SiteAreas))
    except msgspec.ValidationError as error:
        answer.set_exception(CommandRefusedError(f"the gateway's areas cannot be read: {error}"))
