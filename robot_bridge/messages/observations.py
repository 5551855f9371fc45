"""What robots saw, as operators are told it, and what operators make of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from .bounds import LONGEST_LABEL
from .checks import MessageError, Ranges, Texts, check_ranges, check_stored_number, check_texts

LONGEST_REASON = 1000
"""characters."""


class ObservationState(str, Enum):
    """Whether an operator has looked at an observation, and what came of it."""

    PENDING = "pending"
    ACCEPTED = "accepted"
    REJECTED = "rejected"


@dataclass(frozen=True)
class ObservationReport:
    """One observation: what the robot told by ``op`` (SetObject or SendImage), and its review.

    ``height`` and ``radius`` (metres) are the robot's until an operator gives others; ``label`` is the
    robot's word for the object and ``semantics`` the map's. ``seen_at`` is by the robot's clock. With
    ``doubts`` it is no new object: the robot looks through what the map has under that ``src``.
    """

    observation: int
    robot: str
    op: str
    object: str
    x: float
    y: float
    received_at: float
    state: ObservationState
    seen_at: float | None = None
    label: str | None = None
    height: float | None = None
    radius: float | None = None
    media_type: str | None = None
    image_bytes: int | None = None
    semantics: str | None = None
    reason: str | None = None
    reviewed_at: float | None = None
    reviewed_by: str | None = None
    doubts: str | None = None


@dataclass(frozen=True)
class GetObservations:
    """Ask for observations, newest first: at most ``limit`` with an id below ``before``.

    Those in one ``state`` or in all, of one robot or of all, of one object (its images too) or of all.
    """

    method: ClassVar[str] = "get_observations"
    state: ObservationState | None = None
    robot: str | None = None
    object: str | None = None
    before: int | None = None
    limit: int = 100
    ranges: ClassVar[Ranges] = {"limit": (1, 1000)}

    def __post_init__(self) -> None:
        check_stored_number(before=self.before)
        check_ranges(self)


@dataclass(frozen=True)
class GetImage:
    """Ask for the image of an observation; answered with ``media_type`` and ``image`` in base64."""

    method: ClassVar[str] = "get_image"
    observation: int

    def __post_init__(self) -> None:
        check_stored_number(observation=self.observation)


@dataclass(frozen=True)
class ReviewObservation:
    """Accept an observation, so that its object is on the next maps, or reject it.

    ``semantics`` is the object's word on the map, ``height`` and ``radius`` are in metres; what is left out
    is as the robot told. ``revise`` changes a review that was given before.
    """

    method: ClassVar[str] = "review_observation"
    observation: int
    accept: bool
    semantics: str | None = None
    height: float | None = None
    radius: float | None = None
    reason: str | None = None
    revise: bool = False
    ranges: ClassVar[Ranges] = {"height": (0, 1000), "radius": (0.01, 50)}
    texts: ClassVar[Texts] = {"semantics": LONGEST_LABEL, "reason": LONGEST_REASON}

    def __post_init__(self) -> None:
        check_stored_number(observation=self.observation)
        check_ranges(self)
        check_texts(self)
        if not self.accept and (self.semantics, self.height, self.radius) != (None, None, None):
            raise MessageError("accept is false, and semantics, height and radius are for what is accepted")
