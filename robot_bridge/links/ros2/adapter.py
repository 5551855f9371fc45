"""Adapter of ROS 2 robots over DDS: settings; reads robots' topics, calls their actions and services."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, ClassVar

from ...core.messages.robots import SendGPS, SendPos, SetPath, SetPosEnd, SetPosIni
from ..base.adapter import Adapter, Link
from ..base.errors import LinkError
from ..base.settings import LinkSettings, read_settings
from ..ros import messages
from ..ros.adapter import RobotNotes, RosAdapter
from ..ros.effects import Abilities, CancelGoals, PublishTask, RosAction, SendGoal
from ..ros.errors import FaultError, RosError
from ..ros.goals import GoalStatus, Statuses, feedback_text, missed_of, statuses_of
from ..ros.robot import RosRobot
from ..ros.sensing import Sensing
from ..ros.settings import RobotSettings, check_robots
from ..ros.site_maps import Grids, Masks
from ..ros.tasks import Tasks
from .dds import DdsSettings, Endpoint, Participant, Quality, Range, RawReader, RawWriter, quality_for
from .interfaces import (
    Interfaces,
    action_names,
    server_from_dds,
    service_names,
    topic_from_dds,
    topic_to_dds,
    type_from_dds,
    type_to_dds,
)
from .security import SecuritySettings
from .services import ActionClient, Refuse, ServiceClient, ServiceServer, by_topic, is_framed

PACKAGES = ("cyclonedds", "rosbags")
"""Python packages of the extra ``ros2``."""

# --- Table ``[ros2]`` of a link's settings: the DDS network beside the robots ---


class Ros2Settings(RobotSettings, frozen=True, forbid_unknown_fields=True):
    """Table ``[ros2]``."""

    domain: int = 0
    range: Range = "subnet"
    interfaces: tuple[str, ...] = ()
    peers: tuple[str, ...] = ()
    security: SecuritySettings | None = None

    def dds(self, folder: Path) -> DdsSettings:
        """Return the DDS domain; files are in ``folder``. Raises RosError, which begins with the key."""
        try:
            security = None if self.security is None else self.security.beside(folder)
        except RosError as error:
            raise RosError(f"security.{error}") from None
        return DdsSettings(self.domain, self.range, self.interfaces, self.peers, security)


def check(settings: LinkSettings, own: Ros2Settings) -> None:
    """Raise LinkError, naming file and key, for errors that the types do not exclude."""
    check_robots(own, "ros2", settings)
    try:
        own.dds(settings.folder)
    except RosError as error:
        raise LinkError(f"{settings.file}: ros2.{error}") from None


# --- Readers of one robot's topics over DDS ---

Offers = Mapping[tuple[str, bool], list[Endpoint]]


@dataclass
class _Subscription:
    """A subscribed topic."""

    topic: str
    type_name: str
    reader: RawReader
    quality: Quality
    offers: frozenset[bytes]


class DdsSubscriptions:
    """Reads a robot's topics as they are offered, and passes their messages to its sensing."""

    def __init__(self, sensing: Sensing, participant: Participant, types: Interfaces) -> None:
        self._sensing = sensing
        self._participant = participant
        self._types = types
        self._subscriptions: dict[str, _Subscription] = {}
        self._camera: tuple[str, list[Endpoint]] | None = None
        """The topic of its images, and its writers."""

    def connect(self, offers: Offers) -> None:
        """Subscribe to the topics offered under the robot's names; again for those offered otherwise now."""
        for kind, topic in self._sensing.topics().items():
            offered = offers.get((topic_to_dds(topic), False), [])
            if kind == "image":
                self._camera = (topic, offered) if offered else None
            elif offered:
                self._read(kind, topic, offered)
            elif self._subscriptions.pop(kind, None) is not None:
                self._sensing.faults.pop(topic, None)

    def poll(self) -> SendPos | SendGPS | None:
        """Process received messages; return the robot's newest position, or None."""
        self._watch()
        newest: SendPos | SendGPS | None = None
        for kind, subscription in list(self._subscriptions.items()):
            for data in subscription.reader.read_samples():
                try:
                    message = self._types.decode(subscription.type_name, data)
                except FaultError as error:
                    self._sensing.refuse(subscription.topic, error)
                else:
                    newest = (
                        self._sensing.receive(kind, subscription.topic, subscription.type_name, message)
                        or newest
                    )
        return newest

    def _watch(self) -> None:
        """Subscribe to images only while one is awaited: a network should not carry a camera's data twice."""
        if self._camera is not None and self._sensing.wants_image:
            self._read("image", *self._camera)
        elif (subscription := self._subscriptions.pop("image", None)) is not None:
            subscription.reader.close()

    def _read(self, kind: str, topic: str, offered: list[Endpoint]) -> None:
        keys = frozenset(one.key for one in offered)
        subscription = self._subscriptions.get(kind)
        if subscription is not None and subscription.offers == keys:
            return
        # Another node that publishes nonsense under the topic's name must not hide the robot's own.
        strange = [one for one in offered if type_from_dds(one.type_name) not in messages.READ[kind]]
        offered = [one for one in offered if one not in strange] or offered
        found = type_from_dds(offered[0].type_name)
        type_name = self._sensing.check_type(kind, topic, found, offered[0].type_name)
        if type_name is None:
            self._subscriptions.pop(kind, None)
            return
        if strange:
            self._sensing.check_type(kind, topic, None, strange[0].type_name)
        elif len({one.participant for one in offered}) > 1 and kind == "position":
            self._sensing.fault(topic, f"{len(offered)} nodes publish {topic}; end all but one of them")
        elif kind != "image":
            self._sensing.faults.pop(topic, None)
        quality = quality_for(offered, depth=1 if kind == "image" else 10)
        if subscription is None or subscription.quality != quality or subscription.type_name != type_name:
            try:
                reader = self._participant.reader(topic_to_dds(topic), offered[0].type_name, quality)
            except FaultError as error:
                self._subscriptions.pop(kind, None)
                self._sensing.fault(f"permission {topic}", str(error))
                return
            self._subscriptions[kind] = _Subscription(topic, type_name, reader, quality, keys)
        else:
            subscription.offers = keys


