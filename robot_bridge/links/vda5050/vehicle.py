"""One vehicle between the gateway and its broker: commands become orders, states become robots' requests.

No I/O and no clock: messages and times are passed in, and effects are collected in order.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ...core.messages.base import MessageError
from ...core.messages.robots import Alive, Request, SendPos, SetPath, SetPosEnd, SetPosIni, Stopped
from .ledger import Effect, Ledger, PositionInit
from .messages import Connection, Factsheet, FreshNames, Inbound, State, VehicleId, Visualization
from .presence import MapFrame, VehiclePresence
from .stopping import StopLimits, StopProcedure
from .tasks import Progress, Remembered, RouteLimits, VehicleTask, begin_plan

ALIVE_EVERY = 1.0
REPEAT_EVERY = 2.0
"""seconds after which an order missing in the vehicle's state is published again; it counts once."""
MOST_RESUMED = 5
"""times that an order forgotten by the vehicle is sent again."""


MOST_SHOWN, CLEAR_EVERY = 20, 30.0
"""ended instant actions that a vehicle of 3.0 may show, and seconds between requests to clear them."""


@dataclass(frozen=True)
class VehicleSettings:
    """Settings for controlling vehicles; times in seconds.

    A command that the vehicle has not accepted within ``accept_within`` is refused. A vehicle silent for
    ``silent_after`` is gone; one with a task is asked for its state every ``poll_every``. It is assumed to
    use ``version`` until it has reported its own.
    """

    route: RouteLimits = field(default_factory=RouteLimits)
    stop: StopLimits = field(default_factory=StopLimits)
    accept_within: float = 8.0
    silent_after: float = 40.0
    poll_every: float = 2.0
    version: str = "2.1.0"


