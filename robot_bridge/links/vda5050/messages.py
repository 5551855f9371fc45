"""VDA 5050 messages: states and factsheets in, orders and instant actions out, errors of both."""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Annotated, Any, Literal, Protocol

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType, field

from ...core.errors import BridgeError
from ...core.json_decoder import DecodingError, JsonBounds, decode_json
from ...core.messages.base import SPEED

# --- The exception family of the VDA 5050 adapter ---


class Vda5050Error(BridgeError):
    """The adapter cannot do something; the text names the vehicle, topic or setting, with advice."""


class VehicleMessageError(Vda5050Error):
    """A message of a vehicle that violates VDA 5050; the text names the field."""


# --- What vehicles publish: state, visualization, connection and factsheet of VDA 5050 2.0, 2.1 and 3.0
# Anybody who reaches the broker can write them: size, depth and count are bounded before anything is built,
# numbers are finite, and unused fields are ignored. The classes have the fields of 2.1; renamed fields of 3.0
# are converted first.

BOUNDS = JsonBounds(depth=16, length=1 << 20, values=60_000)
"""A state with a thousand nodes, each with its position, is half as large."""
MOST_LISTED = 10_000
LONGEST_TEXT = 4_096
SUPPORTED = {"2": "versions 2.0 and 2.1", "3": "versions 3.x"}
"""Supported versions by the major version in the link's settings."""
LEVELS = ("FATAL", "CRITICAL", "URGENT", "WARNING")
"""Levels of errors, the worst first; 2.x has the first and the last."""
_OPERATED = ("AUTOMATIC", "SEMIAUTOMATIC")
_STARTING = "STARTUP"
"""Operating mode of 3.0 of a vehicle that was switched on: nobody has taken it over."""
_RENAMED = {
    "mobileRobotPosition": "agvPosition",
    "localized": "positionInitialized",
    "powerSupply": "batteryState",
    "stateOfCharge": "batteryCharge",
    "activeEmergencyStop": "eStop",
    "actionResult": "resultDescription",
    "maximumArrayLengths": "maxArrayLens",
    "mobileRobotActions": "agvActions",
}
"""Fields of 3.0, at any depth, and their names in 2.1."""
RENAMED_ACTIONS = {"initializePosition": "initPosition"}
_RENAMED_VALUES = {
    "connectionState": {"CONNECTION_BROKEN": "CONNECTIONBROKEN"},
    "actionType": RENAMED_ACTIONS,
}

Text = Annotated[str, Meta(max_length=LONGEST_TEXT)]
Identifier = Annotated[str, Meta(max_length=512)]
Number = Annotated[float, Meta(ge=-1e9, le=1e9)]
Count = Annotated[int, Meta(ge=0, le=2**63 - 1)]


class VdaHeader(Struct, frozen=True, rename="camel", kw_only=True):
    """The head of every message; ``timestamp`` is ISO 8601 in UTC by the vehicle's clock."""

    header_id: Count
    timestamp: Identifier
    version: Identifier
    manufacturer: Identifier
    serial_number: Identifier

    @property
    def sent_at(self) -> float | None:
        """Seconds since 1970 when it was sent, by the vehicle's clock; None if unreadable."""
        return seconds_of(self.timestamp)


class Position(Struct, frozen=True, rename="camel", kw_only=True):
    """Position on map ``map_id``: metres, and radians counter-clockwise from the map's x axis."""

    x: Number
    y: Number
    theta: Number
    map_id: Identifier
    position_initialized: bool
    deviation_range: Annotated[float, Meta(ge=0, le=1e6)] | None = None


class Velocity(Struct, frozen=True, rename="camel", kw_only=True):
    """In the vehicle's frame: m/s forwards and to the left, rad/s."""

    vx: Annotated[float, Meta(ge=-100, le=100)] | None = None
    vy: Annotated[float, Meta(ge=-100, le=100)] | None = None

    @property
    def speed(self) -> float:
        """m/s, below 0 backwards; at most what a position may have."""
        forwards, sideways = self.vx or 0.0, self.vy or 0.0
        return math.copysign(min(SPEED[1], math.hypot(forwards, sideways)), forwards or 1.0)


