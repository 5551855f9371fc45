"""Two vehicles under one serial number, as they show in header numbers and in the broker's last wills."""

from __future__ import annotations

from collections import deque

from .inbound import Connection

WINDOW = 30.0
"""seconds over which jumps are counted, and for which two vehicles count as being there after the last."""
MOST_JUMPS = 3
"""A vehicle that starts anew begins its numbers anew: once, not again and again."""
MOST_GREETINGS = 4
"""Two clients of one id throw each other out of the broker, and each says ONLINE again."""


class SerialWatch:
    """Watches the messages of one serial number; times are seconds of a steady clock."""

    def __init__(self) -> None:
        self._last_number: int | None = None
        self._jumps: deque[float] = deque(maxlen=MOST_JUMPS)
        self._greetings: deque[float] = deque(maxlen=MOST_GREETINGS)
        self._doubled_at: float | None = None

    def note_state(self, header_id: int, now: float) -> None:
        """Note the header number of a state; those of one vehicle rise."""
        if self._last_number is not None and header_id <= self._last_number:
            self._jumps.append(now)
            self._judge(self._jumps, now)
        self._last_number = header_id

    def note_connection(self, connection: Connection, now: float) -> None:
        """Note that the vehicle says to be there; what the broker retained does not count."""
        if connection.connection_state == "ONLINE":
            self._greetings.append(now)
            self._judge(self._greetings, now)

    def complaint(self, now: float) -> str | None:
        """Return what is wrong, None where one vehicle is there for all that is known."""
        if self._doubled_at is None or now - self._doubled_at > WINDOW:
            return None
        return (
            "two vehicles speak under this serial number, or one starts anew again and again; "
            "give each its own serial number and MQTT client id"
        )

    def _judge(self, moments: deque[float], now: float) -> None:
        if len(moments) == moments.maxlen and now - moments[0] <= WINDOW:
            self._doubled_at = now
