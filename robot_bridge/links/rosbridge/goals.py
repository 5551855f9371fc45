"""Goals of actions over rosbridge: sent, tracked, and stored for the next process."""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

from ..ros.effects import Answered, CancelGoals, Effect, Idle, RosAction, SendGoal
from ..ros.errors import FaultError
from ..ros.goals import ACTIVE, GoalStatus, failure_of, feedback_text, message_of, statuses_of
from ..ros.messages import GOAL_STATUSES, action_type
from ..ros.tasks import Tasks
from .connection import Answer, Inbox, RosbridgeConnection, Subscription
from .decoding import ActionFeedback, ActionResult, convert
from .graph import Graph
from .messages import GoalStatusArray, NavigationFeedback, NavigationResult

# --- Assignment of an action server's goals to the gateway's messages; no I/O ---
# rosbridge lets the server side choose a goal's id, and does not report it. So the known goals are stored
# before one is sent: the new one afterwards is ours. That is stored before sending, and outlives this
# process.

MOST_ENTRIES = 10
"""remembered goals of one robot."""
MOST_BEFORE = 1000
"""remembered earlier goals of others."""


@dataclass
class Entry:
    """A sent goal: ``goal`` is its id here, ``real`` its id on the robot.

    ``doomed``: it must be canceled as soon as that is known. ``was_shown``: an action server has listed it
    over this connection.
    """

    action: RosAction
    goal: bytes
    before: frozenset[bytes]
    real: bytes | None = None
    doomed: bool = False
    is_over: bool = False
    was_shown: bool = field(default=False, compare=False)


class GoalStore:
    """The goals of one robot, the newest last."""

    def __init__(self) -> None:
        self.entries: list[Entry] = []

    def find(self, goal: bytes) -> Entry | None:
        """Return the newest entry of a goal."""
        return next((one for one in reversed(self.entries) if one.goal == goal), None)

    def add(self, action: RosAction, goal: bytes, known: frozenset[bytes]) -> Entry:
        """Record that a goal is about to be sent to a server whose goals are ``known``."""
        for earlier in self.entries:
            # The server has not listed it until now, or was sent a cancel with its own id.
            earlier.is_over |= earlier.action is action and earlier.real is None
        entry = Entry(action, goal, frozenset(sorted(known)[:MOST_BEFORE]))
        self.entries = [*self.entries, entry][-MOST_ENTRIES:]
        return entry

    def forget(self) -> None:
        """Assume that no server knows any goal."""
        self.entries = []

    def translate(
        self, action: RosAction, statuses: Mapping[bytes, GoalStatus]
    ) -> tuple[dict[bytes, GoalStatus], bool]:
        """Return the statuses by the ids used here, and whether a goal was identified."""
        found = self._claim(action, statuses)
        ours = {one.real: one for one in self.entries if one.action is action and one.real is not None}
        translated = {}
        for real, status in statuses.items():
            entry = ours.get(real)
            if entry is not None:
                entry.was_shown = True
                entry.is_over |= status in (GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED)
            translated[real if entry is None else entry.goal] = status
        return translated, found

    def _claim(self, action: RosAction, statuses: Mapping[bytes, GoalStatus]) -> bool:
        """Identify sent goals without a known id among the new ones."""
        claimed = {one.real for one in self.entries}
        found = False
        for entry in self.entries:
            if entry.action is not action or entry.real is not None or entry.is_over:
                continue
            new = [real for real in statuses if real not in entry.before and real not in claimed]
            if new:
                entry.real = new[0]
                claimed.add(new[0])
                found = True
        return found

    def to_json(self) -> list[dict[str, Any]]:
        """Return the goals as JSON values."""
        return [
            {
                "action": one.action.value,
                "goal": one.goal.hex(),
                "real": one.real.hex() if one.real else None,
                "before": [real.hex() for real in sorted(one.before)],
            }
            for one in self.entries
            if not one.is_over
        ]

    @classmethod
    def from_json(cls, rows: Any) -> GoalStore:
        """Return the stored goals; raises ValueError, TypeError or KeyError for invalid data."""
        store = cls()
        for row in rows[-MOST_ENTRIES:]:
            real = bytes.fromhex(row["real"]) if row["real"] is not None else None
            before = frozenset(bytes.fromhex(one) for one in row["before"])
            store.entries.append(Entry(RosAction(row["action"]), bytes.fromhex(row["goal"]), before, real))
        return store


