"""Tasks of one robot as goals of actions, and how a robot is stopped."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ...core.messages.robots import SetPath, SetPosEnd
from .effects import (
    PATH_ACTIONS,
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
from .goals import (
    ACTIVE,
    ENDED,
    GoalStatus,
    Statuses,
    failure_of,
    goal_id,
    is_for_cone,
    message_of,
    missed_text,
)

# --- The stop of a ROS 2 robot: messages, repetition, and confirmation; no I/O ---
# A stop is three things at once, repeated until they are answered: all goals of its action servers are
# canceled, from any client; speed 0 is published; its stop service is called if it has one.

ASK_AGAIN = 0.5
"""seconds after which goals are canceled, and the service called, again."""
TWIST_EVERY = 0.1
"""seconds between messages of speed 0."""
LONGEST = 5.0
"""seconds after which an unanswered stop is refused, so that operators see it."""
ASK_SELDOM = 2.0
"""seconds between attempts after that."""
STANDING = 0.05
"""m/s below which a robot stands."""

REJECTED = 1
"""action_msgs/CancelGoal: ERROR_REJECTED."""


class Stop:
    """One stop of one robot, from the first Abort to its end."""

    def __init__(self, now: float) -> None:
        self._began = now
        self._ask_at = self._twist_at = now
        self._canceled: set[RosAction] = set()
        self._stopped_by_service = False
        self._stood = 0
        self._service_reply = ""
        self.is_over = False
        self.is_refused = False

    def restart(self, now: float) -> None:
        """Give an unanswered stop as much time again."""
        self._began, self._ask_at, self.is_refused = now, now, False

    def cancel_answered(self, action: RosAction, code: int, statuses: Statuses) -> None:
        """Process an action server's answer to canceling all goals; ``statuses`` are its goals'."""
        busy = any(status in ACTIVE and status != GoalStatus.CANCELING for status in statuses.values())
        if code != REJECTED or not busy:
            self._canceled.add(action)

    def stop_answered(self, success: bool, text: str) -> None:
        """Process the answer of the stop service."""
        self._stopped_by_service |= success
        self._service_reply = text

    def seen(self, speed: float | None) -> None:
        """Record the robot's speed, m/s; None if its positions have none."""
        self._stood = self._stood + 1 if speed is not None and abs(speed) <= STANDING else 0

    def step(self, abilities: Abilities, goals: Mapping[RosAction, Statuses], now: float) -> list[Effect]:
        """Return the effects due now; ``goals`` are those of each action server."""
        missing = self._missing(abilities, goals)
        if not missing:
            return self._end()
        effects: list[Effect] = []
        if now >= self._twist_at and abilities.velocity and not self.is_refused:
            self._twist_at = now + TWIST_EVERY
            effects.append(ZeroTwist())
        if now >= self._ask_at:
            self._ask_at = now + (ASK_SELDOM if self.is_refused else ASK_AGAIN)
            effects += [CancelGoals(action) for action in sorted(abilities.actions)]
            effects += [CallStop()] * (abilities.stop_service and not self._stopped_by_service)
            effects += [PublishHere()] * abilities.goal_topic
        if now - self._began >= LONGEST and not self.is_refused:
            effects += self._refuse(missing)
        return effects

    def _missing(self, abilities: Abilities, goals: Mapping[RosAction, Statuses]) -> list[str]:
        """Return the missing answers as texts."""
        missing = []
        for action in sorted(abilities.actions):
            active = any(status in ACTIVE for status in goals.get(action, {}).values())
            if action not in self._canceled:
                missing.append(f"its server of {action.value} does not answer")
            elif active:
                missing.append(f"its server of {action.value} still has a goal")
        if abilities.stop_service and not self._stopped_by_service:
            reply = f", it said {self._service_reply[:120]!r}" if self._service_reply else ""
            missing.append(f"its stop service did not confirm{reply}")
        if not abilities.actions and not abilities.stop_service and self._stood < 2:
            sent = "it was sent speed 0" if abilities.velocity else "nobody listens there to any stop"
            missing.append(f"{sent}, and it is not seen to stand")
        return missing

    def _end(self) -> list[Effect]:
        self.is_over = True
        return [Remark("it answered the stop after all")] if self.is_refused else [StopEnded()]

    def _refuse(self, missing: list[str]) -> list[Effect]:
        self.is_refused = True
        what = "; ".join(missing)
        return [StopEnded(f"the stop was not confirmed within {LONGEST:g} s: {what}. Stop it on site")]


# --- The tasks of one robot: from the gateway's message to a Nav2 goal, its end, or a stop; no I/O ---
# Times are passed in, in seconds of a steady clock. Actions are returned as effects.