# --- Commands to one robot: clients of its actions and services, and writers of its topics ---

log = logging.getLogger(__name__)

NOT_SERVED = (
    "a node on Fast DDS asks for the map by the service get_map, which can be answered to nodes on Cyclone "
    "DDS alone; have it listen to the topic map, or run the node for that of docs/links-ros2.md (GetMap on "
    "Fast DDS)"
)


class DdsActions:
    """Commands one robot. ``server`` is the participant of its action server, or None."""

    def __init__(
        self,
        robot: str,
        settings: Ros2Settings,
        participant: Participant,
        types: Interfaces,
        outgoing: messages.Outgoing,
        sensing: Sensing,
    ) -> None:
        self._robot = robot
        self._settings = settings
        self._participant = participant
        self._types = types
        self._outgoing = outgoing
        self._sensing = sensing
        self._patterns = settings.patterns
        self._actions: dict[RosAction, ActionClient] = {}
        self._services: dict[str, ServiceClient] = {}
        self._writers: dict[str, tuple[str, RawWriter]] = {}
        self._other_goals: dict[RosAction, str] = {}
        """The hash of goals with another layout than those sent."""
        self._listened_to: set[str] = set()
        self._map_server: ServiceServer | None = None
        self.server: bytes | None = None
        self.feedback: str | None = None

    def connect(self, offers: Offers) -> None:
        """Connect to the present servers and subscribers."""
        self.server = None
        for action, setting in messages.ACTIONS.items():
            with self._noting_permission(setting):
                self._connect_action(action, setting, offers)
        for setting in messages.SERVICES:
            if setting in self._patterns:
                with self._noting_permission(setting):
                    self._connect_service(setting, offers)
        for setting, known in messages.WRITTEN.items():
            if setting in self._patterns:
                with self._noting_permission(setting):
                    self._connect_topic(setting, known, offers)

    @property
    def abilities(self) -> Abilities:
        """The robot's abilities, by the servers and subscribers present now."""
        return Abilities(
            frozenset(action for action, client in self._actions.items() if client.is_matched),
            frozenset(self._other_goals),
            goal_topic="goal_pose" in self._listened_to,
            path_topic="path" in self._listened_to,
            velocity="cmd_vel" in self._listened_to,
            stop_service="stop" in self._services,
            cone_service="place_cone" in self._services,
        )

    def forget_feedback(self) -> None:
        """Forget the progress of its goal."""
        self.feedback = None

    def hears(self, setting: str) -> bool:
        """Return whether the topic of a setting has subscribers."""
        return setting in self._listened_to

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Any]:
        """Process messages of servers; return the effects."""
        effects: list[Any] = []
        if self._map_server is not None and self._map_server.answer():
            fault("get_map", NOT_SERVED)
        for action, client in self._actions.items():
            refuse = partial(_refuse, fault, action.value, f"the server of {action.value}")
            effects += self._poll_action(action, client, tasks, now, refuse)
        for setting, service in self._services.items():
            for reply in service.replies(partial(_refuse, fault, setting, f"its service {setting}")):
                if setting == "stop":
                    tasks.stop_answered(bool(reply.success), str(reply.message))
                else:
                    effects += tasks.cone_answered(bool(reply.success), str(reply.message))
        return effects

    def send_goal(self, request: SendGoal, here: messages.Pose | None) -> None:
        """Send a goal; ``here`` is the robot's pose. Raises ValueError if it cannot be converted."""
        client = self._actions[request.action]
        client.send_goal(request.goal_id, **self._outgoing.goal(request.action, request.task, here))

    def ask_result(self, request: SendGoal) -> None:
        """Request the result of an accepted goal."""
        if request.action in self._actions:
            self._actions[request.action].ask_result(request.goal_id)

    def cancel(self, request: CancelGoals) -> None:
        """Cancel goals."""
        if request.action in self._actions:
            self._actions[request.action].cancel_goals(request.goal_id)

    def call(self, setting: str) -> None:
        """Call a service of type Trigger."""
        if setting in self._services:
            self._services[setting].call(self._types.make(f"{messages.TRIGGER}_Request"))

    def publish_task(self, request: PublishTask, here: messages.Pose | None) -> None:
        """Publish a target or a path; raises ValueError if it cannot be converted."""
        if isinstance(request.task, SetPath):
            self._publish("path", self._outgoing.path(request.task))
        else:
            self.publish_target(request.task, here)

    def publish_target(self, target: SetPosEnd, here: messages.Pose | None) -> None:
        """Publish a target."""
        fields = self._outgoing.goal(RosAction.TO_POSE, target, here)
        self._publish("goal_pose", fields["pose"])

    def publish_zero(self) -> None:
        """Publish speed 0, with or without a time stamp as its subscribers expect."""
        type_name = self._writers["cmd_vel"][0] if "cmd_vel" in self._writers else messages.TWIST
        self._publish("cmd_vel", self._types.make(type_name))

    def publish_start(self, start: SetPosIni, here: messages.Pose | None) -> None:
        """Publish the robot's initial pose."""
        self._publish("initial_pose", self._outgoing.start(start, here))

    def publish_latched(self, setting: str, message: bytes) -> None:
        """Publish an encoded message on a topic of LATCHED: later subscribers receive it, too."""
        if setting not in self._writers:
            self._write_to(setting, messages.LATCHED[setting])
        self._writers[setting][1].write(message)

    def serve_map(self, grid: bytes) -> None:
        """Answer the service ``get_map`` with an encoded map."""
        if self._map_server is None:
            names = service_names(self._topic("get_map"), messages.GET_MAP)
            self._map_server = ServiceServer(self._participant, names)
        # The map is the whole of the reply, so both are the same bytes.
        self._map_server.set_reply(grid)

    def _topic(self, setting: str) -> str:
        return self._patterns[setting].topic_of(self._robot)

    @contextmanager
    def _noting_permission(self, setting: str) -> Iterator[None]:
        """Record a missing permission of this link as a fault; the robot's other topics are used."""
        try:
            yield
        except FaultError as error:
            self._sensing.fault(f"permission {setting}", str(error))

    def _connect_service(self, setting: str, offers: Offers) -> None:
        names = service_names(self._topic(setting), messages.TRIGGER)
        servers = offers.get((names.request, True), [])
        if not servers:
            self._services.pop(setting, None)
        elif setting not in self._services:
            self._services[setting] = ServiceClient(
                self._participant, self._types, names, messages.TRIGGER, framed=is_framed(servers[0])
            )

    def _connect_action(self, action: RosAction, setting: str, offers: Offers) -> None:
        if setting not in self._patterns:
            return
        topic = self._topic(setting)
        names = action_names(topic, messages.action_type(action))
        servers = offers.get((names.send_goal.request, True), [])
        right = [one for one in servers if one.type_name == names.send_goal.request_type]
        if not right:
            self._actions.pop(action, None)
            self._other_goals.pop(action, None)
            self._sensing.faults.pop(topic, None)
            return
        if self._reads_goals(action, topic, right[0]):
            self._check_alone(topic, right)
        if self.server is None:
            self.server = right[0].participant
        if action not in self._actions:
            self._actions[action] = ActionClient(
                self._participant, self._types, names, action.value, framed=is_framed(right[0])
            )

    def _check_alone(self, topic: str, servers: list[Endpoint]) -> None:
        count = len({one.participant for one in servers})
        if count > 1:
            text = f"{count} nodes serve {topic}, and each drives what is sent; end all but one of them"
            self._sensing.fault(topic, text)
        else:
            self._sensing.faults.pop(topic, None)

    def _reads_goals(self, action: RosAction, topic: str, server: Endpoint) -> bool:
        """Return whether a server's goals have the layout of those sent; otherwise record a fault."""
        type_hash, types = server.type_hash, self._types
        if type_hash is None or type_hash == types.goal_hash(action.value):
            self._other_goals.pop(action, None)
            return True
        if self._other_goals.get(action) != type_hash:
            self._other_goals[action] = type_hash
            named = " or ".join(types.distributions_of(action.value, type_hash)) or "none that is known"
            text = f"{topic} has the {action.value} of {named}, and distribution is {types.distribution!r}"
            self._sensing.faults.pop(topic, None)
            self._sensing.fault(topic, f"{text}; correct that, or give the robot a link of its own")
        return False

    def _connect_topic(self, setting: str, known: tuple[str, ...], offers: Offers) -> None:
        listeners = self._listeners(setting, offers)
        types = [name for name in map(type_from_dds, (one.type_name for one in listeners)) if name in known]
        if not types:
            self._listened_to.discard(setting)
            return
        if setting not in self._writers or self._writers[setting][0] != types[0]:
            self._write_to(setting, str(types[0]))
        self._listened_to.add(setting)

    def _listeners(self, setting: str, offers: Offers) -> list[Endpoint]:
        return offers.get((topic_to_dds(self._topic(setting)), True), [])

    def _write_to(self, setting: str, type_name: str) -> None:
        latched = setting in messages.LATCHED
        quality = Quality(latched=latched, depth=1 if latched else 10)
        topic = topic_to_dds(self._topic(setting))
        self._writers[setting] = (
            type_name,
            self._participant.writer(topic, type_to_dds(type_name), quality),
        )

    def _publish(self, setting: str, message: Any) -> None:
        if setting in self._writers:
            type_name, writer = self._writers[setting]
            writer.write(self._types.encode(type_name, message))

    def _poll_action(
        self, action: RosAction, client: ActionClient, tasks: Tasks, now: float, refuse: Refuse
    ) -> list[Any]:
        effects: list[Any] = []
        for reply in client.send.replies(refuse):
            tasks.goal_answered(action, bool(reply.accepted), now)
        for reply in client.cancel.replies(refuse):
            tasks.cancel_answered(action, int(reply.return_code))
        for reply in client.results():
            code, text = getattr(reply, "error_code", None), getattr(reply, "error_msg", None)
            tasks.result_came(action, int(reply.status), code, text, missed_of(reply))
        for array in client.statuses(refuse):
            known: Statuses = statuses_of(array)
            if GoalStatus.EXECUTING not in known.values():
                self.feedback = None
            effects += tasks.statuses_came(action, known, now)
        feedback = client.newest_feedback(refuse)
        if feedback is not None and tasks.is_busy:
            self.feedback = feedback_text(feedback[1])
        return effects


