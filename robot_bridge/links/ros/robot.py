"""One ROS robot of a link, and its camera, between the gateway and the robots' network."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Generic, Protocol, TypeVar, cast

from ...core.messages.base import LONGEST_LABEL, MessageError, one_line
from ...core.messages.robots import (
    MOTIONS,
    SendGPS,
    SendImage,
    SendPos,
    SetMap,
    SetPath,
    SetPosEnd,
    SetPosIni,
)
from ...core.messages.safety import Ability
from ...core.sites.frame import SiteFrame
from ..base.adapter import Command, Link
from ..base.errors import CommandRefusedError
from ..base.frames import WGS84, FrameSettings, LinkFrame
from .effects import (
    Abilities,
    Answered,
    CallCone,
    CallStop,
    CancelGoals,
    Effect,
    Idle,
    PublishHere,
    PublishTask,
    Remark,
    RosAction,
    SendGoal,
    StopEnded,
    ZeroTwist,
)
from .errors import FaultError
from .messages import Pose, image_of
from .sensing import Sensing, stamp
from .settings import RobotSettings
from .site_maps import KEEPOUT, SPEED, Grids, Masks, SiteMasks
from .tasks import Tasks

# --- Interface of the transport to a robot: DDS, or rosbridge ---

Network = TypeVar("Network", contravariant=True)
"""The nodes present on the network, as known to that transport."""


class Hearing(Protocol[Network]):
    """Receives a robot's topics."""

    def connect(self, network: Network) -> None:
        """Subscribe to the topics present under the robot's names."""

    def poll(self) -> SendPos | SendGPS | None:
        """Process received messages; return the robot's newest position, or None."""


class RobotActions(Protocol[Network]):
    """Commands a robot. ``server`` identifies the server with its tasks, None without one."""

    server: bytes | None

    @property
    def feedback(self) -> str | None:
        """The progress of its goal; None if unknown."""

    def forget_feedback(self) -> None:
        """Forget the progress of its goal."""

    @property
    def abilities(self) -> Abilities:
        """The robot's abilities, by the servers and subscribers present now."""

    def connect(self, network: Network) -> None:
        """Connect to the present servers and subscribers."""

    def hears(self, setting: str) -> bool:
        """Return whether the topic of a setting has subscribers."""

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        """Process messages of servers; return the effects."""

    def send_goal(self, request: SendGoal, here: Pose | None) -> None:
        """Send a goal; ``here`` is the robot's pose. Raises ValueError if it cannot be converted."""

    def ask_result(self, request: SendGoal) -> None:
        """Request the result of an accepted goal."""

    def cancel(self, request: CancelGoals) -> None:
        """Cancel goals."""

    def call(self, setting: str) -> None:
        """Call a service of type Trigger."""

    def publish_task(self, request: PublishTask, here: Pose | None) -> None:
        """Publish a target or a path; raises ValueError if it cannot be converted."""

    def publish_target(self, target: SetPosEnd, here: Pose | None) -> None:
        """Publish a target."""

    def publish_zero(self) -> None:
        """Publish speed 0, with or without a time stamp as its subscribers expect."""

    def publish_start(self, start: SetPosIni, here: Pose | None) -> None:
        """Publish the robot's initial pose."""

    def publish_latched(self, setting: str, message: bytes) -> None:
        """Publish an encoded message on a topic of LATCHED: later subscribers receive it, too."""

    def serve_map(self, grid: bytes) -> None:
        """Answer the service ``get_map`` with an encoded map."""


# --- One robot's images sent to the gateway: at intervals, one at a time, with the robot's place