# --- The goals of one robot's action servers over rosbridge: sent, identified on the status topic, lost
# The status topic decides what a goal is, as over DDS; results and feedback, which the server sends to the
# sender of the goal, are details, and stand in where that topic cannot be read.

log = logging.getLogger(__name__)

SETTLED_AFTER = 2.0
"""seconds of a connection until the latched message of each status topic has arrived, if any."""
CANCELED = (GoalStatus.CANCELED, GoalStatus.CANCELING)
MOST_ANSWERS = 1000
LOST = "its goal ended while rosbridge was away, and how is not known; look where it is"
LEFT = "its goal was canceled while rosbridge was away; some servers do that to the goals of who leaves"


class GoalNotes(Protocol):
    """The storage of goals for the next process."""

    def note_goals(self) -> None:
        """Store the open goals."""


class ActionGoals:
    """Sends goals and reports their outcomes; ``notes`` stores them."""

    def __init__(
        self, robot: str, connection: RosbridgeConnection, store: GoalStore, notes: GoalNotes
    ) -> None:
        self._robot = robot
        self._connection = connection
        self._store = store
        self._notes = notes
        self._earlier = {one.goal for one in store.entries}
        """Goals that an earlier process of this link sent."""
        self._topics: dict[RosAction, str] = {}
        self._statuses: dict[RosAction, Inbox] = {}
        self._known: dict[RosAction, dict[bytes, GoalStatus]] = {}
        """The newest status of each goal, by the id on the robot."""
        self._answers: deque[tuple[Entry, Answer]] = deque(maxlen=MOST_ANSWERS)
        self._held: tuple[SendGoal, Any] | None = None
        self._session = 0
        self._since: dict[RosAction, float] = {}
        """When a status topic was first read over this connection."""
        self._sent_in: dict[bytes, int] = {}
        self._seen_over: dict[RosAction, int] = {}
        """The connection over which a server was last seen there."""
        self._gone: set[RosAction] = set()
        self._publishers: dict[RosAction, int] = {}
        """Number of publishers of a status topic at the last count."""
        self._epoch = 0
        self.actions: frozenset[RosAction] = frozenset()
        self.feedback: str | None = None

    @property
    def server(self) -> bytes | None:
        """Identity of the servers with the robot's goals: it changes when servers were seen to restart."""
        return self._epoch.to_bytes(8, "big") if self.actions else None

    def forget_feedback(self) -> None:
        """Forget a goal's progress: its server has restarted."""
        self.feedback = None

    @property
    def watched(self) -> list[str]:
        """The status topics whose publishers must be counted: those of open goals."""
        open_ones = {one.action for one in self._store.entries if not one.is_over}
        return [f"{self._topics[one]}/_action/status" for one in open_ones if one in self._topics]

    def meet(self, action: RosAction, topic: str, network: Graph) -> None:
        """Record whether an action's server is present, and whether it is another one than before."""
        # On a new connection the server may not have discovered the robots yet: no conclusion.
        is_same = self._seen_over.get(action) == network.session
        if topic not in network.actions:
            if is_same:
                self._gone.add(action)
                self.actions -= {action}
            return
        status = f"{topic}/_action/status"
        count = network.publishers.get(status, 0)
        if (action in self._gone or count > self._publishers.get(action, count)) and is_same:
            self._renew()
        self._gone.discard(action)
        if count:
            self._publishers[action] = count
        elif not is_same:
            self._publishers.pop(action, None)
        self._seen_over[action] = network.session
        self.actions |= {action}
        self._topics[action] = topic
        if action not in self._statuses:
            self._statuses[action] = self._connection.subscribe(status, Subscription(GOAL_STATUSES))
        elif not is_same:
            self._connection.renew(status)
        if not is_same:
            self._since[action] = time.monotonic()

    def send(self, request: SendGoal, goal: Any) -> None:
        """Send a goal once the present goals are known; a sent one is not sent again."""
        entry = self._store.find(request.goal_id)
        if entry is None or entry.is_over or entry.doomed:
            self._held = (request, goal)

    def cancel(self, request: CancelGoals) -> dict[str, Any] | None:
        """Return the request to the cancel service, None if it would have no effect."""
        if self._held is not None and request.goal_id in (None, self._held[0].goal_id):
            self._held = None
        if request.goal_id is None:
            return {}
        entry = self._store.find(request.goal_id)
        if entry is None:
            return None
        if entry.real is None:
            entry.doomed = True
            self._connection.cancel_goal(self._id(entry.goal), self._topics[request.action])
            return None
        return {"goal_info": {"goal_id": {"uuid": list(entry.real)}}}

    def poll(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        """Process received messages; return the effects."""
        if self._connection.away is not None:
            return []
        if self._session != self._connection.session:
            self._begin()
        effects: list[Effect] = []
        for action, inbox in self._statuses.items():
            for content in inbox.drain():
                try:
                    status_array = convert(content, GoalStatusArray, f"the status of {action.value}")
                except FaultError as error:
                    fault(action.value, str(error))
                else:
                    effects += self._statuses_came(action, statuses_of(status_array), tasks, now)
        effects += self._read_answers(tasks, now, fault)
        effects += self._missing(tasks, now)
        self._send_held(now)
        return effects

    def _begin(self) -> None:
        """Reset the state for a new connection."""
        self._session = self._connection.session
        self._known.clear()
        self._answers.clear()
        self.feedback = None
        for entry in self._store.entries:
            entry.was_shown = False

    def _renew(self) -> None:
        """Assume that the servers have restarted and know no goal."""
        self._epoch += 1
        self._store.forget()
        self._known.clear()
        self._held = None
        self._notes.note_goals()

    def _statuses_came(
        self, action: RosAction, statuses: dict[bytes, GoalStatus], tasks: Tasks, now: float
    ) -> list[Effect]:
        is_first = action not in self._known
        self._known[action] = statuses
        open_before = [one for one in self._store.entries if one.action is action and not one.is_over]
        translated, was_found = self._store.translate(action, statuses)
        if was_found or any(one.is_over for one in open_before):
            self._notes.note_goals()
        if GoalStatus.EXECUTING not in statuses.values():
            self.feedback = None
        effects: list[Effect] = []
        for entry in open_before:
            status = translated.get(entry.goal, GoalStatus.UNKNOWN)
            if entry.doomed and status in ACTIVE:
                effects.append(CancelGoals(action, entry.goal))
            elif is_first and entry.goal == tasks.goal and status in CANCELED:
                tasks.result_came(action, GoalStatus.CANCELED, None, LEFT)
            if entry.is_over and entry.goal != tasks.goal and entry.goal in self._earlier:
                effects += self._ended(entry, status, LEFT)
        return effects + tasks.statuses_came(action, translated, now)

    def _ended(self, entry: Entry, status: GoalStatus, why: str) -> list[Effect]:
        """Return the effects of the end of a goal of an earlier process."""
        message = message_of(entry.goal)
        if status is GoalStatus.SUCCEEDED or message is None:
            return [Idle()]
        reason = failure_of(status, None, None) if status is GoalStatus.ABORTED else why
        return [Answered(message, reason), Idle()]

    def _missing(self, tasks: Tasks, now: float) -> list[Effect]:
        """Return the effects of goals sent over an earlier connection and missing in all lists."""
        effects: list[Effect] = []
        for entry in self._store.entries:
            sent_now = self._sent_in.get(entry.goal) == self._session
            if entry.is_over or entry.was_shown or sent_now or not self._is_settled(entry.action, now):
                continue
            entry.is_over = True
            self._notes.note_goals()
            if entry.goal == tasks.goal:
                tasks.result_came(entry.action, GoalStatus.ABORTED, None, LOST)
                statuses = {**self._translated(entry.action), entry.goal: GoalStatus.ABORTED}
                effects += tasks.statuses_came(entry.action, statuses, now)
            elif entry.goal in self._earlier:
                effects += self._ended(entry, GoalStatus.UNKNOWN, LOST)
        return effects

    def _is_settled(self, action: RosAction, now: float) -> bool:
        """Return whether a latched status would have arrived by now."""
        is_read = self._seen_over.get(action) == self._session
        return is_read and now - self._since[action] >= SETTLED_AFTER

    def _translated(self, action: RosAction) -> dict[bytes, GoalStatus]:
        return self._store.translate(action, self._known.get(action, {}))[0]

    def _send_held(self, now: float) -> None:
        """Send the waiting goal: a new one afterwards must be distinguished from those before."""
        if self._held is None:
            return
        request, goal = self._held
        if request.action not in self._known and not self._is_settled(request.action, now):
            return
        self._held = None
        entry = self._store.add(
            request.action, request.goal_id, frozenset(self._known.get(request.action, {}))
        )
        self._sent_in[request.goal_id] = self._session
        while len(self._sent_in) > len(self._store.entries):
            self._sent_in.pop(next(iter(self._sent_in)))
        self._notes.note_goals()
        self._connection.send_goal(
            self._id(request.goal_id),
            self._topics[request.action],
            action_type(request.action),
            goal,
            partial(self._keep, entry),
        )

    def _keep(self, entry: Entry, came: Answer) -> None:
        self._answers.append((entry, came))

    def _id(self, goal: bytes) -> str:
        return f"goal:{self._robot}:{goal.hex()}"

    def _read_answers(self, tasks: Tasks, now: float, fault: Callable[[str, str], None]) -> list[Effect]:
        effects: list[Effect] = []
        while self._answers:
            entry, came = self._answers.popleft()
            if entry.goal != tasks.goal:
                continue
            try:
                if isinstance(came, ActionFeedback):
                    feedback = convert(came.values, NavigationFeedback, f"feedback of {entry.action.value}")
                    self.feedback = feedback_text(feedback)
                    effects += self._stand_in(entry, GoalStatus.EXECUTING, tasks, now)
                elif isinstance(came, ActionResult):
                    effects += self._result_came(entry, came, tasks, now)
            except FaultError as error:
                fault(entry.action.value, str(error))
        return effects

    def _result_came(self, entry: Entry, came: ActionResult, tasks: Tasks, now: float) -> list[Effect]:
        ended = (GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED)
        if came.status not in ended or (isinstance(came.values, str) and not entry.was_shown):
            # A text instead of a result: the goal was refused, or could not be sent.
            log.warning("robot %s: %s: %s", self._robot, entry.action.value, str(came.values)[:200])
            entry.is_over = True
            tasks.goal_answered(entry.action, False, now)
            return []
        result = NavigationResult()
        if isinstance(came.values, dict):
            result = convert(came.values, NavigationResult, f"result of {entry.action.value}")
        missed = result.missed_waypoints
        tasks.result_came(entry.action, came.status, result.error_code, result.error_msg, missed)
        return self._stand_in(entry, GoalStatus(came.status), tasks, now)

    def _stand_in(self, entry: Entry, status: GoalStatus, tasks: Tasks, now: float) -> list[Effect]:
        """Take a goal's status from its result or feedback while its status topic does not list it."""
        if entry.was_shown:
            return []
        entry.is_over |= status not in ACTIVE
        return tasks.statuses_came(entry.action, {**self._translated(entry.action), entry.goal: status}, now)