ACCEPTED_WITHIN = 5.0
"""seconds for an action server to accept or refuse a goal."""
REJECTED_FOR = 0.3
"""seconds after which a goal reported as rejected, and on no status topic, counts as rejected."""
ENDED_WITHIN = 2.0
"""seconds for the previous goal to end, when the next one goes to another action server."""
FOUND_WITHIN = 2.0
"""seconds for the other action servers of a robot to report their goals."""
DETAILS_WITHIN = 2.0
"""seconds for the result of a failed goal, which has the reason."""
CONE_WITHIN = 60.0
"""seconds for a cone to be placed or picked up."""
MOST_GIVEN_UP = 100
"""abandoned goals that servers may still accept."""

_TOO_LATE = "the link stood still for longer than it holds a command."
_CONE_UNKNOWN = (
    "the robot came there while this link was away, and nobody knows whether its cone was handled: look there"
)
_NO_PATHS = (
    "nobody on the robot's side follows paths: no server of FollowPath, NavigateThroughPoses or "
    "FollowWaypoints that the settings allow, nobody listens to its path topic. Are its nodes running?"
)
_NO_TARGETS = (
    "nobody on the robot's side drives to targets: no server of NavigateToPose, nobody listens to its goal "
    "topic. Are its nodes running?"
)


@dataclass(frozen=True)
class RosTask:
    """The task of ``message``, as a goal or on a topic, with its progress."""

    message: int
    order: SetPosEnd | SetPath | None
    goal: bytes
    action: RosAction | None
    sent_at: float | None = None
    taken: bool = False
    rejected_at: float | None = None
    failed_at: float | None = None
    ended: GoalStatus = GoalStatus.UNKNOWN
    failure: str = ""
    """Why it has failed, from its result; empty before that has arrived."""
    cone_at: float | None = None
    has_result: bool = False
    succeeded_at: float | None = None
    """When its server reported success, if only the result shows whether all points were reached."""


@dataclass(frozen=True)
class _Held:
    """An order without a server or subscriber yet, and the time at which it is refused."""

    message: int
    order: SetPosEnd | SetPath
    again: bool
    until: float


@dataclass(frozen=True)
class _Former:
    """The newest ended goal of an earlier process, reported at ``at`` unless another is active."""

    message: int
    status: GoalStatus
    at: float
    cone: bool = False