class VehicleController:
    """Controls one vehicle. Call :meth:`advance` several times a second, and :meth:`drain` after every call.

    Times are seconds of a steady clock; ``names`` are for orders and actions.
    """

    def __init__(
        self,
        vehicle: VehicleId,
        settings: VehicleSettings,
        maps: Mapping[str, MapFrame],
        remembered: Remembered | None,
        names: FreshNames,
        now: float,
    ) -> None:
        self.vehicle = vehicle
        self._settings = settings
        self._names = names
        self._ledger = Ledger(remembered or Remembered(), now)
        self._presence = VehiclePresence(maps, settings.silent_after, settings.version)
        self._init = PositionInit(self._ledger, self._presence, names, settings.accept_within)
        self._stop: StopProcedure | None = None
        self._admitted = self._awaits_halt = False
        self._next_alive = self._next_poll = self._next_unpause = self._next_clear = -math.inf
        self._last_status: str | None = None
        self._last_pose: SendPos | None = None
        """The last reported pose, as in the vehicle's message."""

    @property
    def is_known(self) -> bool:
        """Whether the vehicle was heard since the adapter began, and so can be announced to the gateway."""
        return self._presence.state is not None

    def is_there(self, now: float) -> bool:
        """Return whether the vehicle is connected and was heard recently."""
        return self._presence.is_there(now)

    @property
    def version(self) -> str:
        """The version of VDA 5050 used by the vehicle."""
        return self._presence.version

    @property
    def factsheet(self) -> Factsheet | None:
        """The vehicle's factsheet, if received."""
        return self._presence.factsheet

    def drain(self) -> list[Effect]:
        """Return the effects since the last call, in the order of their execution."""
        return self._ledger.drain()

    # --- the gateway ----------------------------------------------------------------------------------

    def set_admitted(self, admitted: bool, now: float) -> None:
        """Record whether the gateway has admitted the vehicle.

        Otherwise nothing is released: the vehicle drives to the end of its base and waits there.
        """
        self._admitted = admitted
        if admitted:
            self._report_pose(now)

    def command(
        self, message: SetPosEnd | SetPath | SetPosIni, command_id: int, now: float, *, again: bool = False
    ) -> None:
        """Accept a command; ``again`` if an earlier process may have begun it."""
        if isinstance(message, SetPosIni):
            self._init.begin(message, command_id, now)
            return
        ledger, task = self._ledger, self._ledger.task
        if again and task is not None and command_id == task.command_id:
            task.confirm(now)
            if task.acknowledged:
                ledger.settle(command_id)
            return
        if again and ledger.has_ended(command_id):
            ledger.settle(command_id)
            return
        if message.cone or message.collect:
            ledger.settle(command_id, "vehicles of VDA 5050 place and collect no cones")
            return
        if task is not None:
            if task.first_sent_at is not None or task.accepted:
                # It may still be on its way, and the vehicle would refuse the next one behind it.
                self._begin_stop(now)
            ledger.drop_task("another task came in its place")
        ledger.begin(VehicleTask(command_id, message, now))
        self._advance_task(now)

    def withdraw(self, command_id: int) -> None:
        """Withdraw a command that nobody waits for any more, if the vehicle has not accepted it."""
        task = self._ledger.task
        if task is not None and task.command_id == command_id and not task.acknowledged:
            self._ledger.refuse_task("it was withdrawn")

    def halt(self, now: float, *, emergency: bool) -> None:
        """Have the vehicle drop its task and stand; Halted follows once its state shows that.

        Called again, also for a standing vehicle, it is done again.
        """
        self._awaits_halt = True
        self._begin_stop(now, emergency=emergency)
        self._ledger.drop_task("the vehicle was stopped first")

    # --- the vehicle ----------------------------------------------------------------------------------

    def receive_message(self, message: Inbound, now: float, *, retained: bool = False) -> None:
        """Process a message of the vehicle; ``retained`` if the broker kept it from earlier."""
        presence = self._presence
        if isinstance(message, Factsheet):
            presence.note_factsheet(message)
            return
        if isinstance(message, Connection):
            presence.note_connection(message, now, retained=retained)
            if message.connection_state in ("OFFLINE", "HIBERNATING") and not retained:
                self._report(Stopped())
        elif retained:
            return  # a retained position may be outdated
        elif isinstance(message, State):
            presence.note_state(message, now)
            self._report_pose(now)
            self._judge(message, now)
        elif isinstance(message, Visualization):
            presence.note_visualization(message, now)
            self._report_pose(now)
        self.advance(now)

    def lose_broker(self) -> None:
        """Record that the broker is gone: nothing is known of the vehicle until it is back."""
        self._presence.lose_broker()

    def advance(self, now: float) -> None:
        """Advance the time: repeat messages not shown, extend the base, report the vehicle as alive."""
        if self._stop is not None:
            self._advance_stop(self._stop, now)
        self._advance_task(now)
        self._init.advance(now)
        self._poll(now)
        if self._admitted and self.status(now) != self._last_status:
            self._report_pose(now)
        if now >= self._next_alive and self._presence.is_there(now):
            self._next_alive = now + ALIVE_EVERY
            self._report(Alive())

    def alarm(self, now: float) -> str | None:
        """Return the alarm for operators in one line, or None."""
        unstopped = None if self._stop is None else self._stop.complaint(now)
        return "; ".join(filter(None, (unstopped, self._presence.alarm(now)))) or None

    def status(self, now: float) -> str | None:
        """Return the status for operators in one line; None if all is well."""
        if self._stop is not None:
            return self._presence.status(now, self._stop.complaint(now))
        state, task = self._presence.state, self._ledger.task
        foreign = None
        if state is not None and state.has_active_order and (task is None or task.plan is None):
            foreign = f"carries out order {state.order_id[:40]!r} of somebody else"
        return self._presence.status(now, foreign)

    def _judge(self, state: State, now: float) -> None:
        if self._stop is not None:
            self._stop.note_state(state, now)
        elif state.has_active_order and self._ledger.is_revoked(state.order_id):
            self._begin_stop(now)
        if self._ledger.task is not None and self._stop is None:
            self._judge_task(self._ledger.task, state, now)
        self._init.note_state(state)
        self._clear_actions(state, now)

    def _clear_actions(self, state: State, now: float) -> None:
        """Have a vehicle of 3.0 clear ended instant actions, unless one is awaited."""
        if self._stop is not None or self._init.is_waiting or now < self._next_clear:
            return
        if sum(one.has_ended for one in state.instant_action_states) > MOST_SHOWN:
            self._next_clear = now + CLEAR_EVERY
            self._ledger.publish_action("clearInstantActions", self._names.draw())

    def _poll(self, now: float) -> None:
        """Request the state of a vehicle that sends too few for its task."""
        presence = self._presence
        unknown = presence.state is None
        stopping = self._stop is not None
        busy = unknown or stopping or self._ledger.task is not None or self._init.is_waiting
        quiet = now - presence.state_at >= self._settings.poll_every
        if presence.connection == "ONLINE" and busy and quiet and now >= self._next_poll:
            self._next_poll = now + self._settings.poll_every
            presence.note_request(now)
            self._ledger.publish_action("stateRequest", self._names.draw())
            if unknown and presence.factsheet is None:
                self._ledger.publish_action("factsheetRequest", self._names.draw())

    # --- tasks ----------------------------------------------------------------------------------------

    def _judge_task(self, task: VehicleTask, state: State, now: float) -> None:
        ledger = self._ledger
        progress, reason = task.evaluate(state)
        if task.accepted and not task.acknowledged:
            task.acknowledged = True
            ledger.keep()
            ledger.settle(task.command_id)
        if progress is Progress.REACHED:
            ledger.end_task()
            self._report_pose(now)
            self._report(Stopped())
        elif progress in (Progress.REFUSED, Progress.ENDED, Progress.FOREIGN):
            ledger.refuse_task(reason)
            is_on_its_way = progress is Progress.ENDED and task.is_on_its_way
            if is_on_its_way or (progress is Progress.REFUSED and state.has_active_order):
                self._begin_stop(now)
        elif progress is Progress.FORGOTTEN and task.resumed >= MOST_RESUMED:
            ledger.refuse_task("the vehicle lost its order again and again")
        elif progress is Progress.FORGOTTEN:
            self._resume(task, now)

    def _resume(self, task: VehicleTask, now: float) -> None:
        """Send the rest of the way again, as a new order, to a vehicle that forgot its order."""
        plan, passed = task.plan, task.passed
        task.forget_plan(now)
        if plan is not None:
            frame = self._presence.frame_of(plan.map_id)
            task.path = [frame.to_site(x, y, 0.0)[:2] for x, y in plan.left(passed)]
        self._ledger.keep()

    def _advance_task(self, now: float) -> None:
        task = self._ledger.task
        if task is None:
            return
        if self._stop is not None:
            if now - task.received_at > self._settings.accept_within:
                self._ledger.refuse_task("the vehicle has not shown yet that it stopped")
        elif not (self._admitted and task.is_confirmed):
            return  # a release now could not be stopped from a desk
        elif task.plan is None:
            self._plan(task, now)
        elif not task.accepted and now - (task.first_sent_at or now) > self._settings.accept_within:
            within = f"within {self._settings.accept_within:g} s"
            self._ledger.refuse_task(f"the vehicle has not accepted the order {within}")
            self._begin_stop(now)
        else:
            self._advance_order(task, now)

    def _advance_order(self, task: VehicleTask, now: float) -> None:
        """Publish an order until the vehicle shows it, and updates when half of the base is driven."""
        state, limits = self._presence.state, self._limits()
        if task.accepted and state is not None and task.is_shown(state):
            longer = None if task.plan is None else task.plan.extended(task.passed, limits)
            if longer is None:
                return
            task.extend(longer)
            self._ledger.keep()
        if task.sent_at is None or now - task.sent_at >= REPEAT_EVERY:
            self._ledger.publish(task.sent(state, limits, now))

    def _plan(self, task: VehicleTask, now: float) -> None:
        """Create the order of a task as soon as the vehicle can be given one."""
        state = self._presence.state
        obstacle = self._presence.obstacle(now)
        if obstacle is None and state is not None and state.has_active_order:
            self._begin_stop(now)
            return
        if obstacle is None and state is not None and self._ledger.is_paused:
            obstacle = self._unpause(state, now)
        if obstacle is None:
            self._begin_order(task)
            self._advance_order(task, now)
        elif now - task.received_at > self._settings.accept_within:
            self._ledger.refuse_task(obstacle)

    def _unpause(self, state: State, now: float) -> str | None:
        """Lift a pause of ours, even if the vehicle does not show it; return the obstacle to driving."""
        unpause_sent = self._next_unpause > -math.inf
        if now >= self._next_unpause and (state.is_held or not unpause_sent):
            self._next_unpause = now + REPEAT_EVERY
            self._ledger.publish_action("stopPause", self._names.draw())
        return "the vehicle does not end its pause" if state.is_held else None

    def _begin_order(self, task: VehicleTask) -> None:
        position, frame = self._presence.position, self._presence.frame()
        assert position is not None and frame is not None
        points = [frame.from_site(x, y, 0.0)[:2] for x, y in task.path]
        theta = task.message.theta
        heading = None if theta is None else frame.from_site(*task.path[-1], theta)[2]
        order_id = f"{task.command_id}-{self._names.draw()}"
        place = position.x, position.y
        task.begin(begin_plan(order_id, position.map_id, place, points, heading, self._limits()))
        self._ledger.set_paused(False)
        self._ledger.keep()

    def _limits(self) -> RouteLimits:
        limits, factsheet = self._settings.route, self._presence.factsheet
        most = None if factsheet is None else factsheet.most_nodes
        return limits if most is None else replace(limits, most_nodes=min(most, limits.most_nodes))

    # --- stops ----------------------------------------------------------------------------------------

    def _begin_stop(self, now: float, *, emergency: bool = False) -> None:
        """Stop the vehicle. Published before anything is stored: a full disk must not prevent a stop."""
        if self._stop is None:
            sheet = self._presence.factsheet
            can_pause = sheet is None or sheet.supports("startPause")
            if self._is_surely_paused():
                can_pause = False
            self._stop = StopProcedure(now, self._settings.stop, self._names, can_pause=can_pause)
        if emergency:
            self._stop.set_emergency()
        self._publish_stop(self._stop, now)

    def _is_surely_paused(self) -> bool:
        """Return whether a pause of ours is in force: shown by the vehicle, and no lifting was sent."""
        state = self._presence.state
        unpause_sent = self._next_unpause > -math.inf
        return self._ledger.is_paused and not unpause_sent and state is not None and state.paused

    def _publish_stop(self, stop: StopProcedure, now: float) -> None:
        for actions in stop.due(now):
            self._ledger.publish(actions)
        if stop.has_paused and not self._ledger.is_paused:
            self._next_unpause = -math.inf
            self._ledger.set_paused(True)

    def _advance_stop(self, stop: StopProcedure, now: float) -> None:
        self._publish_stop(stop, now)
        if stop.stands and self._awaits_halt:
            self._awaits_halt = False
            self._report_pose(now)
            self._ledger.halted()
        if stop.has_ended:
            self._stop = None
            if self._ledger.task is None:
                self._report(Stopped())

    def _report_pose(self, now: float) -> None:
        """Report the vehicle's position and its faults."""
        pose, state = self._presence.pose, self._presence.state
        if pose is None or not self._admitted or not self._presence.is_there(now):
            return  # reports on a missing vehicle would make it seem present
        self._last_status = self.status(now)
        standing = state is not None and not state.driving
        if standing and pose is self._last_pose:
            # A standing vehicle reports seldom, and at once when it sets off: it is still there.
            pose = replace(pose, t=None, fix_t=None)
        else:
            self._last_pose = pose
        try:
            self._report(replace(pose, status=self._last_status, v=0.0 if standing else pose.v))
        except MessageError:
            return

    def _report(self, request: Request) -> None:
        if self._admitted:
            self._ledger.report(request)