class NodeState(Struct, frozen=True, rename="camel", kw_only=True):
    """A node not passed yet; ``released`` if it belongs to the base."""

    node_id: Identifier
    sequence_id: Count
    released: bool


class EdgeState(Struct, frozen=True, rename="camel", kw_only=True):
    """An edge not driven yet."""

    edge_id: Identifier
    sequence_id: Count
    released: bool


class ActionState(Struct, frozen=True, rename="camel", kw_only=True):
    """The state of an action of an order, or of an instant action."""

    action_id: Identifier
    action_status: Literal["WAITING", "INITIALIZING", "RUNNING", "PAUSED", "RETRIABLE", "FINISHED", "FAILED"]
    action_type: Identifier | None = None
    result_description: Text | None = None

    @property
    def has_ended(self) -> bool:
        """Whether it has finished or failed."""
        return self.action_status in ("FINISHED", "FAILED")


class ErrorReference(Struct, frozen=True, rename="camel", kw_only=True):
    """The subject of an error: for example ``orderId`` and its value."""

    reference_key: Identifier
    reference_value: Text


class VehicleFault(Struct, frozen=True, rename="camel", kw_only=True):
    """An error of the vehicle; FATAL ones need a person there, with CRITICAL ones it drives no further."""

    error_type: Identifier
    error_level: Identifier
    error_description: Text | None = None
    error_hint: Text | None = None
    error_references: Annotated[list[ErrorReference], Meta(max_length=1_000)] = field(default_factory=list)

    @property
    def rank(self) -> int:
        """Severity, 0 for the worst."""
        return LEVELS.index(self.error_level) if self.error_level in LEVELS else len(LEVELS)

    def refers(self, key: str, value: str) -> bool:
        """Return whether it refers to ``value`` of ``key``."""
        return any(one.reference_key == key and one.reference_value == value for one in self.error_references)

    @property
    def summary(self) -> str:
        """The error in the vehicle's own words."""
        text = f"{self.error_type}: {self.error_description}" if self.error_description else self.error_type
        return f"{text} ({self.error_hint})" if self.error_hint else text


class Battery(Struct, frozen=True, rename="camel", kw_only=True):
    """``battery_charge`` is in per cent."""

    battery_charge: Number
    charging: bool = False


class SafetyState(Struct, frozen=True, rename="camel", kw_only=True):
    """``e_stop`` is NONE, or how the stop must be reset; the protective field is violated or not."""

    e_stop: Identifier
    field_violation: bool


class State(VdaHeader, frozen=True, rename="camel", kw_only=True):
    """The full state of the vehicle: its order, the rest of it, its place, its faults.

    In 3.0 instant actions are listed separately until cleared; in 2.x they are among the others.
    """

    order_id: Identifier
    order_update_id: Count
    last_node_id: Identifier
    last_node_sequence_id: Count
    driving: bool
    operating_mode: Identifier
    node_states: Annotated[list[NodeState], Meta(max_length=MOST_LISTED)]
    edge_states: Annotated[list[EdgeState], Meta(max_length=MOST_LISTED)]
    action_states: Annotated[list[ActionState], Meta(max_length=MOST_LISTED)]
    instant_action_states: Annotated[list[ActionState], Meta(max_length=MOST_LISTED)] = field(
        default_factory=list
    )
    battery_state: Battery
    errors: Annotated[list[VehicleFault], Meta(max_length=1_000)]
    safety_state: SafetyState
    paused: bool = False
    new_base_request: bool = False
    agv_position: Position | None = None
    velocity: Velocity | None = None

    @property
    def has_active_order(self) -> bool:
        """Whether any part of its order is left; instant actions do not count."""
        return bool(self.node_states or self.edge_states)

    @property
    def is_operated(self) -> bool:
        """Whether its operating mode lets a fleet control drive it."""
        return self.operating_mode in _OPERATED

    @property
    def blocked_by(self) -> str | None:
        """Its operating mode or its own emergency stop as the reason why it drives no order, or None."""
        if not self.is_operated:
            return f"the vehicle is in operating mode {self.operating_mode[:40]}"
        if self.safety_state.e_stop != "NONE":
            return f"the vehicle's own emergency stop is active ({self.safety_state.e_stop[:40]})"
        return None

    @property
    def taken_over_by(self) -> str | None:
        """As ``blocked_by``, but None while it only starts up: then nobody at the vehicle ended its order."""
        starting = self.operating_mode == _STARTING and self.safety_state.e_stop == "NONE"
        return None if starting else self.blocked_by

    @property
    def is_held(self) -> bool:
        """Whether the vehicle is paused, or an accepted startPause has not taken effect yet.

        A second startPause may wait for the end of the first, and then pause the vehicle again.
        """
        return self.paused or any(
            one.action_type == "startPause" and not one.has_ended for one in self._actions
        )

    def action(self, action_id: str) -> ActionState | None:
        """Return the state of an action, None if it is not listed."""
        return next((one for one in self._actions if one.action_id == action_id), None)

    @property
    def _actions(self) -> tuple[ActionState, ...]:
        return (*self.action_states, *self.instant_action_states)