class Camera:
    """Requests an image from the robot's sensing when one is due, and sends it as an observation."""

    def __init__(self, robot: str, settings: RobotSettings, link: Link, sensing: Sensing) -> None:
        self._robot = robot
        self._settings = settings
        self._link = link
        self._sensing = sensing
        self._due = 0.0
        self._sending: asyncio.Task[None] | None = None

    def step(self, now: float) -> None:
        """Send a received image; ``now`` is a steady clock's."""
        sensing, image = self._sensing, self._sensing.image
        sensing.image = None
        place = self._place()
        if image is not None and place is not None and sensing.wants_image:
            self._due = now + self._settings.image_every_s
            self._sending = asyncio.create_task(self._send(*image, place))
        is_free = self._sending is None or self._sending.done()
        sensing.wants_image = is_free and now >= self._due and place is not None

    def _place(self) -> tuple[float, float] | None:
        """Return the robot's place in the site frame, None while unknown."""
        pose, fix = self._sensing.pose, self._sensing.fix
        if pose is not None:
            return pose.x, pose.y
        if fix is None:
            return None
        site = self._link.site
        frame = SiteFrame(site.crs, (site.origin[0], site.origin[1]), site.rotation)
        try:
            return LinkFrame(FrameSettings(crs=WGS84), frame).to_site(fix.lon, fix.lat)
        except ValueError:
            return None

    async def _send(self, topic: str, type_name: str, message: Any, place: tuple[float, float]) -> None:
        largest = min(self._settings.largest_image_bytes, self._link.largest_image_bytes)
        try:
            image = await asyncio.to_thread(image_of, type_name, message, largest)
            digest = hashlib.sha256(image).hexdigest()[:16]
            x, y = place
            seen = one_line(str(message.header.frame_id), LONGEST_LABEL) or "camera"
            image_message = SendImage(
                image, x, y, seen, t=stamp(message.header), source=f"{topic[-100:]} {digest}"
            )
            await self._link.ask(self._robot, image_message)
        except (FaultError, MessageError, CommandRefusedError) as error:
            self._sensing.refuse(topic, error)
        else:
            self._sensing.faults.pop(topic, None)


# --- One ROS robot of a link: reports to the gateway, and executes its commands ---

log = logging.getLogger(__name__)

ABLE_WITHIN = 2.0
"""seconds from a robot's first position or server until it is announced: its other servers are found then."""
ABLE_EVERY = 1.0
"""seconds between checks of an announced robot's abilities."""
ALIVE_EVERY = 1.0
"""seconds."""
IDLE_EVERY = 0.1
"""seconds between polls of the servers of an idle robot."""