def _refuse(fault: Callable[[str, str], None], what: str, who: str, error: FaultError) -> None:
    fault(what, f"{who}: {error}")


# --- The adapter of ROS 2 robots: discovers and controls them in one loop ---

EVERY = 0.02
"""seconds between polls of received messages."""
MEET_EVERY = 0.2
"""seconds between polls of the discovered endpoints."""


class Ros2Adapter(RosAdapter[Offers]):
    """Robots of one DDS domain."""

    kind: ClassVar[str] = "ros2"

    def __init__(self, settings: Ros2Settings, state: Path) -> None:
        super().__init__(settings, RobotNotes(state))
        self._settings = settings

    async def run(self, link: Link) -> None:
        """Control the robots of the network until cancelled."""
        settings = self._settings
        try:
            types = Interfaces(settings.distribution)
            participant = Participant(settings.dds(link.settings.folder))
        except RosError as error:
            raise LinkError(f"{link.settings.file}: ros2: {error}") from None
        outgoing = messages.Outgoing(types, link.frame, settings.map_frame)
        grids = Grids(types.encode, outgoing, settings.map_resolution_m)
        masks = Masks(types.encode, outgoing, settings.map_resolution_m, link)

        def make(name: str) -> RosRobot[Offers]:
            sensing = Sensing(name, settings, link.frame)
            listening = DdsSubscriptions(sensing, participant, types)
            acting = DdsActions(name, settings, participant, types, outgoing, sensing)
            return RosRobot(name, settings, link, sensing, listening, acting, grids, masks)

        for name in settings.robots:
            self._meet(name, make)
        meet_at = 0.0
        changed = False
        while True:
            now = time.monotonic()
            changed |= participant.discover()
            if changed and now >= meet_at:
                meet_at, changed = now + MEET_EVERY, False
                offers: Offers = by_topic(participant.endpoints)
                offered = [topic_from_dds(topic) for topic, wants in offers if not wants]
                servers = {server_from_dds(topic) for topic, wants in offers if wants}
                topics = [topic for topic in offered if topic is not None]
                self._find(topics, {one for one in servers if one is not None}, offers, make, now)
            self._step(now)
            self._report(link)
            await asyncio.sleep(max(0.001, EVERY - (time.monotonic() - now)))


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter with them.

    :raises LinkError: for settings that cannot be used.
    :raises ModuleNotFoundError: for a package that is missing.
    """
    for package in PACKAGES:
        if find_spec(package) is None:
            raise ModuleNotFoundError(name=package)
    settings, table = read_settings(file, "ros2", Ros2Settings)
    check(settings, table)
    return settings, Ros2Adapter(table, settings.state_folder / f"{settings.name}.servers")
