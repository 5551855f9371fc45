"""How large what a robot says may be: every bound of its messages, in one place.

The guide for integrators and the JSON Schemas say the same. What a site may set stands in table ``[limits]``
of its ``site.toml`` (:mod:`...sites.limit_settings`).
"""

from __future__ import annotations

import math

LARGEST_MESSAGE = 65_536
"""bytes of a message on WebSocket, characters of ``params`` on SQL; an image may be larger."""
LONGEST_STATUS = 256
"""characters of a status; a longer one is cut, so that its robot is not lost for it."""
LONGEST_REFUSAL = 500
"""characters of the reason in a robot's OpAck; a longer one is cut."""
LONGEST_OPERATOR = 128
"""characters of an operator's name."""
LONGEST_LABEL = 128
"""characters; of an object's id, its label and a robot's own number of an observation."""
COORDINATE = (-1e8, 1e8)
"""metres in the site frame, whose origin may be that of a CRS with its zone before the easting."""
SPEED = (-100.0, 100.0)
"""m/s; backwards is below 0."""
THETA = (-1e6, 1e6)
"""radians; taken for the same direction in [-π, π]."""
ALTITUDE = (-12_000.0, 100_000.0)
"""metres."""
CLOCK = (-1e12, 1e12)
"""seconds of a robot's own clock, whenever it counts from."""
ACCURACY = (0.0, 1e6)
"""metres."""
AREA = (0.0, 1e14)
"""square metres of a map."""
CUT = "…"
"""The end of a text that was cut."""


def one_line(text: str, longest: int) -> str:
    """Return ``text`` as one line of at most ``longest`` characters, cut with a mark where it is longer.

    What is no printable character becomes a space.
    """
    line = text if len(text) <= longest else text[: longest - len(CUT)] + CUT
    return line if line.isprintable() else "".join(c if c.isprintable() else " " for c in line)


def direction(theta: float) -> float:
    """Return ``theta``, radians, as the same direction in [-π, π]."""
    return theta if -math.pi <= theta <= math.pi else math.remainder(theta, math.tau)
