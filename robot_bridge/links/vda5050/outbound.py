"""What the adapter publishes: orders and instant actions of VDA 5050 2.0 to 3.0, and on which topics."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any, Literal

import msgspec
from msgspec import UNSET, Struct, UnsetType, field

from .errors import Vda5050Error
from .inbound import RENAMED_ACTIONS

INBOUND_TOPICS = ("connection", "state", "visualization", "factsheet")
_ACTIONS_OF_3_0 = {old: new for new, old in RENAMED_ACTIONS.items()}
_LEVEL = re.compile(r"[^/+#$\x00-\x1f][^/+#\x00-\x1f]{0,127}")


@dataclass(frozen=True)
class VehicleId:
    """One vehicle: its manufacturer and the serial number that is its own there."""

    manufacturer: str
    serial_number: str

    def __str__(self) -> str:
        return f"{self.manufacturer}/{self.serial_number}"


@dataclass(frozen=True)
class Topics:
    """The topics of one interface, ``interface/majorVersion/manufacturer/serialNumber/topic``."""

    interface: str = "uagv"
    major_version: str = "v2"

    def __post_init__(self) -> None:
        for key, level in (("interface", self.interface), ("major_version", self.major_version)):
            if not _LEVEL.fullmatch(level):
                raise Vda5050Error(f"{key} is {level[:40]!r}; give one level of an MQTT topic: no / + # $")

    @property
    def major(self) -> str:
        """The major version of the messages: 3 on topics of v3, 2 on all others."""
        return "3" if self.major_version == "v3" else "2"

    def subscriptions(self) -> list[str]:
        """Return what to subscribe to for the messages of all vehicles."""
        return [f"{self.interface}/{self.major_version}/+/+/{topic}" for topic in INBOUND_TOPICS]

    def outbound(self, vehicle: VehicleId, topic: Literal["order", "instantActions"]) -> str:
        """Return the topic on which a vehicle listens."""
        return f"{self.interface}/{self.major_version}/{vehicle.manufacturer}/{vehicle.serial_number}/{topic}"

    def parse(self, topic: str) -> tuple[VehicleId, str] | None:
        """Return who published on ``topic`` and what; None for a topic of something else."""
        levels = topic.split("/")
        if len(levels) != 5 or levels[:2] != [self.interface, self.major_version]:
            return None
        if not (_LEVEL.fullmatch(levels[2]) and _LEVEL.fullmatch(levels[3])):
            return None
        return VehicleId(levels[2], levels[3]), levels[4]


class ActionParameter(Struct, frozen=True):
    """One parameter of an action."""

    key: str
    value: str | float | bool


class Action(Struct, frozen=True, rename="camel", kw_only=True):
    """An action; one with blocking type NONE waits for no other."""

    action_type: str
    action_id: str
    blocking_type: Literal["NONE", "SOFT", "HARD"] = "NONE"
    action_parameters: list[ActionParameter] = field(default_factory=list)


class NodePosition(Struct, frozen=True, rename="camel", kw_only=True, omit_defaults=True):
    """Where a node is on map ``map_id``; the deviations say how near the vehicle has to come to it."""

    x: float
    y: float
    map_id: str
    theta: float | UnsetType = UNSET
    allowed_deviation_xy: float | UnsetType = field(default=UNSET, name="allowedDeviationXY")
    allowed_deviation_theta: float | UnsetType = UNSET


class Node(Struct, frozen=True, rename="camel", kw_only=True):
    """A node of an order, with an even sequence number."""

    node_id: str
    sequence_id: int
    released: bool
    node_position: NodePosition
    actions: list[Action] = field(default_factory=list)


class Edge(Struct, frozen=True, rename="camel", kw_only=True):
    """The straight edge between two nodes, with the odd sequence number between theirs."""

    edge_id: str
    sequence_id: int
    released: bool
    start_node_id: str
    end_node_id: str
    max_speed: float | UnsetType = UNSET
    actions: list[Action] = field(default_factory=list)


class Order(Struct, frozen=True, rename="camel", kw_only=True):
    """An order, or with an ``order_update_id`` above 0 what is added to its base."""

    order_id: str
    order_update_id: int
    nodes: list[Node]
    edges: list[Edge]


class InstantActions(Struct, frozen=True, rename="camel", kw_only=True):
    """Actions that are done as soon as they arrive."""

    actions: list[Action]


class MessageWriter:
    """Writes messages to one vehicle, each topic with header numbers of its own."""

    def __init__(self, vehicle: VehicleId) -> None:
        self._vehicle = vehicle
        self._numbers: Counter[str] = Counter()

    def encode(self, message: Order | InstantActions, version: str, now: float) -> bytes:
        """Return ``message`` with its header, as JSON; ``version`` is the vehicle's own."""
        topic = "order" if isinstance(message, Order) else "instantActions"
        body: dict[str, Any] = {
            "headerId": self._numbers[topic],
            "timestamp": timestamp(now),
            "version": version,
            "manufacturer": self._vehicle.manufacturer,
            "serialNumber": self._vehicle.serial_number,
            **msgspec.to_builtins(message),
        }
        if topic == "instantActions" and version.startswith("2.0"):
            # The schema of 2.0 has another name for it than its text; vehicles go by one or the other.
            body["instantActions"] = body["actions"]
        if version.startswith("3."):
            _rename_for_3_0(body)
        self._numbers[topic] += 1
        return msgspec.json.encode(body)


def _rename_for_3_0(body: dict[str, Any]) -> None:
    """Change a message of 2.1 into one of 3.0."""
    for action in body.get("actions", []):
        # 3.0 has instant actions wait for nothing.
        action["blockingType"] = "NONE"
        action["actionType"] = _ACTIONS_OF_3_0.get(action["actionType"], action["actionType"])
    for node in body.get("nodes", []):
        position = node["nodePosition"]
        if (deviation := position.pop("allowedDeviationXY", None)) is not None:
            position["allowedDeviationXY"] = {"a": deviation, "b": deviation, "theta": 0.0}
    for edge in body.get("edges", []):
        # Which nodes it joins is said by the sequence alone.
        del edge["startNodeId"], edge["endNodeId"]
        if "maxSpeed" in edge:
            edge["maximumSpeed"] = edge.pop("maxSpeed")


def timestamp(now: float) -> str:
    """Return seconds since 1970 as ISO 8601 in UTC with milliseconds."""
    moment = datetime.fromtimestamp(now, timezone.utc)
    return f"{moment:%Y-%m-%dT%H:%M:%S}.{moment.microsecond // 1000:03d}Z"
