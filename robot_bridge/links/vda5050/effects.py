"""What comes of a message or of time going by: what is to be published, told to the gateway, and kept."""

from __future__ import annotations

from dataclasses import dataclass

from ...messages import Request
from .memory import Remembered
from .outbound import InstantActions, Order


@dataclass(frozen=True)
class Publish:
    """A message to the vehicle. One that finds no broker is lost; while it is due it comes again."""

    message: Order | InstantActions


@dataclass(frozen=True)
class Report:
    """What the vehicle says to the gateway."""

    request: Request


@dataclass(frozen=True)
class Settled:
    """What came of command ``command_id``: taken on, or with a reason refused, or given up later."""

    command_id: int
    reason: str | None = None


@dataclass(frozen=True)
class Halted:
    """The vehicle shows that it stands: what was asked to stop it is done."""


@dataclass(frozen=True)
class Keep:
    """What is to be kept before any effect that comes after it."""

    remembered: Remembered


Effect = Publish | Report | Settled | Halted | Keep
