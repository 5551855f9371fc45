"""Adapter of robots behind a rosbridge server: reads their topics, calls their actions and services."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import ClassVar

import msgspec

from ...core.messages.robots import SendGPS, SendPos, SetPath, SetPosEnd, SetPosIni
from ..base.adapter import Adapter, Command, Link
from ..base.errors import CommandRefusedError
from ..base.settings import LinkSettings, read_settings
from ..ros.adapter import RobotNotes, RosAdapter
from ..ros.effects import Abilities, CancelGoals, Effect, PublishTask, RosAction, SendGoal
from ..ros.errors import FaultError
from ..ros.messages import ACTIONS, CANCEL_GOAL, GET_MAP, LATCHED, SERVICES, TWIST, WRITTEN, Outgoing, Pose
from ..ros.robot import RosRobot
from ..ros.sensing import Sensing
from ..ros.site_maps import Grids, Masks
from ..ros.tasks import Tasks
from .connection import (
    MAPS_PATIENCE_S,
    Answer,
    Inbox,
    JsonMessages,
    RosbridgeConnection,
    Subscription,
    encode,
)
from .decoding import ServiceResponse, convert
from .goals import ActionGoals, GoalStore
from .graph import Graph, GraphWatch
from .messages import READABLE, CancelReply, TriggerReply
from .settings import RosbridgeSettings, Server, check, server_of

# --- Subscriptions to one robot's topics over rosbridge ---


@dataclass
class _Subscription:
    """A subscribed topic."""

    topic: str
    type_name: str
    inbox: Inbox


class RosbridgeSubscriptions:
    """Reads a robot's topics while they exist, and passes their messages to its sensing."""

    def __init__(
        self, sensing: Sensing, settings: RosbridgeSettings, connection: RosbridgeConnection
    ) -> None:
        self._sensing = sensing
        self._settings = settings
        self._connection = connection
        self._subscriptions: dict[str, _Subscription] = {}
        self._camera: tuple[str, str] | None = None
        """The topic of its images, and its type."""

    def connect(self, network: Graph) -> None:
        """Subscribe to the topics present under the robot's names; again for those with another type."""
        for kind, topic in self._sensing.topics().items():
            declared = network.topics.get(topic)
            if kind == "image":
                self._camera = None if declared is None else (topic, declared)
                continue
            known = self._subscriptions.get(kind)
            if declared is None or (known is not None and known.type_name == declared):
                # A missing topic stays subscribed: the server sends it as soon as it is back.
                continue
            self._read(kind, topic, declared)

    def poll(self) -> SendPos | SendGPS | None:
        """Process received messages; return the robot's newest position, or None."""
        self._watch()
        newest: SendPos | SendGPS | None = None
        for kind, subscription in list(self._subscriptions.items()):
            for content in subscription.inbox.drain():
                where = f"{subscription.topic} ({subscription.type_name})"
                try:
                    message = convert(content, READABLE[subscription.type_name], where)
                except FaultError as error:
                    self._sensing.refuse(subscription.topic, error)
                else:
                    newest = (
                        self._sensing.receive(kind, subscription.topic, subscription.type_name, message)
                        or newest
                    )
        return newest

    def _watch(self) -> None:
        """Subscribe to images only while one is awaited: a camera sends more than a network should carry."""
        if self._camera is not None and self._sensing.wants_image:
            if "image" not in self._subscriptions:
                self._read("image", *self._camera)
        elif (subscription := self._subscriptions.pop("image", None)) is not None:
            self._connection.unsubscribe(subscription.topic)

    def _read(self, kind: str, topic: str, declared: str) -> None:
        """Subscribe to a topic whose type rosapi has reported."""
        if self._subscriptions.pop(kind, None) is not None:
            self._connection.unsubscribe(topic)
        type_name = self._sensing.check_type(kind, topic, declared, declared)
        if type_name is not None:
            if kind != "image":
                self._sensing.faults.pop(topic, None)
            inbox = self._connection.subscribe(topic, self._subscription_of(kind, type_name))
            self._subscriptions[kind] = _Subscription(topic, type_name, inbox)

    def _subscription_of(self, kind: str, type_name: str) -> Subscription:
        own = self._settings
        if kind in ("tf", "tf_static"):
            # Each message has other frames: none may be skipped.
            return Subscription(type_name, compression=own.compression)
        return Subscription(type_name, own.throttle_ms, own.queue_length, own.compression)


