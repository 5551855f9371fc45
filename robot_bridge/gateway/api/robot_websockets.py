"""WebSockets of links and robots: many robots over one connection, and which connection holds a robot."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
from collections import Counter
from collections.abc import AsyncIterator
from typing import Any, TypeVar

import msgspec
from websockets.exceptions import ConnectionClosed

from ...core.errors import BridgeError, BusyError, ForbiddenError, NotReadyError, RefusedError, SiteError
from ...core.json_decoder import DecodingError
from ...core.logs import log_and_continue
from ...core.messages import links
from ...core.messages.administration import Gateways
from ...core.messages.base import (
    LARGEST_MESSAGE,
    MessageError,
    check_robot_name,
    refuse_unknown_keys,
    to_json,
)
from ...core.messages.commands import CommandState
from ...core.messages.links import AbortOfAll, GetAreas, LinkHello, LinkPositions, LinkStatus, LinkWelcome
from ...core.messages.robots import Abort, Ready, SendImage
from ...core.position_frame import entries_in, poses_in_frame
from ...core.sites.site import Site, areas_in_box
from ...protocol import jsonrpc
from ...protocol.codec import check_size, error_code
from ..auth.accounts import TokenKind, speaks_for
from ..auth.authorisation import ANY_LINK, PATHS, AuthGate
from ..auth.client_connection import ClientConnection
from ..fleet.link_supervision import ConnectedLink
from ..fleet.service import Fleet
from ..model.events import CommandChanged, GatewaysChanged, RobotLeft
from ..model.robots import RobotPose
from ..monitoring import BackgroundTasks
from .delivery import LARGE, send_stop, while_connected
from .robot_session import RobotConnection, RobotSession, RobotSessions, is_answering, send_frame
from .shared_connection import SEPARATOR, LinkedRobotChannel

# --- A link's WebSocket: the messages of many robots over one connection ---
# Messages of a robot are those on its own connection, with its name as ``robot`` in the params. An error of
# one robot of a link affects that robot alone. Stops wait for nothing.

log = logging.getLogger(__name__)

ANSWER_WITHIN = 5.0
"""seconds that a link has to answer requests to itself."""
AT_ONCE = 50
"""connections written to in one iteration of the loop when the gateways of the fleet have changed."""
AFTER_CUT_S = 2.0
"""seconds in which a link that was cut for a stop has to say Ready for one robot after another, before large
messages are sent: behind those a stop would have to cut it again."""
LONGEST_DELAY_S = 10.0
"""seconds after which they are sent, whoever comes."""
MOST_CALLS = 20
"""requests to a link that wait for its answer."""

Message = TypeVar("Message", LinkHello, LinkStatus, GetAreas)


class LinkConnection:
    """One connection of a link, from its Start to its end, and the robots that it speaks for.

    Its robots are in ``sessions`` from their Ready until it no longer speaks for them.
    """

    def __init__(
        self,
        fleet: Fleet,
        connection: ClientConnection,
        gate: AuthGate,
        sessions: RobotSessions,
    ) -> None:
        assert connection.identity is not None
        self.name = connection.identity.name or ANY_LINK
        self.kind: str | None = None
        self.status: LinkStatus | None = None
        self._fleet = fleet
        self._connection = connection
        self._gate = gate
        self._holders = sessions
        self._places: dict[str, LinkedRobotChannel] = {}
        self._robots = gate.robots_of_link(connection)
        self._turn, self._large = asyncio.Lock(), asyncio.Lock()
        self._large_from = self._large_from_at_last = 0.0
        """times of the loop before which no large message is sent, and to which that may be put off."""
        self._tasks = BackgroundTasks()
        self._numbers = itertools.count(1)
        self._pending_calls: dict[str, asyncio.Future[jsonrpc.Reply]] = {}

    # --- called by the gateway --------------------------------------------------------------------

    def sessions(self) -> list[RobotSession]:
        """Return the robots that it speaks for now."""
        return [place.session for place in self._places.values()]

    def delay_large(self) -> None:
        """Send no large message until the last robot has said Ready for :data:`AFTER_CUT_S`."""
        now = asyncio.get_running_loop().time()
        self._large_from, self._large_from_at_last = now + AFTER_CUT_S, now + LONGEST_DELAY_S

    async def run(self) -> None:
        """Serve the connection to its end."""
        try:
            await self.send(jsonrpc.call("Start", to_json(self._fleet.greeting(PATHS[TokenKind.LINK]))))
            if (call_id := self._fleet.emergency.call_id) is not None:
                self.stop_all(call_id)
            async for frame in self._connection:
                await self._receive(frame)
        except ConnectionClosed:
            return
        finally:
            self._fleet.links.withdraw(self.name, self.ask)
            for answer in self._pending_calls.values():
                answer.cancel()
            for place in self._places.values():
                place.end()

    async def ask(self, method: str, params: dict[str, Any]) -> Any:
        """Call a method of the link itself, and return its result; raises RefusedError."""
        if len(self._pending_calls) >= MOST_CALLS:
            raise RefusedError(f"link {self.name} has not answered yet what it was asked before")
        id = f"link-{next(self._numbers)}"
        answer = self._pending_calls[id] = asyncio.get_running_loop().create_future()
        try:
            async with asyncio.timeout(ANSWER_WITHIN):
                await self.send(jsonrpc.call(method, params, id))
                await asyncio.wait([answer])
        except (ConnectionClosed, TimeoutError):
            raise RefusedError(f"link {self.name} does not answer; is it connected?") from None
        finally:
            del self._pending_calls[id]
        if answer.cancelled():
            raise RefusedError(f"link {self.name} has just ended")
        reply = answer.result()
        if reply.error is not None:
            raise RefusedError(f"link {self.name}: {reply.error[:500]}")
        return reply.result

    def stop_all(self, call_id: str) -> None:
        """Send the link a stop of all its robots, including those that have not sent Ready by it.

        One frame for all; each robot replies with its own name before the id.
        """
        for place in self._places.values():
            place.session.outdate()
        frame = jsonrpc.call(AbortOfAll.method, to_json(AbortOfAll(call_id)))
        if not self.send_at_once(frame):
            self._tasks.start(while_connected(send_stop(self, frame)))

    async def send_gateways(self) -> None:
        """Send the gateways' addresses to a link that has said hello; raises ConnectionClosed."""
        gateways = self._fleet.gateways_at(PATHS[TokenKind.LINK])
        if gateways is not None and self.kind is not None:
            await self.send(jsonrpc.call(Gateways.method, to_json(gateways)))

    def update(self) -> None:
        """Release the robots that it may no longer speak for."""
        robots = self._gate.robots_of_link(self._connection)
        if robots == self._robots:
            return
        self._robots = robots
        for place in list(self._places.values()):
            if not speaks_for(robots, place.robot):
                self._holders.release(place.session)
                self._tasks.start(
                    while_connected(place.release(f"link {self.name} may not speak for it any more"))
                )

    # --- shared by its robots ----------------------------------------------------------------------------

    @property
    def round_trip(self) -> float | None:
        """Round-trip time of the last ping in seconds."""
        return self._connection.round_trip

    @contextlib.asynccontextmanager
    async def lane(self, *, urgent: bool, large: bool) -> AsyncIterator[None]:
        """Wait for the turn of a message: a small one waits for two large ones at most."""
        if urgent:
            yield
        elif large:
            while (early := self._large_from - asyncio.get_running_loop().time()) > 0:
                await asyncio.sleep(early)
            async with self._large, self._turn:
                yield
        else:
            async with self._turn:
                yield

    async def send(self, frame: str) -> None:
        """Write a message."""
        await send_frame(self._connection, frame)

    def send_at_once(self, frame: str) -> bool:
        """Write a message now; return false while another one is being sent."""
        return self._connection.write_at_once(frame)

    @property
    def is_busy(self) -> bool:
        """Whether a message is being sent, or waits for its turn."""
        return self._connection.is_busy or self._turn.locked()

    async def cut_if_busy(self) -> None:
        """Wait for the end of a long message, or cut the connection."""
        await self._connection.cut_if_busy()

    async def answers(self) -> bool:
        """Return whether the link answers a ping within a second."""
        return await is_answering(self._connection)

    def forget(self, place: LinkedRobotChannel) -> None:
        """Stop carrying a robot's messages, until the link sends Ready for it again."""
        if self._places.get(place.robot) is place:
            del self._places[place.robot]

    # --- incoming messages ---

    async def _receive(self, frame: str | bytes) -> None:
        id: int | str | None = None
        try:
            if isinstance(frame, bytes):
                await self._receive_frame(frame)
                return
            check_size(frame, LARGEST_MESSAGE, (SendImage.__name__, LinkPositions.method))
            message = jsonrpc.decode(frame)
            id = message.id
            if isinstance(message, jsonrpc.Call):
                await self._receive_call(message)
            else:
                self._receive_reply(message)
        except jsonrpc.FrameError as error:
            await self._refuse(error.id, error, code=error.code)
        except (MessageError, BridgeError, DecodingError) as error:
            await self._refuse(id, error)
        except ConnectionClosed:
            raise
        except Exception:
            # Whatever the error, it must not end a connection by which stops reach other robots.
            key = f"link {self.name}:", "unforeseen"
            text = self._fleet.repeated.note_unforeseen(log, key, f"link {self.name}")
            await self.send(jsonrpc.error(id, jsonrpc.INTERNAL_ERROR, text))

    async def _receive_call(self, call: jsonrpc.Call) -> None:
        if call.method == LinkHello.method:
            welcome = self._welcome(_decoded(LinkHello, call))
            await self.send(jsonrpc.result(call.id, to_json(welcome)))
        elif self.kind is None:
            raise NotReadyError(f"link {self.name} has not said hello on this connection; send hello first")
        elif call.method == LinkStatus.method:
            self.status = _decoded(LinkStatus, call)
            if call.id is not None:
                await self.send(jsonrpc.result(call.id, {}))
        elif call.method == GetAreas.method:
            # Those of a city take a moment; its robots' messages must not wait.
            self._tasks.start(while_connected(self._send_areas(call.id, _decoded(GetAreas, call))))
        elif call.method == LinkPositions.method:
            for entry in entries_in(call.params):
                method = "SendGPS" if "lat" in entry else "SendPos"
                await self._receive_robot_call(jsonrpc.Call(method, entry))
        else:
            await self._receive_robot_call(call)

    def _welcome(self, hello: LinkHello) -> LinkWelcome:
        self.kind = hello.kind
        self._fleet.links.introduce(self.name, hello.kind, self.ask)
        site = self._fleet.site
        return LinkWelcome(
            links.LINK_PROTOCOL,
            self.name,
            list(self._robots),
            self._fleet.reception.database_id,
            site.report,
            site.settings.observations.largest_image_bytes,
        )

    async def _send_areas(self, id: int | str | None, request: GetAreas) -> None:
        reply = await asyncio.to_thread(_areas_reply, id, self._fleet.site.site, request)
        async with self.lane(urgent=False, large=len(reply) > LARGE):
            await self.send(reply)

    async def _receive_robot_call(self, call: jsonrpc.Call) -> None:
        robot = call.params.get("robot") if isinstance(call.params, dict) else None
        try:
            place = self._place_of(robot, admits=call.method == Ready.__name__)
        except (MessageError, BridgeError) as error:
            await self._refuse(call.id, error, robot)
            return
        params = {name: value for name, value in call.params.items() if name != "robot"}
        place.add(place.session.receive(jsonrpc.Call(call.method, params, call.id)))

    def _place_of(self, robot: object, *, admits: bool = False) -> LinkedRobotChannel:
        """Return the channel of the robot that a message is about; raises MessageError and BridgeError."""
        place = self._places.get(robot) if isinstance(robot, str) else None
        if place is None:
            place = self._new_place(robot, admits=admits)
        if not place.count():
            raise BusyError(f"robot {place.robot!r} says too much; wait {place.wait:.2f} s and send less")
        return place

    def _new_place(self, robot: object, *, admits: bool) -> LinkedRobotChannel:
        if self.kind is None:
            raise NotReadyError(f"link {self.name} has not said hello on this connection; send hello first")
        if not isinstance(robot, str):
            raise MessageError(f"robot is {robot!r:.40}; give the name of the robot that this is about")
        check_robot_name(robot)
        if not speaks_for(self._robots, robot):
            raise ForbiddenError(
                f"link {self.name} may not speak for robot {robot!r}, only for {' '.join(self._robots)}; "
                f"'robot-bridge links robots {self.name} --robots ...' changes that"
            )
        if not admits:
            raise NotReadyError(
                f"robot {robot!r} has not said Ready on this connection; send Ready for it first"
            )
        limits = self._gate.limits
        if len(self._places) >= limits.robots:
            raise BusyError(f"link {self.name} speaks for {limits.robots} robots; there is room for no more")
        place = self._places[robot] = LinkedRobotChannel(self._fleet, self, robot, limits, self._holders)
        self._large_from = min(asyncio.get_running_loop().time() + AFTER_CUT_S, self._large_from_at_last)
        return place

    async def _receive_frame(self, frame: bytes) -> None:
        """Process positions of many robots; an error in one affects that one alone."""
        at_once: list[RobotPose] = []
        refused: list[tuple[str, Exception]] = []
        for robot, pose in poses_in_frame(frame):
            try:
                place = self._places.get(robot) or self._new_place(robot, admits=False)
                if isinstance(pose, MessageError):
                    raise pose
                if not place.count():
                    raise BusyError(f"robot {robot!r} says too much; wait {place.wait:.2f} s and send less")
            except (MessageError, BridgeError) as error:
                refused.append((robot, error))
                continue
            if place.listens():
                at_once.append((robot, pose))
            else:
                place.add(place.session.receive_pose(pose))
        for robot, rest in self._fleet.accept_poses(self.name, at_once):
            self._places[robot].session.follow_up(rest)
        for robot, fault in refused:
            await self._refuse(None, fault, robot)

    def _receive_reply(self, reply: jsonrpc.Reply) -> None:
        if (answer := self._pending_calls.get(str(reply.id))) is not None:
            if not answer.done():
                answer.set_result(reply)
            return
        robot, separator, id = str(reply.id).rpartition(SEPARATOR)
        place = self._places.get(robot)
        if not separator or place is None:
            raise MessageError(f"a reply to {str(reply.id)[:80]!r}, which no robot of this link was asked")
        if not place.count_reply():
            raise BusyError(f"robot {robot!r} answers too much; it is asked again")
        own_id = int(id) if id.isascii() and id.isdigit() and len(id) < 20 else id
        place.add(place.session.receive(jsonrpc.Reply(own_id, reply.result, reply.error, reply.code)))

    async def _refuse(
        self, id: int | str | None, error: Exception, robot: object = None, code: int | None = None
    ) -> None:
        """Send the link why a message is refused, and which robot that concerns."""
        self._fleet.counters.refused[self.name] += 1
        sender = f"link {self.name}:" if robot is None else f"link {self.name}: robot {str(robot)[:63]!r}:"
        self._fleet.repeated.warn(log, (f"link {self.name}:", type(error).__name__), f"{sender} {error}")
        data = None if robot is None else {"robot": robot}
        await self.send(jsonrpc.error(id, code or error_code(error), str(error), data))