class Tasks:
    """Decides the messages to one robot.

    ``cones`` is whether the settings name a service for cones; a path goes to the first of ``path_actions``
    present. An order without a server or subscriber is held for ``hold_s`` seconds.
    """

    def __init__(
        self, *, cones: bool, path_actions: Sequence[RosAction] = PATH_ACTIONS, hold_s: float = 0.0
    ) -> None:
        self._cones = cones
        self._path_actions = path_actions
        self._hold_s = hold_s
        self._held: _Held | None = None
        self._task: RosTask | None = None
        self._waiting: RosTask | None = None
        """The task to be sent when the previous one, or a stop, has ended."""
        self._wait_until = 0.0
        self._stop: Stop | None = None
        self._goals: dict[RosAction, dict[bytes, GoalStatus]] = {}
        self._given_up: dict[bytes, bool] = {}
        """Sent goals that must no longer be driven, and whether a stop ended them: a server may receive the
        cancel before the goal."""
        self._cancel_late_at = 0.0
        self._former: _Former | None = None
        self._unanswered: Counter[RosAction] = Counter()
        """Unanswered requests to cancel all goals: a late one would cancel the next goal."""
        self._settled_at = 0.0

    @property
    def is_busy(self) -> bool:
        """Whether the robot has a task, or is being stopped."""
        waits = self._waiting is not None or self._held is not None
        return self._task is not None or waits or self._stop is not None

    @property
    def is_only_held(self) -> bool:
        """Whether an order waits for a server, and no server has one."""
        return self._held is not None and self._task is None and self._waiting is None

    @property
    def goal(self) -> bytes | None:
        """The id of the robot's goal, or None."""
        return self._task.goal if self._task is not None else None

    def order(
        self,
        message: int,
        order: SetPosEnd | SetPath,
        abilities: Abilities,
        now: float,
        *,
        again: bool = False,
    ) -> list[Effect]:
        """Begin a task; it replaces the previous one.

        ``again``: an earlier process may have begun it, so an existing goal of this message is the same one.
        """
        if self._task is not None and self._task.message == message and again:
            return [Answered(message)] if self._task.taken else []
        effects = self._end_held("another task came before it was begun")
        refusal = self._refusal(order, abilities)
        if refusal is not None and self._hold_s > 0.0:
            self._held = _Held(message, order, again, now + self._hold_s)
            return effects
        if refusal is not None:
            return [*effects, Answered(message, refusal)]
        if self._waiting is not None:
            effects.append(_refused(self._waiting, "another task came before it was begun"))
        cone = bool(order.cone or order.collect)
        task = RosTask(message, order, goal_id(message, cone=cone), self._action_for(order, abilities))
        known = self._known(task)
        if known is not None and again:
            self._task = replace(task, sent_at=now)
            return [*effects, *self._judge(self._task, known, now)]
        if known is not None:
            # Ids restart with another database: this goal was for another message.
            task = replace(task, goal=goal_id(message, 1 + int(now * 1000) % (2**32 - 1), cone=cone))
        self._given_up.pop(task.goal, None)
        self._waiting, self._wait_until = task, now + ENDED_WITHIN
        return [*effects, *self._leave(task, now), *self.step(abilities, now)]

    def abort(self, abilities: Abilities, now: float) -> list[Effect]:
        """Stop the robot, whatever its task and its client."""
        effects = self._end_held("it was aborted before it was begun")
        if self._waiting is not None:
            effects.append(_refused(self._waiting, "it was aborted before it was begun"))
        self._give_up(self._task, now, stopped=True)
        self._task = self._waiting = None
        if self._stop is None:
            self._stop = Stop(now)
        elif self._stop.is_refused:
            self._stop.restart(now)
        return [*effects, *self.step(abilities, now)]

    def withdraw(self, message: int, now: float) -> list[Effect]:
        """Drop an order that was not accepted yet: nobody waits for it any more."""
        if self._held is not None and self._held.message == message:
            self._held = None
        if self._waiting is not None and self._waiting.message == message:
            self._waiting = None
        task = self._task
        if task is None or task.message != message or task.taken or task.action is None:
            return []
        self._give_up(task, now, stopped=True)
        self._task = None
        return [CancelGoals(task.action, task.goal)]

    def goal_answered(self, action: RosAction, accepted: bool, now: float) -> None:
        """Process a reply to ``send_goal``, maybe to another client: the status topic decides."""
        task = self._task
        if task is not None and task.action == action and not task.taken and not accepted:
            self._task = replace(task, rejected_at=now)

    def statuses_came(self, action: RosAction, statuses: Statuses, now: float) -> list[Effect]:
        """Process the goals on the status topic of an action server."""
        is_first = action not in self._goals
        self._goals[action] = dict(statuses)
        if self._task is None and self._stop is None and self._waiting is None:
            self._adopt(action, statuses, now)
        if is_first:
            self._find_former(statuses, now)
        task = self._task
        status = statuses.get(task.goal) if task is not None else None
        if task is None or status is None or task.action != action:
            return []
        return self._judge(task, status, now)

    def _judge(self, task: RosTask, status: GoalStatus, now: float) -> list[Effect]:
        effects = self._accept(task) if not task.taken and status != GoalStatus.UNKNOWN else []
        task = self._task or task
        if status == GoalStatus.SUCCEEDED:
            effects += self._succeed(now)
        elif status in (GoalStatus.ABORTED, GoalStatus.CANCELED) and task.failed_at is None:
            self._task = replace(task, failed_at=now, ended=status)
        return effects

    def result_came(
        self,
        action: RosAction,
        status: int,
        error_code: int | None,
        text: str | None,
        missed: Sequence[int] = (),
    ) -> None:
        """Process a reply to ``get_result``: why a goal has failed, or which points it has missed."""
        task = self._task
        if task is None or task.action != action:
            return
        if status in (GoalStatus.ABORTED, GoalStatus.CANCELED):
            self._task = replace(task, failure=failure_of(GoalStatus(status), error_code, text))
        elif status == GoalStatus.SUCCEEDED and action is RosAction.WAYPOINTS:
            self._task = replace(task, failure=missed_text(missed) if missed else "", has_result=True)

    def cone_answered(self, success: bool, text: str) -> list[Effect]:
        """Process the answer of the service for cones."""
        task, self._task = self._task, None
        if task is None or task.cone_at is None:
            self._task = task
            return []
        if success:
            return [Idle()]
        return [_refused(task, f"it stands there, and its cone service said {text[:120]!r}")]

    def cancel_answered(self, action: RosAction, code: int) -> None:
        """Process an action server's answer to canceling all its goals."""
        self._unanswered[action] = max(0, self._unanswered[action] - 1)
        if self._stop is not None:
            self._stop.cancel_answered(action, code, self._goals.get(action, {}))

    def stop_answered(self, success: bool, text: str) -> None:
        """Process the answer of the stop service."""
        if self._stop is not None:
            self._stop.stop_answered(success, text)

    def seen(self, speed: float | None) -> None:
        """Record the robot's speed, m/s, None if unknown."""
        if self._stop is not None:
            self._stop.seen(speed)

    def forget(self) -> None:
        """Assume that the robot has restarted and forgotten everything; a stop continues.

        A held order continues, too: the robot never had it.
        """
        self._task = self._waiting = self._former = None
        self._goals.clear()
        self._given_up.clear()
        self._unanswered.clear()

    def step(self, abilities: Abilities, now: float) -> list[Effect]:
        """Advance the time: repeat a stop, send the waiting task, drop unanswered ones."""
        held = self._held
        if held is not None:
            refusal = self._refusal(held.order, abilities)
            # Never after its time: this program may have stood still since.
            if refusal is None and now < held.until:
                self._held = None
                return self.order(held.message, held.order, abilities, now, again=held.again)
            if now >= held.until:
                return self._end_held(f"{refusal or _TOO_LATE} It was held for {self._hold_s:g} s")
        if self._former is not None and (self.is_busy or self._active()):
            self._former = None
        late = self._cancel_late(now) if self._stop is None else []
        if self._stop is not None:
            effects = [*late, *self._stop.step(abilities, self._goals, now)]
            self._record_cancels(effects, now)
            if self._stop.is_over:
                self._stop = None
            elif self._stop.is_refused and self._waiting is not None:
                waiting, self._waiting = self._waiting, None
                effects.append(
                    _refused(waiting, "the stop before it was not confirmed; stop the robot on site")
                )
            return effects
        if self._former is not None and now >= self._former.at:
            late += self._end_former(self._former)
        return [*late, *(self._send(abilities, now) if self._waiting is not None else self._overdue(now))]

    def _give_up(self, task: RosTask | None, now: float, *, stopped: bool = False) -> None:
        """Record that the goal of a task, if sent, must not be driven even if accepted later."""
        if task is None or task.action is None or task.sent_at is None:
            return
        self._given_up.pop(task.goal, None)
        self._given_up[task.goal] = stopped
        self._cancel_late_at = now + ASK_AGAIN
        while len(self._given_up) > MOST_GIVEN_UP:
            self._given_up.pop(next(iter(self._given_up)))

    def _cancel_late(self, now: float) -> list[Effect]:
        """Cancel goals accepted after they were dropped; after a stop everything is stopped again."""
        late = [one for one in self._active() if one.goal_id in self._given_up]
        if not late:
            return []
        is_idle = self._task is None and self._waiting is None
        if is_idle and any(self._given_up[one.goal_id] for one in late if one.goal_id is not None):
            self._stop = Stop(now)
            return [Remark("its server has taken on a goal that was aborted before; it is stopped again")]
        if now < self._cancel_late_at:
            return []
        self._cancel_late_at = now + ASK_AGAIN
        return [*late]

    def _record_cancels(self, effects: Sequence[Effect], now: float) -> None:
        everything = [one.action for one in effects if isinstance(one, CancelGoals) and one.goal_id is None]
        if everything:
            self._unanswered.update(everything)
            self._settled_at = now + ENDED_WITHIN

    def _end_held(self, reason: str) -> list[Effect]:
        """Refuse a held order, if there is one."""
        held, self._held = self._held, None
        return [] if held is None else [Answered(held.message, reason)]

    def _action_for(self, order: SetPosEnd | SetPath, abilities: Abilities) -> RosAction | None:
        """Return the action that carries out an order, None if the robot has none for it."""
        actions = self._path_actions if isinstance(order, SetPath) else (RosAction.TO_POSE,)
        return next((action for action in actions if action in abilities.driving), None)

    def _refusal(self, order: SetPosEnd | SetPath, abilities: Abilities) -> str | None:
        if (order.cone or order.collect) and not (self._cones and abilities.cone_service):
            why = "nobody offers its cone service" if self._cones else "the settings name no cone service"
            return f"the robot can place and collect no cones: {why}"
        if self._action_for(order, abilities) is not None:
            return None
        topic_read = abilities.path_topic if isinstance(order, SetPath) else abilities.goal_topic
        return None if topic_read else (_NO_PATHS if isinstance(order, SetPath) else _NO_TARGETS)

    def _leave(self, following: RosTask, now: float) -> list[Effect]:
        """Return the effects that end the previous task, if the action server does not do so by itself."""
        task, self._task = self._task, None
        if task is None or task.action is None or task.action == following.action:
            self._wait_until = 0.0
            return []
        self._give_up(task, now)
        return [CancelGoals(task.action, task.goal)]

    def _send(self, abilities: Abilities, now: float) -> list[Effect]:
        task = self._waiting
        if task is None or task.order is None:
            return []
        if now < self._wait_until and self._active():
            return []
        if now < self._settled_at and any(self._unanswered.values()):
            return []
        self._waiting = None
        if task.action is None:
            self._task = replace(task, sent_at=now, taken=True)
            return [PublishTask(task.order), Answered(task.message)]
        if task.action not in abilities.driving:
            return [_refused(task, f"the robot's server of {task.action.value} has gone")]
        self._task = replace(task, sent_at=now)
        return [SendGoal(task.action, task.goal, task.order, task.message)]

    def _accept(self, task: RosTask) -> list[Effect]:
        self._task = replace(task, taken=True)
        return [Answered(task.message), *[goal for goal in self._active() if goal.goal_id != task.goal]]

    def _active(self) -> list[CancelGoals]:
        """Return the cancel requests of all our active goals."""
        return [
            CancelGoals(action, goal)
            for action, statuses in self._goals.items()
            for goal, status in statuses.items()
            if status in ACTIVE and message_of(goal) is not None
        ]

    def _known(self, task: RosTask) -> GoalStatus | None:
        return self._goals.get(task.action, {}).get(task.goal) if task.action else None

    def _adopt(self, action: RosAction, statuses: Statuses, now: float) -> None:
        """Adopt a goal that this program sent before its restart."""
        for goal, status in statuses.items():
            message = message_of(goal)
            if message is not None and status in ACTIVE and goal not in self._given_up:
                self._task = RosTask(message, None, goal, action, sent_at=now, taken=True)

    def _find_former(self, statuses: Statuses, now: float) -> None:
        """Record a goal of ours that ended before this program began; another server may have a newer."""
        ours = [
            (message, status, is_for_cone(goal))
            for goal, status in statuses.items()
            if (message := message_of(goal)) is not None
        ]
        message, status, cone = max(ours, default=(-1, GoalStatus.UNKNOWN, False))
        is_newer = self._former is None or message > self._former.message
        if status in ENDED and is_newer:
            self._former = _Former(message, status, now + FOUND_WITHIN, cone)

    def _end_former(self, former: _Former) -> list[Effect]:
        self._former = None
        if former.status == GoalStatus.SUCCEEDED and former.cone:
            return [Answered(former.message, _CONE_UNKNOWN), Idle()]
        if former.status == GoalStatus.SUCCEEDED:
            return [Idle()]
        reason = f"{failure_of(former.status, None, None)} while this link was away"
        return [Answered(former.message, reason), Idle()]

    def _succeed(self, now: float) -> list[Effect]:
        task = self._task
        if task is not None and task.action is RosAction.WAYPOINTS and task.order is not None:
            since = now if task.succeeded_at is None else task.succeeded_at
            task = self._task = replace(task, succeeded_at=since)
            if task.failure:
                self._task = None
                return [_refused(task, task.failure), Idle()]
            if not task.has_result and now - since < DETAILS_WITHIN:
                return []
        if task is not None and is_for_cone(task.goal):
            if task.cone_at is not None:
                return []
            self._task = replace(task, cone_at=now)
            return [CallCone()]
        self._task = None
        return [Idle()]

    def _overdue(self, now: float) -> list[Effect]:
        task = self._task
        if task is None or task.sent_at is None:
            return []
        if task.failed_at is not None and (task.failure or now - task.failed_at >= DETAILS_WITHIN):
            self._task = None
            return [_refused(task, task.failure or failure_of(task.ended, None, None)), Idle()]
        if task.succeeded_at is not None and task.cone_at is None:
            return self._succeed(now)
        if task.cone_at is not None and now - task.cone_at >= CONE_WITHIN:
            self._task = None
            return [_refused(task, f"its cone service did not answer within {CONE_WITHIN:g} s")]
        if task.taken or task.action is None:
            return []
        rejected = task.rejected_at is not None and now - task.rejected_at >= REJECTED_FOR
        if not rejected and now - task.sent_at < ACCEPTED_WITHIN:
            return []
        self._give_up(task, now)
        self._task = None
        how = "rejected the goal" if rejected else f"did not answer within {ACCEPTED_WITHIN:g} s"
        reason = f"the robot's server of {task.action.value} {how}"
        # It may have received the goal all the same.
        return [CancelGoals(task.action, task.goal), _refused(task, reason)]


def _refused(task: RosTask, reason: str) -> Answered:
    return Answered(task.message, reason)
