"""One ROS robot of a link, and its camera, between the gateway and the network that reaches it."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Generic, Protocol, TypeVar, cast

from ...core.messages.base import LONGEST_LABEL, MessageError, one_line
from ...core.messages.robots import SendGPS, SendImage, SendPos, SetMap, SetPath, SetPosEnd, SetPosIni
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

# --- What the way to a robot does for it, however that is made: over DDS, or over rosbridge ---

Network = TypeVar("Network", contravariant=True)
"""Who is there on the network, as that way to the robot knows it."""


class Hearing(Protocol[Network]):
    """Hears a robot's topics."""

    def connect(self, network: Network) -> None:
        """Read what is offered under the robot's names now."""

    def poll(self) -> SendPos | SendGPS | None:
        """Take in what has come; return the robot's newest position, None where none came."""


class RobotActions(Protocol[Network]):
    """Speaks to a robot. ``server`` is who has its tasks, None where nobody does."""

    server: bytes | None

    @property
    def feedback(self) -> str | None:
        """How far its goal is yet; None where that is not known."""

    def forget_feedback(self) -> None:
        """Forget how far its goal was."""

    @property
    def abilities(self) -> Abilities:
        """Who of the robot's side hears this program at the moment."""

    def connect(self, network: Network) -> None:
        """Meet the servers and listeners that are there now."""

    def hears(self, setting: str) -> bool:
        """Tell whether somebody listens to the topic of a setting."""

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        """Take in what servers have said; return the effects."""

    def send_goal(self, request: SendGoal, here: Pose | None) -> None:
        """Send a goal; ``here`` is where the robot is. Raises ValueError where it has no place there."""

    def ask_result(self, request: SendGoal) -> None:
        """Ask for the result of a goal that was taken on."""

    def cancel(self, request: CancelGoals) -> None:
        """Cancel goals."""

    def call(self, setting: str) -> None:
        """Call a service of type Trigger."""

    def publish_task(self, request: PublishTask, here: Pose | None) -> None:
        """Publish a target or a path; raises ValueError where it has no place there."""

    def publish_target(self, target: SetPosEnd, here: Pose | None) -> None:
        """Publish a target."""

    def publish_zero(self) -> None:
        """Publish speed 0, with or without a time as its listeners want it."""

    def publish_start(self, start: SetPosIni, here: Pose | None) -> None:
        """Publish where the robot is to take itself to be."""

    def publish_latched(self, setting: str, message: bytes) -> None:
        """Publish what is encoded on a topic of LATCHED: who comes later is told it, too."""

    def serve_map(self, grid: bytes) -> None:
        """Answer with a map that is encoded who asks for it by the service ``get_map``."""


# --- One robot's images on their way to the gateway: seldom, one at a time, with the place of the robot


class Camera:
    """Has the robot's sensing wait for an image when one is due, and sends it as an observation."""

    def __init__(self, robot: str, settings: RobotSettings, link: Link, sensing: Sensing) -> None:
        self._robot = robot
        self._settings = settings
        self._link = link
        self._sensing = sensing
        self._due = 0.0
        self._sending: asyncio.Task[None] | None = None

    def step(self, now: float) -> None:
        """Send the image that has come; ``now`` is a steady clock's."""
        sensing, image = self._sensing, self._sensing.image
        sensing.image = None
        place = self._place()
        if image is not None and place is not None and sensing.wants_image:
            self._due = now + self._settings.image_every_s
            self._sending = asyncio.create_task(self._send(*image, place))
        is_free = self._sending is None or self._sending.done()
        sensing.wants_image = is_free and now >= self._due and place is not None

    def _place(self) -> tuple[float, float] | None:
        """Return where the robot is in the site frame, None while that is not known."""
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


# --- One ROS robot of a link: what it says goes to the gateway, what the gateway says is done ---

log = logging.getLogger(__name__)

ABLE_WITHIN = 2.0
"""seconds from its first position until a robot is told of: its action servers are found by then."""
ABLE_EVERY = 1.0
"""seconds between two looks at what a robot that was told of can do by now."""
ALIVE_EVERY = 1.0
"""seconds."""
IDLE_EVERY = 0.1
"""seconds between two looks at the servers of a robot that has nothing to do."""