class Visualization(Struct, frozen=True, rename="camel", kw_only=True):
    """The vehicle's position, sent more often than its state; VDA 5050 requires no header here."""

    header_id: Count | None = None
    timestamp: Identifier | None = None
    agv_position: Position | None = None
    velocity: Velocity | None = None

    @property
    def sent_at(self) -> float | None:
        """As in :class:`VdaHeader`."""
        return None if self.timestamp is None else seconds_of(self.timestamp)


class Connection(VdaHeader, frozen=True, rename="camel", kw_only=True):
    """Whether the vehicle is connected; CONNECTIONBROKEN is its last will, sent by the broker.

    One that is HIBERNATING stands, has no order, and sends nothing (3.0).
    """

    connection_state: Literal["ONLINE", "OFFLINE", "HIBERNATING", "CONNECTIONBROKEN"]


class ArrayLimits(Struct, frozen=True, kw_only=True):
    """The most nodes that an order to this vehicle may hold; None or 0 if unknown."""

    order_nodes: Count | None = field(default=None, name="order.nodes")


class ProtocolLimits(Struct, frozen=True, rename="camel", kw_only=True):
    """Limits of messages to this vehicle."""

    max_array_lens: ArrayLimits | None = None


class SupportedAction(Struct, frozen=True, rename="camel", kw_only=True):
    """An action supported by the vehicle."""

    action_type: Identifier


class ProtocolFeatures(Struct, frozen=True, rename="camel", kw_only=True):
    """Protocol features of the vehicle."""

    agv_actions: Annotated[list[SupportedAction], Meta(max_length=1_000)] = field(default_factory=list)


class TypeSpecification(Struct, frozen=True, rename="camel", kw_only=True):
    """Type of the vehicle."""

    series_name: Identifier = ""


class Factsheet(Struct, frozen=True, rename="camel", kw_only=True):
    """Type and abilities of the vehicle; all parts are optional, since vehicles omit them."""

    type_specification: TypeSpecification | None = None
    protocol_limits: ProtocolLimits | None = None
    protocol_features: ProtocolFeatures | None = None

    @property
    def most_nodes(self) -> int | None:
        """The most nodes of an order, None without a limit."""
        lengths = self.protocol_limits and self.protocol_limits.max_array_lens
        return (lengths.order_nodes or None) if lengths else None

    def supports(self, action_type: str) -> bool:
        """Return whether the vehicle can do an action; true if the factsheet lists none."""
        listed = self.protocol_features.agv_actions if self.protocol_features else []
        return not listed or any(one.action_type == action_type for one in listed)


Inbound = State | Visualization | Connection | Factsheet

_KINDS: dict[str, type[Inbound]] = {
    "state": State,
    "visualization": Visualization,
    "connection": Connection,
    "factsheet": Factsheet,
}


def seconds_of(timestamp: str) -> float | None:
    """Return ISO 8601 as seconds since 1970, UTC without a zone; None if unreadable."""
    try:
        moment = datetime.fromisoformat(timestamp)
        if moment.tzinfo is None:
            moment = moment.replace(tzinfo=timezone.utc)
        return moment.timestamp()
    except (ValueError, OverflowError):
        return None


