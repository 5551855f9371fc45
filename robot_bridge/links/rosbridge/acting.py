"""What one robot is told over rosbridge: its actions, its services, its topics."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable
from functools import partial

import msgspec

from ...messages import SetPath, SetPosEnd, SetPosIni
from ..ros.effects import Abilities, Action, CancelGoals, Effect, PublishTask, SendGoal
from ..ros.errors import FaultError
from ..ros.geometry import Outgoing, Pose
from ..ros.tasks import Tasks
from ..ros.types import ACTIONS, CANCEL_GOAL, GET_MAP, LATCHED, SERVICES, TWIST, WRITTEN
from .connection import Answer, RosbridgeConnection
from .decoding import ServiceResponse, convert
from .goals import ActionGoals
from .graph import Graph
from .messages import CancelReply, TriggerReply
from .settings import RosbridgeSettings

log = logging.getLogger(__name__)

MOST_ANSWERS = 1000
"""of services that wait to be read."""


class Acting:
    """Speaks to one robot. ``server`` is another one when its action servers have started anew."""

    def __init__(
        self,
        robot: str,
        settings: RosbridgeSettings,
        connection: RosbridgeConnection,
        outgoing: Outgoing,
        goals: ActionGoals,
    ) -> None:
        self._robot = robot
        self._patterns = settings.patterns
        self._connection = connection
        self._outgoing = outgoing
        self._goals = goals
        self._services: set[str] = set()
        self._wanted: set[str] = set()
        self._types: dict[str, str] = {}
        self._answers: deque[tuple[str, Action | None, ServiceResponse]] = deque(maxlen=MOST_ANSWERS)
        self.server: bytes | None = None

    @property
    def feedback(self) -> str | None:
        """How far its goal is yet."""
        return self._goals.feedback

    @feedback.setter
    def feedback(self, text: str | None) -> None:
        self._goals.feedback = text

    @property
    def written(self) -> list[str]:
        """The topics of which it matters who listens to them."""
        return [self._topic(setting) for setting in WRITTEN if setting in self._patterns]

    def connect(self, network: Graph) -> None:
        """Meet the servers and listeners that are there now."""
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
        """Who of the robot's side was there when the network was last looked at."""
        return Abilities(
            self._goals.actions,
            goal_topic="goal_pose" in self._wanted,
            path_topic="path" in self._wanted,
            velocity="cmd_vel" in self._wanted,
            stop_service="stop" in self._services,
            cone_service="place_cone" in self._services,
        )

    def hears(self, setting: str) -> bool:
        """Tell whether somebody listens to the topic of a setting."""
        return setting in self._wanted

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        """Take in what servers have said; return the effects."""
        effects = self._goals.poll(tasks, now, fault)
        while self._answers:
            what, action, came = self._answers.popleft()
            try:
                effects += self._answered(what, action, came, tasks)
            except FaultError as error:
                fault(what, str(error))
        return effects

    def send_goal(self, asked: SendGoal, here: Pose | None) -> None:
        """Send a goal; ``here`` is where the robot is. Raises ValueError where it has no place there."""
        self._goals.send(asked, self._outgoing.goal(asked.action, asked.task, here))

    def ask_result(self, asked: SendGoal) -> None:
        """Nothing is to be asked: rosbridge tells the result to who sent the goal."""

    def cancel(self, asked: CancelGoals) -> None:
        """Cancel goals."""
        wanted = self._goals.cancel(asked)
        if wanted is None:
            return
        answered = self._note("cancel" if asked.goal_id is None else "cancel one", asked.action)
        topic = self._topic(ACTIONS[asked.action])
        self._connection.call(f"{topic}/_action/cancel_goal", wanted, answered, urgent=True)

    def call(self, setting: str) -> None:
        """Call a service of type Trigger."""
        if setting in self._services:
            self._connection.call(self._topic(setting), {}, self._note(setting), urgent=True)

    def publish_task(self, asked: PublishTask, here: Pose | None) -> None:
        """Publish a target or a path; raises ValueError where it has no place there."""
        if isinstance(asked.task, SetPath):
            self._publish("path", self._outgoing.path(asked.task))
        else:
            self.publish_target(asked.task, here)

    def publish_target(self, target: SetPosEnd, here: Pose | None) -> None:
        """Publish a target."""
        self._publish("goal_pose", self._outgoing.goal(Action.TO_POSE, target, here)["pose"])

    def publish_zero(self) -> None:
        """Publish speed 0, with or without a time as its listeners want it."""
        twist = {"linear": {"x": 0.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}
        self._publish("cmd_vel", twist if self._types.get("cmd_vel") == TWIST else {"twist": twist})

    def publish_start(self, start: SetPosIni, here: Pose | None) -> None:
        """Publish where the robot is to take itself to be."""
        self._publish("initial_pose", self._outgoing.start(start, here))

    def publish_latched(self, setting: str, message: bytes) -> None:
        """Publish what is encoded on a topic of LATCHED: who comes later is told it, too."""
        topic = self._topic(setting)
        self._connection.advertise(topic, LATCHED[setting], latched=True)
        self._connection.publish(topic, msgspec.Raw(message), latched=True)

    def serve_map(self, grid: bytes) -> None:
        """Answer with a map that is encoded who asks for it by the service ``get_map``."""
        reply = msgspec.Raw(b'{"map":' + grid + b"}")
        self._connection.serve(self._topic("get_map"), GET_MAP, reply)

    def _topic(self, setting: str) -> str:
        return self._patterns[setting].topic_of(self._robot)

    def _meet_listeners(self, setting: str, known: tuple[str, ...], network: Graph) -> None:
        topic = self._topic(setting)
        type_name = network.topics.get(topic)
        if type_name not in known or not network.listeners.get(topic):
            self._wanted.discard(setting)
            return
        self._wanted.add(setting)
        if self._types.get(setting) != type_name:
            self._types[setting] = type_name
            self._connection.advertise(topic, type_name)

    def _publish(self, setting: str, message: object) -> None:
        if setting in self._wanted:
            self._connection.publish(self._topic(setting), message, urgent=True)

    def _note(self, what: str, action: Action | None = None) -> Callable[[Answer], None]:
        return partial(self._keep, what, action)

    def _keep(self, what: str, action: Action | None, came: Answer) -> None:
        if isinstance(came, ServiceResponse):
            self._answers.append((what, action, came))

    def _answered(
        self, what: str, action: Action | None, came: ServiceResponse, tasks: Tasks
    ) -> list[Effect]:
        """Take in what a service said; one that could not be called has said a text in place of values."""
        if action is not None:
            if not came.result:
                raise FaultError(f"its {CANCEL_GOAL} of {action.value} failed: {str(came.values)[:200]}")
            reply = convert(came.values, CancelReply, f"its {CANCEL_GOAL} of {action.value}")
            if what == "cancel":
                tasks.cancel_answered(action, reply.return_code)
            return []
        said = TriggerReply(False, str(came.values)[:200])
        if came.result:
            said = convert(came.values, TriggerReply, f"its service {what}")
        if what == "stop":
            tasks.stop_answered(said.success, said.message)
            return []
        return tasks.cone_answered(said.success, said.message)