class RosRobot(Generic[Network]):
    """Led by :meth:`step`, again and again; asked by :meth:`command` and :meth:`stop`."""

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
        self._seen_at: float | None = None
        self._received_at = 0.0
        self._declared: tuple[Ability, ...] | None = None
        self._introduce_at = 0.0
        self._more_at: float | None = None
        """Since when it can do more than was told."""
        self._alarm: str | None = None
        self._warned: set[str] = set()
        self._server: bytes | None = None
        self._is_anew = False
        """Whether its action server has started anew while nobody led it."""
        self._last: Any = None

    @property
    def faults(self) -> list[str]:
        """What is wrong with it, in words."""
        return [*self._sensing.faults.values(), *([self._alarm] if self._alarm else [])]

    @property
    def server(self) -> bytes | None:
        """Who has its tasks: another one when that was started anew."""
        return self._server

    def expect_server(self, server: bytes | None) -> None:
        """Take it that an earlier process of this link knew ``server`` as the robot's."""
        self._server = server

    def connect(self, network: Network) -> None:
        """Meet who is there now."""
        self._hearing.connect(network)
        self._acting.connect(network)
        server = self._acting.server
        if server is None or server == self._server:
            return
        anew, self._server = self._server is not None, server
        if anew:
            log.warning("robot %s: its action server has started anew", self.name)
            self._tasks.forget()
            self._acting.forget_feedback()
            if self._declared is None:
                self._is_anew = True
            elif not self._tasks.is_only_held:
                # What is held it has never had: that would only be refused, and sent once more.
                self._link.restarted(self.name)

    def step(self, now: float) -> None:
        """Take in what has come and go on; ``now`` is a steady clock's."""
        position = self._hearing.poll()
        if position is not None:
            self._seen_at = now if self._seen_at is None else self._seen_at
            self._received_at = now
            self._last = position
            self._tasks.seen(position.v if not isinstance(position, SendGPS) else None)
        self._introduce(now)
        if self._camera is not None and self._declared is not None:
            self._camera.step(now)
        if self._declared is not None and position is not None:
            self._link.position(self.name, replace(position, status=self._status()))
        # Who is not told of has no commands yet, and what became of earlier ones could not be told.
        if self._declared is not None and (self._tasks.is_busy or now >= self._act_at):
            self._act_at = now + IDLE_EVERY
            self._run(self._acting.poll(self._tasks, now, self._fault))
            self._run(self._tasks.step(self._acting.abilities, now))

    def admitted(self) -> None:
        """Tell where it is: the gateway has let it in."""
        if self._last is not None and time.monotonic() - self._received_at < ALIVE_EVERY:
            self._link.position(self.name, self._last)

    async def command(self, command: Command) -> None:
        """Have it take on a command; raises CommandRefusedError."""
        message = command.message
        if isinstance(message, (SetPosEnd, SetPath)):
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
        """Raise CommandRefusedError for what has no place in the robot's frame."""
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
        """Publish keepouts and speeds; the map has been taken on whatever comes of that."""
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
        """Tell the gateway of the robot when it is known what it can do, and again when that is more.

        What it can do no more is kept: its commands are refused with the reason, and who has started anew is
        soon able again.
        """
        if self._seen_at is None or now < self._introduce_at:
            return
        self._introduce_at = now + (IDLE_EVERY if self._declared is None else ABLE_EVERY)
        can = self._acting.abilities
        abilities = self._abilities(can)
        whole = {"targets", "paths"} <= set(abilities)
        if self._declared is None and now - self._seen_at < ABLE_WITHIN and not whole:
            return
        declared = self._declared or ()
        both = (*declared, *(one for one in abilities if one not in declared))
        if both == self._declared:
            self._more_at = None
            return
        # Servers are found one after the other, and are told together.
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
        return [cast("Ability", name) for name, there in offered.items() if there]

    @property
    def _here(self) -> Pose | None:
        pose = self._sensing.pose
        return None if pose is None else (pose.x, pose.y, pose.theta)

    def _status(self) -> str | None:
        return self._alarm or self._sensing.diagnosis or self._acting.feedback

    def _fault(self, what: str, text: str) -> None:
        """Log what a server said wrong: once, since it may say so again and again."""
        if what not in self._warned:
            self._warned.add(what)
            log.warning("robot %s: %s", self.name, text)

    def _run(self, effects: list[Effect]) -> None:
        for effect in effects:
            self._carry_out(effect)

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
                    self._tell(effect)
                except ValueError as error:
                    log.error("robot %s was not told: %s", self.name, error)

    def _tell(self, effect: Effect) -> None:
        """Carry out what the robot is told; raises ValueError for what has no place in its frame."""
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
