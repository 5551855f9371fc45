"""Presence of a vehicle: serial number, connection, map frame, and whether its state is recent."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import Protocol

from ...core.messages.base import LONGEST_STATUS, one_line
from ...core.messages.robots import SendPos
from .messages import LEVELS, Connection, Factsheet, Position, State, VehicleFault, Velocity, Visualization

# --- Detection of two vehicles under one serial number, by header numbers and last wills

WINDOW = 30.0
"""seconds over which jumps are counted, and for which two vehicles count as present after the last."""
MOST_JUMPS = 3
"""A restarted vehicle restarts its numbers: once, not repeatedly."""
MOST_GREETINGS = 4
"""Two clients of one id disconnect each other at the broker, and each sends ONLINE again."""


class SerialWatch:
    """Watches the messages of one serial number; times are seconds of a steady clock."""

    def __init__(self) -> None:
        self._last_number: int | None = None
        self._jumps: deque[float] = deque(maxlen=MOST_JUMPS)
        self._greetings: deque[float] = deque(maxlen=MOST_GREETINGS)
        self._doubled_at: float | None = None

    def note_state(self, header_id: int, now: float) -> None:
        """Record the header number of a state; those of one vehicle rise."""
        if self._last_number is not None and header_id <= self._last_number:
            self._jumps.append(now)
            self._judge(self._jumps, now)
        self._last_number = header_id

    def note_connection(self, connection: Connection, now: float) -> None:
        """Record an ONLINE of the vehicle; retained messages do not count."""
        if connection.connection_state == "ONLINE":
            self._greetings.append(now)
            self._judge(self._greetings, now)

    def complaint(self, now: float) -> str | None:
        """Return the fault, None if there seems to be one vehicle."""
        if self._doubled_at is None or now - self._doubled_at > WINDOW:
            return None
        return (
            "two vehicles speak under this serial number, or one starts anew again and again; "
            "give each its own serial number and MQTT client id"
        )

    def _judge(self, moments: deque[float], now: float) -> None:
        if len(moments) == moments.maxlen and now - moments[0] <= WINDOW:
            self._doubled_at = now


# --- Presence of a vehicle: its connection, its last state, its position in the site frame

ANSWERS_WITHIN = 5.0
"""seconds after which a vehicle that does not answer a state request counts as gone."""
ALARMING = LEVELS[:-1]
"""Levels of errors for which a vehicle needs a person: all but warnings."""
MOST_FAULTS = 5
"""Faults listed in a status."""


class MapFrame(Protocol):
    """The transform between a vehicle's map and the site frame; metres and radians."""

    def to_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        """Return a pose of the map in the site frame."""

    def from_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        """Return a pose of the site frame in the map."""