def _areas_reply(id: int | str | None, site: Site, request: GetAreas) -> str:
    """Return the reply with the site's areas in a box; may take long."""
    try:
        return jsonrpc.result(id, to_json(areas_in_box(site, request.box)))
    except SiteError as error:
        return jsonrpc.error(id, jsonrpc.REFUSED, str(error))


def _decoded(cls: type[Message], call: jsonrpc.Call) -> Message:
    """Return the link's own message in a call; raises MessageError."""
    params = call.params or {}
    try:
        message = msgspec.convert(params, cls)
        refuse_unknown_keys(cls, params)
    except (msgspec.ValidationError, MessageError) as error:
        raise MessageError(f"{call.method}: {error}") from None
    return message


# --- Robots on WebSocket, by their own connections and by links: which connection holds which robot ---


class WebSocketInterface:
    """Serves the connections of robots; the one on which a robot last sent Ready counts."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._names: Counter[str] = Counter()
        self._sessions: set[RobotSession] = set()
        self._links: set[LinkConnection] = set()
        self._cut_links: set[str] = set()
        """links whose last connection was cut for a stop."""
        self._holders = RobotSessions(fleet.reception.holds)
        fleet.emergency.reach(self._stop_all)
        fleet.orders.reach(self.abort)
        fleet.events.subscribe(CommandChanged, self._abort_applicant)
        fleet.events.subscribe(RobotLeft, self._release)
        fleet.events.subscribe(GatewaysChanged, self._announce_gateways)
        self._tasks = BackgroundTasks()

    async def serve(self, connection: ClientConnection, robot: str | None) -> None:
        """Serve one connection to its end; a robot without a name is given one."""
        name = robot or self._free_name()
        own = RobotConnection(self._fleet, connection, name, self._holders)
        self._names[name] += 1
        self._sessions.add(own.session)
        try:
            in_order = await own.run()
        finally:
            self._sessions.discard(own.session)
            self._names -= Counter([name])
            held = self._holders.release(own.session)
        if in_order and held:
            self._fleet.closed(name)

    async def serve_link(self, connection: ClientConnection, gate: AuthGate) -> None:
        """Serve a link to its end. Its robots may drive on: they become lost after the usual times."""
        link = LinkConnection(self._fleet, connection, gate, self._holders)
        if link.name in self._cut_links:
            link.delay_large()
        self._links.add(link)
        try:
            await link.run()
        finally:
            self._links.discard(link)
            (self._cut_links.add if connection.was_cut else self._cut_links.discard)(link.name)
            for session in link.sessions():
                self._holders.release(session)

    def links(self) -> list[ConnectedLink]:
        """Return the links that are connected now."""
        return [
            ConnectedLink(link.name, link.kind, link.status, len(link.sessions())) for link in self._links
        ]

    def update(self) -> None:
        """Release the robots that links may no longer speak for."""
        for link in list(self._links):
            with log_and_continue(log, f"looking after link {link.name}"):
                link.update()

    def measure(self) -> None:
        """Record the latency of every robot's connection."""
        for session in self._holders:
            session.measure()

    def _stop_all(self, call_id: str) -> None:
        for link in list(self._links):
            with log_and_continue(log, f"telling link {link.name} of an emergency stop"):
                link.stop_all(call_id)
        for session in list(self._sessions):
            with log_and_continue(log, f"telling robot {session.robot!r} of an emergency stop"):
                session.stop_now(call_id)

    def abort(self, robot: str, call_id: str) -> bool:
        """Send an Abort that cannot be stored; return whether the robot is connected."""
        # By the second a restarted robot may be there.
        sessions = {s for s in (self._holders.get(robot), self._holders.applicant(robot)) if s is not None}
        for session in sessions:
            session.stop_now(call_id, emergency=False)
        return bool(sessions)

    def _abort_applicant(self, event: CommandChanged) -> None:
        """Send a stored Abort to a robot whose Ready is not stored yet: it is delivered nothing before."""
        report = event.report
        if report.op == Abort.__name__ and report.state is CommandState.QUEUED:
            applicant = self._holders.applicant(report.robot)
            if applicant is not None and not report.params.get("emergency"):
                applicant.stop_now(f"abort-{report.command}", emergency=False)

    def _release(self, event: RobotLeft) -> None:
        """Close the connection of a robot that another gateway owns; a robot still here sends Ready again."""
        if (session := self._holders.get(event.robot)) is not None:
            self._holders.release(session)
            reason = f"gateway {event.gateway} has this robot now; connect and say Ready again"
            session.replace(reason, again=True)

    def _announce_gateways(self, _: GatewaysChanged) -> None:
        self._tasks.start(self._send_gateways())

    async def _send_gateways(self) -> None:
        """Send links and robots the gateways' addresses; none waits for one that reads nothing."""
        connections: list[LinkConnection | RobotSession] = [*self._links, *self._sessions]
        for number, connection in enumerate(connections, 1):
            self._tasks.start(while_connected(connection.send_gateways()))
            if number % AT_ONCE == 0:
                # Thousands of robots would delay other messages.
                await asyncio.sleep(0)

    def _free_name(self) -> str:
        taken = {*self._fleet.robots.names(), *self._names}
        return next(name for n in range(1, len(taken) + 2) if (name := f"robot-{n}") not in taken)