# --- Commands to one robot over rosbridge: its actions, services and topics ---

log = logging.getLogger(__name__)

MOST_ANSWERS = 1000
"""answers of services that wait to be read."""


class RosbridgeActions:
    """Commands one robot. ``server`` changes when its action servers have restarted.

    What is large goes over ``maps``, a connection of its own: no stop has to wait for the end of a map.
    """

    def __init__(
        self,
        robot: str,
        settings: RosbridgeSettings,
        connection: RosbridgeConnection,
        maps: RosbridgeConnection,
        outgoing: Outgoing,
        goals: ActionGoals,
    ) -> None:
        self._robot = robot
        self._patterns = settings.patterns
        self._connection = connection
        self._maps = maps
        self._outgoing = outgoing
        self._goals = goals
        self._services: set[str] = set()
        self._listened_to: set[str] = set()
        self._types: dict[str, str] = {}
        self._answers: deque[tuple[str, RosAction | None, ServiceResponse]] = deque(maxlen=MOST_ANSWERS)
        self.server: bytes | None = None

    @property
    def feedback(self) -> str | None:
        """The progress of its goal."""
        return self._goals.feedback

    def forget_feedback(self) -> None:
        """Forget the progress of its goal."""
        self._goals.forget_feedback()

    @property
    def written(self) -> list[str]:
        """The topics whose subscribers are counted."""
        return [self._topic(setting) for setting in WRITTEN if setting in self._patterns]

    def connect(self, network: Graph) -> None:
        """Connect to the present servers and subscribers."""
        for action, setting in ACTIONS.items():
            if setting in self._patterns:
                self._goals.meet(action, self._topic(setting), network)
        self.server = self._goals.server
        for setting in SERVICES:
            if setting in self._patterns:
                there = self._topic(setting) in network.services
                (self._services.add if there else self._services.discard)(setting)
        for setting, known in WRITTEN.items():
            if setting in self._patterns:
                self._meet_listeners(setting, known, network)

    @property
    def abilities(self) -> Abilities:
        """The robot's abilities, by the servers present at the last read of the network."""
        return Abilities(
            self._goals.actions,
            goal_topic="goal_pose" in self._listened_to,
            path_topic="path" in self._listened_to,
            velocity="cmd_vel" in self._listened_to,
            stop_service="stop" in self._services,
            cone_service="place_cone" in self._services,
        )

    def hears(self, setting: str) -> bool:
        """Return whether the topic of a setting has subscribers."""
        return setting in self._listened_to

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        """Process messages of servers; return the effects."""
        effects = self._goals.poll(tasks, now, fault)
        while self._answers:
            what, action, came = self._answers.popleft()
            try:
                effects += self._answered(what, action, came, tasks)
            except FaultError as error:
                fault(what, str(error))
        return effects

    def send_goal(self, request: SendGoal, here: Pose | None) -> None:
        """Send a goal; ``here`` is the robot's pose. Raises ValueError if it cannot be converted."""
        self._goals.send(request, self._outgoing.goal(request.action, request.task, here))

    def ask_result(self, request: SendGoal) -> None:
        """Do nothing: rosbridge sends the result to the sender of the goal."""

    def cancel(self, request: CancelGoals) -> None:
        """Cancel goals."""
        cancelled = self._goals.cancel(request)
        if cancelled is None:
            return
        answered = self._keeper("cancel" if request.goal_id is None else "cancel one", request.action)
        topic = self._topic(ACTIONS[request.action])
        self._connection.call(f"{topic}/_action/cancel_goal", cancelled, answered, urgent=True)

    def call(self, setting: str) -> None:
        """Call a service of type Trigger."""
        if setting in self._services:
            self._connection.call(self._topic(setting), {}, self._keeper(setting), urgent=True)

    def publish_task(self, request: PublishTask, here: Pose | None) -> None:
        """Publish a target or a path; raises ValueError if it cannot be converted."""
        if isinstance(request.task, SetPath):
            self._publish("path", self._outgoing.path(request.task))
        else:
            self.publish_target(request.task, here)

    def publish_target(self, target: SetPosEnd, here: Pose | None) -> None:
        """Publish a target."""
        self._publish("goal_pose", self._outgoing.goal(RosAction.TO_POSE, target, here)["pose"])

    def publish_zero(self) -> None:
        """Publish speed 0, with or without a time stamp as its subscribers expect."""
        twist = {"linear": {"x": 0.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}
        self._publish("cmd_vel", twist if self._types.get("cmd_vel") == TWIST else {"twist": twist})

    def publish_start(self, start: SetPosIni, here: Pose | None) -> None:
        """Publish the robot's initial pose."""
        self._publish("initial_pose", self._outgoing.start(start, here))

    def publish_latched(self, setting: str, message: bytes) -> None:
        """Publish an encoded message on a topic of LATCHED: later subscribers receive it, too."""
        topic = self._topic(setting)
        self._maps.advertise(topic, LATCHED[setting], latched=True)
        self._maps.publish(topic, msgspec.Raw(message), latched=True)

    def serve_map(self, grid: bytes) -> None:
        """Answer the service ``get_map`` with an encoded map."""
        reply = msgspec.Raw(b'{"map":' + grid + b"}")
        self._maps.serve(self._topic("get_map"), GET_MAP, reply)

    def _topic(self, setting: str) -> str:
        return self._patterns[setting].topic_of(self._robot)

    def _meet_listeners(self, setting: str, known: tuple[str, ...], network: Graph) -> None:
        topic = self._topic(setting)
        type_name = network.topics.get(topic)
        if type_name not in known or not network.listeners.get(topic):
            self._listened_to.discard(setting)
            return
        self._listened_to.add(setting)
        if self._types.get(setting) != type_name:
            self._types[setting] = type_name
            self._connection.advertise(topic, type_name)

    def _publish(self, setting: str, message: object) -> None:
        if setting in self._listened_to:
            self._connection.publish(self._topic(setting), message, urgent=True)

    def _keeper(self, what: str, action: RosAction | None = None) -> Callable[[Answer], None]:
        return partial(self._keep, what, action)

    def _keep(self, what: str, action: RosAction | None, came: Answer) -> None:
        if isinstance(came, ServiceResponse):
            self._answers.append((what, action, came))

    def _answered(
        self, what: str, action: RosAction | None, came: ServiceResponse, tasks: Tasks
    ) -> list[Effect]:
        """Process a service's answer; a failed call has a text instead of values."""
        if action is not None:
            if not came.result:
                raise FaultError(f"its {CANCEL_GOAL} of {action.value} failed: {str(came.values)[:200]}")
            reply = convert(came.values, CancelReply, f"its {CANCEL_GOAL} of {action.value}")
            if what == "cancel":
                tasks.cancel_answered(action, reply.return_code)
            return []
        answer = TriggerReply(False, str(came.values)[:200])
        if came.result:
            answer = convert(came.values, TriggerReply, f"its service {what}")
        if what == "stop":
            tasks.stop_answered(answer.success, answer.message)
            return []
        return tasks.cone_answered(answer.success, answer.message)


# --- The adapter of ROS 2 robots behind a rosbridge server: discovers and controls them in one loop

EVERY = 0.02
"""seconds between polls of received messages."""


class RosbridgeAdapter(RosAdapter[Graph]):
    """The robots behind one rosbridge server; ``file`` stores the goals that it has sent."""

    kind: ClassVar[str] = "rosbridge"

    def __init__(self, settings: RosbridgeSettings, server: Server, file: Path) -> None:
        super().__init__(settings, RobotNotes(file), keeps_servers=False)
        self._settings = settings
        self._connection = RosbridgeConnection(server)
        self._maps = RosbridgeConnection(server, MAPS_PATIENCE_S)
        self._watch = GraphWatch(self._connection, self)
        self._books = self._notes.read(GoalStore.from_json)
        self._acting: list[RosbridgeActions] = []
        self._goals: list[ActionGoals] = []

    async def run(self, link: Link) -> None:
        """Control the robots behind the server until cancelled."""
        work = (self._connection.run(), self._maps.run(), self._watch.run(), self._lead_all(link))
        tasks = [asyncio.create_task(one) for one in work]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def command(self, command: Command) -> None:
        """Have a robot accept a command."""
        if self._connection.away is not None:
            raise CommandRefusedError(self._connection.away)
        await super().command(command)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Stop a robot; without a connection the stop is sent as soon as the server is back."""
        try:
            await super().stop(robot, emergency=emergency)
        except CommandRefusedError as error:
            away = self._connection.away
            raise CommandRefusedError(f"{error}; {away}" if away else str(error)) from None

    async def _lead_all(self, link: Link) -> None:
        settings = self._settings
        outgoing = Outgoing(JsonMessages(settings.distribution), link.frame, settings.map_frame)
        grids = Grids(encode, outgoing, settings.map_resolution_m)
        masks = Masks(encode, outgoing, settings.map_resolution_m, link)

        def make(name: str) -> RosRobot[Graph]:
            sensing = Sensing(name, settings, link.frame)
            goals = ActionGoals(name, self._connection, self._store(name), self)
            acting = RosbridgeActions(name, settings, self._connection, self._maps, outgoing, goals)
            self._acting.append(acting)
            self._goals.append(goals)
            listening = RosbridgeSubscriptions(sensing, settings, self._connection)
            return RosRobot(name, settings, link, sensing, listening, acting, grids, masks)

        for name in settings.robots:
            self._meet(name, make)
        looks = 0
        while True:
            now = time.monotonic()
            if self._watch.looks != looks:
                looks = self._watch.looks
                known = len(self._robots)
                graph = self._watch.graph
                self._find(list(graph.topics), graph.actions | graph.services, graph, make, now)
                if len(self._robots) > known:
                    self._watch.request_read()
            self._step(now)
            self._report(link)
            await asyncio.sleep(max(0.001, EVERY - (time.monotonic() - now)))

    def _network_faults(self) -> list[str]:
        # Without a server both connections say the same.
        faults = dict.fromkeys((*self._connection.faults, *self._maps.faults))
        return [*faults, *([self._watch.fault] if self._watch.fault else [])]

    @property
    def written_topics(self) -> list[str]:
        """The topics of its robots whose subscribers are counted."""
        return [topic for acting in self._acting for topic in acting.written]

    @property
    def watched_topics(self) -> list[str]:
        """The topics of its robots whose publishers are counted."""
        return [topic for goals in self._goals for topic in goals.watched]

    def _store(self, robot: str) -> GoalStore:
        return self._books.setdefault(robot, GoalStore())

    def note_goals(self) -> None:
        """Store the open goals, so that the next process of this link sends none of them twice."""
        noted = {robot: rows for robot, store in self._books.items() if (rows := store.to_json())}
        self._notes.write(noted)


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter with them; raises LinkError."""
    settings, own = read_settings(file, "rosbridge", RosbridgeSettings)
    check(settings, own)
    state = settings.state_folder / f"{settings.name}.goals"
    return settings, RosbridgeAdapter(own, server_of(settings, own), state)