def decode_message(topic: str, payload: bytes, major: str = "2") -> Inbound:
    """Return the message of the last level of ``topic``, of major version ``major``.

    :raises VehicleMessageError: naming the field, or the version if it is another one.
    """
    kind = _KINDS.get(topic)
    if kind is None:
        raise VehicleMessageError(f"topic {topic[:40]!r} is none that a vehicle publishes")
    try:
        body = decode_json(payload, BOUNDS)
        _check_version(topic, body, major)
        return msgspec.convert(_as_2_1(body) if major == "3" else body, kind, strict=True)
    except (DecodingError, msgspec.ValidationError) as error:
        raise VehicleMessageError(f"{topic}: {error}") from None


def _check_version(topic: str, body: Any, major: str) -> None:
    version = body.get("version") if isinstance(body, dict) else None
    if isinstance(version, str) and version.split(".")[0] != major:
        raise VehicleMessageError(
            f"{topic}: version {version[:20]!r} is not spoken here; {SUPPORTED[major]} are "
            "(major_version of the link's settings says which)"
        )


def _as_2_1(body: Any) -> Any:
    """Return a message of 3.0 with the names of 2.1; its depth is bounded."""
    if isinstance(body, list):
        return [_as_2_1(one) for one in body]
    if not isinstance(body, dict):
        return body
    fields_2_1 = {}
    for name, value in body.items():
        values = _RENAMED_VALUES.get(name, {})
        fields_2_1[_RENAMED.get(name, name)] = (
            values.get(value, value) if isinstance(value, str) else _as_2_1(value)
        )
    return fields_2_1


# --- What the adapter publishes: orders and instant actions of VDA 5050 2.0 to 3.0, and on which topics

INBOUND_TOPICS = ("connection", "state", "visualization", "factsheet")
_ACTIONS_OF_3_0 = {old: new for new, old in RENAMED_ACTIONS.items()}
_LEVEL = re.compile(r"[^/+#$\x00-\x1f][^/+#\x00-\x1f]{0,127}")


class FreshNames(Protocol):
    """Names of orders and actions."""

    def draw(self) -> str:
        """Return a name that was never used."""


@dataclass(frozen=True)
class VehicleId:
    """One vehicle: its manufacturer and its serial number there."""

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
        """Return the topic that a vehicle subscribes to."""
        return f"{self.interface}/{self.major_version}/{vehicle.manufacturer}/{vehicle.serial_number}/{topic}"

    def parse(self, topic: str) -> tuple[VehicleId, str] | None:
        """Return the vehicle and the last level of ``topic``; None for a foreign topic."""
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
    """Position of a node on map ``map_id``; the deviations are how near the vehicle must come to it."""

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
    """An order, or with an ``order_update_id`` above 0 an extension of its base."""

    order_id: str
    order_update_id: int
    nodes: list[Node]
    edges: list[Edge]


class InstantActions(Struct, frozen=True, rename="camel", kw_only=True):
    """Actions executed as soon as they arrive."""

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
            # The schema of 2.0 names it differently than the text; vehicles follow one or the other.
            body["instantActions"] = body["actions"]
        if version.startswith("3."):
            _rename_for_3_0(body)
        self._numbers[topic] += 1
        return msgspec.json.encode(body)


def _rename_for_3_0(body: dict[str, Any]) -> None:
    """Change a message of 2.1 into one of 3.0."""
    for action in body.get("actions", []):
        # In 3.0 instant actions wait for nothing.
        action["blockingType"] = "NONE"
        action["actionType"] = _ACTIONS_OF_3_0.get(action["actionType"], action["actionType"])
    for node in body.get("nodes", []):
        position = node["nodePosition"]
        if (deviation := position.pop("allowedDeviationXY", None)) is not None:
            position["allowedDeviationXY"] = {"a": deviation, "b": deviation, "theta": 0.0}
    for edge in body.get("edges", []):
        # The joined nodes follow from the sequence alone.
        del edge["startNodeId"], edge["endNodeId"]
        if "maxSpeed" in edge:
            edge["maximumSpeed"] = edge.pop("maxSpeed")


def timestamp(now: float) -> str:
    """Return seconds since 1970 as ISO 8601 in UTC with milliseconds."""
    moment = datetime.fromtimestamp(now, timezone.utc)
    return f"{moment:%Y-%m-%dT%H:%M:%S}.{moment.microsecond // 1000:03d}Z"