class VehiclePresence:
    """Known state of one vehicle; times are seconds of a steady clock."""

    def __init__(self, maps: Mapping[str, MapFrame], silent_after: float, version: str) -> None:
        self._maps = maps
        self._silent_after = silent_after
        self._serials = SerialWatch()
        self._connection: str | None = None
        self._received_at = self._requested_at = -math.inf
        self.state: State | None = None
        """the last state that was not retained by the broker."""
        self.state_at = -math.inf
        self.factsheet: Factsheet | None = None
        self.position: Position | None = None
        self.pose: SendPos | None = None
        """None also while the vehicle's place is unknown: its last one is not reported as the present one."""
        self._states_have_position = False
        self.version = version
        self._placed_at = -math.inf
        self._misplaced: str | None = None

    def note_connection(self, message: Connection, now: float, *, retained: bool) -> None:
        """Record whether the vehicle is connected; a retained ONLINE may be older than the broker."""
        self._connection, self.version = message.connection_state, message.version
        if not retained:
            self._serials.note_connection(message, now)
            if message.connection_state == "ONLINE":
                self._received_at = now

    def note_state(self, message: State, now: float) -> None:
        """Record a state; it shows that the vehicle is present.

        Also after a CONNECTIONBROKEN: that may be a late report on a connection that the vehicle has
        replaced.
        """
        self._serials.note_state(message.header_id, now)
        self.state, self.state_at, self.version = message, now, message.version
        self._connection, self._received_at = "ONLINE", now
        if message.agv_position is None and self._states_have_position:
            self.position = self.pose = None
        self._states_have_position = message.agv_position is not None
        self._place(message.agv_position, message.velocity, message.sent_at, now)

    def note_visualization(self, message: Visualization, now: float) -> None:
        """Record a position between two states."""
        self._received_at = now
        self._place(message.agv_position, message.velocity, message.sent_at, now)

    def note_factsheet(self, message: Factsheet) -> None:
        """Record the vehicle's factsheet; a retained one counts."""
        self.factsheet = message

    def lose_broker(self) -> None:
        """Record that nothing is known of the vehicle until the broker is back."""
        self._connection, self._received_at = None, -math.inf

    @property
    def connection(self) -> str | None:
        """ONLINE, OFFLINE, HIBERNATING, CONNECTIONBROKEN; None if unknown."""
        return self._connection

    def note_request(self, now: float) -> None:
        """Record a state request to the vehicle; the first one without an answer counts."""
        if self._requested_at <= self._received_at:
            self._requested_at = now

    def is_there(self, now: float) -> bool:
        """Return whether the vehicle is connected, was heard recently, and answers state requests."""
        unanswered = self._requested_at > self._received_at and now - self._requested_at > ANSWERS_WITHIN
        silent = now - self._received_at > self._silent_after
        return self._connection == "ONLINE" and not (unanswered or silent)

    def frame(self) -> MapFrame | None:
        """Return the frame of the map that the vehicle is on, or None."""
        return None if self.position is None else self._maps.get(self.position.map_id)

    def default_map(self) -> str | None:
        """Return the map that the vehicle is on, or the only known one."""
        if self.position is not None and self.position.map_id in self._maps:
            return self.position.map_id
        return next(iter(self._maps)) if len(self._maps) == 1 else None

    def frame_of(self, map_id: str) -> MapFrame:
        """Return the frame of a map that the settings name."""
        return self._maps[map_id]

    def serial_complaint(self, now: float) -> str | None:
        """Return the evidence for a second vehicle under this serial number, or None."""
        return self._serials.complaint(now)

    def obstacle(self, now: float) -> str | None:
        """Return why the vehicle cannot be given an order, or None."""
        if (double := self.serial_complaint(now)) is not None:
            return double
        state = self.state
        if not self.is_there(now):
            if self._connection == "ONLINE":
                return "the vehicle is connected, but says nothing"
            return f"the vehicle is not connected ({self._connection or 'never heard'})"
        if state is None:
            return "the vehicle has published no state yet"
        return state.blocked_by or self._missing_place()

    def alarm(self, now: float) -> str | None:
        """Return the alarms for operators, worst first, or None.

        These are its safety state, errors that need a person, an unknown place, and a serial number used by
        two vehicles.
        """
        state, parts = self.state, [self.serial_complaint(now)]
        if state is not None and self.is_there(now):
            parts += self._protection(state)
            parts.append(self._missing_place())
            parts += [self._words(one) for one in state.errors if one.error_level in ALARMING][:MOST_FAULTS]
        text = "; ".join(part for part in parts if part)
        return text or None

    def status(self, now: float, more: str | None) -> str | None:
        """Return the status for operators, worst first, as one line; None if all is well."""
        parts = [more, self.serial_complaint(now), *self._safety(), self._missing_place(), *self._faults()]
        text = "; ".join(part for part in parts if part)
        return one_line(text, LONGEST_STATUS) if text else None

    def _safety(self) -> list[str]:
        state, parts = self.state, []
        if state is None:
            return []
        parts += self._protection(state)
        if not state.is_operated:
            parts.append(f"operating mode {state.operating_mode[:40]}")
        if state.paused:
            parts.append("paused")
        return parts

    @staticmethod
    def _protection(state: State) -> list[str]:
        parts = []
        if state.safety_state.e_stop != "NONE":
            parts.append(f"emergency stop at the vehicle ({state.safety_state.e_stop[:40]})")
        if state.safety_state.field_violation:
            parts.append("protective field violated")
        return parts

    @staticmethod
    def _words(fault: VehicleFault) -> str:
        return f"{fault.error_level} {fault.summary}"

    def _faults(self) -> list[str]:
        if self.state is None:
            return []
        worst_first = sorted(self.state.errors, key=lambda fault: fault.rank)
        return [self._words(fault) for fault in worst_first[:MOST_FAULTS]]

    def _missing_place(self) -> str | None:
        if self.position is None:
            return None if self.state is None else "the vehicle says no position"
        if not self.position.position_initialized:
            return "the vehicle does not know where it is (positionInitialized is false)"
        if self.frame() is None:
            known = "[vda5050.maps] names those that are"
            return f"map {self.position.map_id[:60]!r} is not in the settings, {known}"
        return self._misplaced

    def _place(
        self, position: Position | None, velocity: Velocity | None, sent_at: float | None, now: float
    ) -> None:
        if position is None:
            return
        before, self.position = None if self.pose is None else self.position, position
        frame, self.pose = self.frame(), None
        if frame is None or not position.position_initialized:
            return
        v = self._speed(before, position, velocity, now)
        self._placed_at = now
        battery = None if self.state is None else self.state.battery_state.battery_charge / 100
        try:
            x, y, theta = frame.to_site(position.x, position.y, position.theta)
            self.pose = SendPos(
                x=x,
                y=y,
                theta=theta,
                v=v,
                t=sent_at,
                fix_t=sent_at,
                battery=None if battery is None else min(1.0, max(0.0, battery)),
                accuracy=position.deviation_range,
            )
            self._misplaced = None
        except ValueError as error:
            self._misplaced = f"its position has no place on the site: {error}"

    def _speed(
        self, before: Position | None, position: Position, velocity: Velocity | None, now: float
    ) -> float:
        """Return m/s: as reported by the vehicle, else by the distance from its last position."""
        if velocity is not None:
            return velocity.speed
        if self.state is not None and not self.state.driving:
            return 0.0
        passed = now - self._placed_at
        if before is None or before.map_id != position.map_id or passed <= 0:
            return 0.0
        return min(100.0, math.dist((before.x, before.y), (position.x, position.y)) / passed)