class RosRobot(Generic[Network]):
    """Driven by calls of :meth:`receive` and :meth:`act`; commanded by :meth:`command` and :meth:`stop`."""

    def __init__(
        self,
        name: str,
        settings: RobotSettings,
        link: Link,
        sensing: Sensing,
        hearing: Hearing[Network],
        acting: RobotActions[Network],
        grids: Grids,
        masks: Masks,
    ) -> None:
        self.name = name
        self._settings = settings
        self._link = link
        self._sensing = sensing
        self._hearing = hearing
        self._acting = acting
        self._grids = grids
        self._masks = masks
        self._masking: asyncio.Task[None] | None = None
        self._tasks = Tasks(
            cones=settings.topics.place_cone is not None,
            path_actions=settings.actions_for_paths,
            hold_s=settings.hold_s,
        )
        self._camera = None if settings.topics.image is None else Camera(name, settings, link, sensing)
        self._commands: dict[int, asyncio.Future[None]] = {}
        self._overtaken: set[int] = set()
        self._stops: list[asyncio.Future[None]] = []
        self._sent: dict[int, SendGoal] = {}
        self._act_at = 0.0
        self._met_at: float | None = None
        self._received_at = 0.0
        self._declared: tuple[Ability, ...] | None = None
        self._introduce_at = 0.0
        self._more_at: float | None = None
        """Since when it has more abilities than reported."""
        self._alarm: str | None = None
        self._warned: set[str] = set()
        self._server: bytes | None = None
        self._is_anew = False
        """Whether its action server has restarted while no link controlled it."""
        self._last: Any = None

    @property
    def faults(self) -> list[str]:
        """Its faults as texts."""
        return [*self._sensing.faults.values(), *([self._alarm] if self._alarm else [])]

    @property
    def server(self) -> bytes | None:
        """Identity of the server with its tasks: it changes on a restart."""
        return self._server

    def expect_server(self, server: bytes | None) -> None:
        """Set the ``server`` of the robot as known to an earlier process of this link."""
        self._server = server

    def connect(self, network: Network) -> None:
        """Connect to the servers and topics present now."""
        self._hearing.connect(network)
        self._acting.connect(network)
        server = self._acting.server
        if server is None or server == self._server:
            return
        restarted, self._server = self._server is not None, server
        if restarted:
            log.warning("robot %s: its action server has started anew", self.name)
            self._tasks.forget()
            self._acting.forget_feedback()
            if self._declared is None:
                self._is_anew = True
            elif not self._tasks.is_only_held:
                # A held order never reached it: that would only be refused, and sent again.
                self._link.restarted(self.name)

    def receive(self, now: float) -> None:
        """Process received topics; ``now`` is a steady clock's."""
        position = self._hearing.poll()
        if position is not None:
            self._received_at = now
            self._last = position
            self._tasks.seen(position.v if not isinstance(position, SendGPS) else None)
        if self._declared is not None and position is not None:
            self._link.position(self.name, replace(position, status=self._status()))
        if self._camera is not None and self._declared is not None:
            self._camera.step(now)

    def act(self, now: float) -> None:
        """Process its servers' messages, continue its task or stop, and announce it.

        Apart from :meth:`receive`: an error there must not hold up a stop.
        """
        # A robot not announced has no commands yet, and outcomes of earlier ones could not be reported.
        if self._declared is not None and (self._tasks.is_busy or now >= self._act_at):
            self._act_at = now + IDLE_EVERY
            try:
                self._run(self._acting.poll(self._tasks, now, self._fault))
            finally:
                # A stop is repeated whatever its servers say.
                self._run(self._tasks.step(self._acting.abilities, now))
        self._introduce(now)

    def admitted(self) -> None:
        """Report its position: the gateway has admitted it."""
        if self._last is not None and time.monotonic() - self._received_at < ALIVE_EVERY:
            self._link.position(self.name, self._last)

    async def command(self, command: Command) -> None:
        """Have it accept a command; raises CommandRefusedError."""
        message = command.message
        if isinstance(message, MOTIONS):
            await self._order(command.id, message, command.again)
        elif isinstance(message, SetPosIni):
            self._begin_at(message)
        elif isinstance(message, SetMap):
            await self._show(message)
        else:
            raise CommandRefusedError(f"a ROS robot does not take {type(message).__name__}")

    async def stop(self) -> None:
        """Stop it, and return when its side has confirmed that; raises CommandRefusedError."""
        ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._stops.append(ended)
        self._alarm = None
        self._run(self._tasks.abort(self._acting.abilities, time.monotonic()))
        await ended

    async def _order(self, id: int, order: SetPosEnd | SetPath, again: bool) -> None:
        self._check_places([(order.x, order.y)] if isinstance(order, SetPosEnd) else order.points)
        taken: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._commands[id] = taken
        self._overtaken.discard(id)
        try:
            abilities, now = self._acting.abilities, time.monotonic()
            self._run(self._tasks.order(id, order, abilities, now, again=again))
            await taken
        except asyncio.CancelledError:
            self._overtaken.add(id)
            self._run(self._tasks.withdraw(id, time.monotonic()))
            raise
        finally:
            self._commands.pop(id, None)

    def _begin_at(self, start: SetPosIni) -> None:
        if not self._acting.hears("initial_pose"):
            raise CommandRefusedError("nobody listens to its topic for the initial pose; is AMCL running?")
        self._check_places([(start.x, start.y)])
        self._acting.publish_start(start, self._here)

    def _check_places(self, places: Sequence[tuple[float, float]]) -> None:
        """Raise CommandRefusedError for places that cannot be converted to the robot's frame."""
        try:
            for x, y in places:
                self._link.frame.from_site(x, y)
        except ValueError as error:
            raise CommandRefusedError(str(error)) from None

    async def _show(self, message: SetMap) -> None:
        topics = self._settings.topics
        if not self._settings.maps:
            raise CommandRefusedError("the link's settings name no topic for its map")
        if topics.map is not None or topics.get_map is not None:
            grid = await self._grids.of(message.map)
            try:
                if topics.map is not None:
                    self._acting.publish_latched("map", grid)
                if topics.get_map is not None:
                    self._acting.serve_map(grid)
            except FaultError as error:
                raise CommandRefusedError(str(error)) from None
        if topics.keepout_mask is not None or topics.speed_mask is not None:
            if self._masking is not None:
                self._masking.cancel()
            self._masking = asyncio.create_task(self._show_masks(message.map))

    async def _show_masks(self, robot_map: bytes) -> None:
        """Publish keepouts and speeds; the map counts as accepted even if that fails."""
        try:
            self._publish_masks(await self._masks.of(robot_map))
        except (CommandRefusedError, FaultError) as error:
            self._sensing.fault("masks", str(error))
        else:
            self._sensing.faults.pop("masks", None)

    def _publish_masks(self, masks: SiteMasks) -> None:
        patterns = self._settings.patterns
        made = (("keepout", KEEPOUT, masks.keepout, 1.0), ("speed", SPEED, masks.speed, masks.multiplier))
        for name, kind, grid, multiplier in made:
            mask, info = f"{name}_mask", f"{name}_info"
            if mask in patterns:
                self._acting.publish_latched(mask, grid)
            if info in patterns:
                topic = patterns[mask].topic_of(self.name)
                self._acting.publish_latched(info, self._masks.info(kind, topic, multiplier))

    def _introduce(self, now: float) -> None:
        """Announce the robot to the gateway once its abilities are known, and again when it gains some.

        One whose position is silent is announced, too, if anything can stop it: no stop reaches it otherwise.
        Lost abilities are kept: commands are refused with the reason, and a restarted server is soon back.
        """
        if now < self._introduce_at:
            return
        self._introduce_at = now + (IDLE_EVERY if self._declared is None else ABLE_EVERY)
        can = self._acting.abilities
        if self._met_at is None:
            if self._last is None and not can.is_stoppable:
                return
            self._met_at = now
        abilities = self._abilities(can)
        whole = {"targets", "paths"} <= set(abilities)
        if self._declared is None and now - self._met_at < ABLE_WITHIN and not whole:
            return
        declared = self._declared or ()
        both = (*declared, *(one for one in abilities if one not in declared))
        if both == self._declared:
            self._more_at = None
            return
        # Servers are found one after the other, and reported together.
        self._more_at = now if self._more_at is None else self._more_at
        if self._declared is not None and now - self._more_at < ABLE_WITHIN and not whole:
            return
        first, self._declared, self._more_at = self._declared is None, both, None
        self._link.add(self.name, both, path_cones="cones" in both)
        if first and self._is_anew:
            self._link.restarted(self.name)

    def _abilities(self, can: Abilities) -> list[Ability]:
        settings = self._settings
        offered = {
            "targets": RosAction.TO_POSE in can.driving or can.goal_topic,
            "paths": can.path_topic or not can.driving.isdisjoint(settings.actions_for_paths),
            "start": self._acting.hears("initial_pose"),
            "cones": can.cone_service,
            "map": settings.maps,
            "images": settings.topics.image is not None,
        }
        abilities = [cast("Ability", name) for name, there in offered.items() if there]
        return abilities or (["stop"] if can.is_stoppable else [])

    @property
    def _here(self) -> Pose | None:
        pose = self._sensing.pose
        return None if pose is None else (pose.x, pose.y, pose.theta)

    def _status(self) -> str | None:
        return self._alarm or self._sensing.diagnosis or self._acting.feedback

    def _fault(self, what: str, text: str) -> None:
        """Log a server's fault once, since it may repeat."""
        if what not in self._warned:
            self._warned.add(what)
            log.warning("robot %s: %s", self.name, text)

    def _run(self, effects: list[Effect]) -> None:
        """Carry out effects; an unforeseen error in one is raised after the others, which may be a stop's."""
        errors = []
        for effect in effects:
            try:
                self._carry_out(effect)
            except Exception as error:
                errors.append(error)
        if errors:
            raise errors[0]

    def _carry_out(self, effect: Effect) -> None:
        match effect:
            case Answered():
                self._answer(effect)
            case StopEnded():
                self._end_stops(effect.refusal)
            case Idle():
                if self._declared is not None:
                    self._link.stopped(self.name)
            case Remark():
                log.warning("robot %s: %s", self.name, effect.text)
                self._alarm = None
            case _:
                try:
                    self._send(effect)
                except ValueError as error:
                    log.error("robot %s was not sent a message: %s", self.name, error)

    def _send(self, effect: Effect) -> None:
        """Send an effect to the robot; raises ValueError for places that cannot be converted to its frame."""
        match effect:
            case SendGoal():
                self._sent[effect.message] = effect
                self._acting.send_goal(effect, self._here)
            case CancelGoals():
                self._acting.cancel(effect)
            case PublishTask():
                self._acting.publish_task(effect, self._here)
            case PublishHere() if self._here is not None:
                x, y, theta = self._here
                self._acting.publish_target(SetPosEnd(x, y, theta), self._here)
            case ZeroTwist():
                self._acting.publish_zero()
            case CallStop():
                self._acting.call("stop")
            case CallCone():
                self._acting.call("place_cone")

    def _answer(self, answered: Answered) -> None:
        waiting = self._commands.pop(answered.message, None)
        sent = self._sent.pop(answered.message, None)
        if answered.refusal is None:
            if sent is not None:
                self._acting.ask_result(sent)
            if waiting is not None and not waiting.done():
                waiting.set_result(None)
        elif waiting is not None and not waiting.done():
            waiting.set_exception(CommandRefusedError(answered.refusal))
        elif answered.message not in self._overtaken and self._declared is not None:
            self._link.give_up(self.name, answered.message, answered.refusal)

    def _end_stops(self, refusal: str | None) -> None:
        stops, self._stops = self._stops, []
        self._alarm = refusal
        for stop in stops:
            if stop.done():
                continue
            if refusal is None:
                stop.set_result(None)
            else:
                stop.set_exception(CommandRefusedError(refusal))
