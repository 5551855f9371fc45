"""A vehicle of VDA 5050 3.0, written from its text; argument: a JSON object with port, serial, x and y.

Nothing that can be installed speaks 3.0. Every message in both directions is held against the shapes below,
and against the official schemas where VDA5050_SCHEMAS names a folder with them (json_schemas of the tag
3.0.0); what is not valid is a line INVALID. It brakes as a vehicle does: a stop takes a while, and is
RUNNING until the vehicle stands.
"""

from __future__ import annotations

import json
import math
import os
import queue
import re
import sys
import time
from datetime import datetime, timezone
from pathlib import Path
from typing import Annotated, Any, Literal

import jsonschema
import msgspec
import paho.mqtt.client as mqtt
from msgspec import UNSET, Meta, Struct, UnsetType

TICK, BRAKES = 0.05, 8.0
"""s, and m/s²."""
SEEN_EVERY, STATE_EVERY = 0.2, 0.3
"""s; between messages of where it is, and of all."""
ACTIONS = (
    "cancelOrder",
    "startPause",
    "stopPause",
    "initializePosition",
    "stateRequest",
    "factsheetRequest",
    "clearInstantActions",
)
Angle = Annotated[float, Meta(ge=-math.pi, le=math.pi)]


class Shape(Struct, rename="camel", forbid_unknown_fields=True, kw_only=True):
    """Fields as 3.0 names them, and no others."""


class Parameter(Shape):
    """Of an action."""

    key: str
    value: bool | float | str | list | dict


class OrderAction(Shape):
    """An action of a node or an edge."""

    action_id: str
    action_type: str
    blocking_type: Literal["NONE", "SOFT", "SINGLE", "HARD"]
    action_parameters: list[Parameter] = []
    retriable: bool = False


class InstantAction(OrderAction):
    """One that is done at once."""

    blocking_type: Literal["NONE"]


class Ellipse(Shape):
    """How far from a node the vehicle may pass."""

    a: Annotated[float, Meta(ge=0)]
    b: Annotated[float, Meta(ge=0)]
    theta: Annotated[float, Meta(ge=-math.pi / 2, le=math.pi / 2)]


class NodePosition(Shape):
    """Where a node is."""

    x: float
    y: float
    map_id: str
    theta: Angle | UnsetType = UNSET
    allowed_deviation_xy: Ellipse | UnsetType = msgspec.field(default=UNSET, name="allowedDeviationXY")
    allowed_deviation_theta: Annotated[float, Meta(ge=0, le=math.pi)] | UnsetType = UNSET


class Node(Shape):
    """A node of an order."""

    node_id: str
    sequence_id: Annotated[int, Meta(ge=0)]
    released: bool
    actions: list[OrderAction]
    node_position: NodePosition


class Edge(Shape):
    """An edge of an order; the sequence alone says between which nodes."""

    edge_id: str
    sequence_id: Annotated[int, Meta(ge=0)]
    released: bool
    actions: list[OrderAction]
    maximum_speed: float | UnsetType = UNSET


class Head(Shape):
    """What each message begins with."""

    header_id: Annotated[int, Meta(ge=0)]
    timestamp: datetime
    version: Annotated[str, Meta(pattern=r"^3\.0\.\d+$")]
    manufacturer: str
    serial_number: str


class Order(Head):
    """An order, or an update of one."""

    order_id: str
    order_update_id: Annotated[int, Meta(ge=0)]
    nodes: list[Node]
    edges: list[Edge]


class InstantActions(Head):
    """Actions that are done at once."""

    actions: list[InstantAction]


SHAPES = {"order": Order, "instantActions": InstantActions}


def schemas() -> dict[str, Any]:
    """Return the official schemas by topic; none where there are none."""
    folder = os.environ.get("VDA5050_SCHEMAS")
    found = {}
    for file in Path(folder).glob("*.schema") if folder else ():
        # Three of those of 3.0.0 have commas that JSON does not have.
        text = re.sub(r",(\s*[}\]])", r"\1", file.read_text(encoding="utf-8"))
        found[file.stem] = jsonschema.Draft202012Validator(json.loads(text))
    return found


def factsheet() -> dict[str, Any]:
    """Return what the vehicle is and can do."""
    scope = {"actionScopes": ["INSTANT"], "pauseAllowed": "false", "cancelAllowed": "false"}
    return {
        "typeSpecification": {
            "seriesName": "test",
            "mobileRobotKinematic": "DIFFERENTIAL",
            "mobileRobotClass": "CARRIER",
            "maximumLoadMass": 0.0,
            "localizationTypes": ["NATURAL"],
            "navigationTypes": ["AUTONOMOUS"],
        },
        "physicalParameters": {
            "minimumSpeed": 0.0,
            "maximumSpeed": 8.0,
            "maximumAcceleration": BRAKES,
            "maximumDeceleration": BRAKES,
            "minimumHeight": 0.5,
            "maximumHeight": 0.5,
            "width": 0.5,
            "length": 0.5,
        },
        "protocolLimits": {
            "maximumStringLengths": {},
            "maximumArrayLengths": {"order.nodes": 100},
            "timing": {"minimumOrderInterval": 0.1, "minimumStateInterval": 0.1},
        },
        "protocolFeatures": {
            "optionalParameters": [],
            "mobileRobotActions": [{"actionType": kind, **scope} for kind in ACTIONS],
        },
        "mobileRobotGeometry": {},
        "loadSpecification": {},
    }


class Vehicle:
    """Stands until an order comes, and drives from node to node of its base."""

    def __init__(self, given: dict[str, Any]) -> None:
        self.given = given
        self.x, self.y, self.theta, self.v = given["x"], given["y"], 0.0, 0.0
        self.schemas, self.numbers = schemas(), dict.fromkeys(("state", "visualization"), 0)
        self.inbox: queue.Queue[tuple[str, bytes]] = queue.Queue()
        self.order_id, self.update_id, self.newest = "", 0, b""
        self.nodes: list[Node] = []
        self.edges: list[Edge] = []
        self.last_node, self.last_sequence = "", 0
        self.is_cancelled = self.paused = False
        self.instant: dict[str, dict[str, Any]] = {}
        self.errors: list[dict[str, Any]] = []
        self.due = self.seen_due = 0.0
        self.client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        self.client.on_message = lambda _client, _data, message: self.inbox.put(
            (message.topic.split("/")[-1], message.payload)
        )

    def topic(self, name: str) -> str:
        return f"vda5050/v3/Acme/{self.given['serial']}/{name}"

    def run(self) -> None:
        self.client.will_set(
            self.topic("connection"), self.message("connection", connectionState="CONNECTION_BROKEN"), 1, True
        )
        self.client.connect("127.0.0.1", self.given["port"])
        self.client.subscribe([(self.topic("order"), 0), (self.topic("instantActions"), 0)])
        self.client.loop_start()
        self.publish("connection", qos=1, connectionState="ONLINE")
        print("vehicle is there", flush=True)
        while True:
            while not self.inbox.empty():
                self.receive(*self.inbox.get())
                self.due = 0.0
            self.drive()
            if time.monotonic() >= self.seen_due:
                self.seen_due = time.monotonic() + SEEN_EVERY
                self.publish("visualization", referenceStateHeaderId=self.numbers["state"], **self.place())
            if time.monotonic() >= self.due:
                self.due = time.monotonic() + STATE_EVERY
                self.publish("state", **self.state())
            time.sleep(TICK)

    # --- what it says ---

    def message(self, topic: str, **body: Any) -> str:
        number = self.numbers[topic] = self.numbers.get(topic, -1) + 1
        now = f"{datetime.now(timezone.utc):%Y-%m-%dT%H:%M:%S.%f}"[:-3] + "Z"
        head = {"headerId": number, "timestamp": now, "version": "3.0.0", "manufacturer": "Acme"}
        whole = {**head, "serialNumber": self.given["serial"], **body}
        self.check(topic, whole)
        return json.dumps(whole)

    def publish(self, topic: str, qos: int = 0, **body: Any) -> None:
        self.client.publish(self.topic(topic), self.message(topic, **body), qos, retain=qos == 1)

    def check(self, topic: str, body: Any) -> None:
        for error in self.schemas[topic].iter_errors(body) if topic in self.schemas else ():
            print(f"INVALID {topic} {error.json_path}: {error.message}", flush=True)

    def place(self) -> dict[str, Any]:
        here = {"x": self.x, "y": self.y, "theta": self.theta, "mapId": "local", "localized": True}
        return {"mobileRobotPosition": here, "velocity": {"vx": self.v, "vy": 0.0, "omega": 0.0}}

    def state(self) -> dict[str, Any]:
        nodes = [
            {"nodeId": n.node_id, "sequenceId": n.sequence_id, "released": n.released} for n in self.nodes
        ]
        edges = [
            {"edgeId": e.edge_id, "sequenceId": e.sequence_id, "released": e.released} for e in self.edges
        ]
        return {
            **self.place(),
            "orderId": self.order_id,
            "orderUpdateId": self.update_id,
            "lastNodeId": self.last_node,
            "lastNodeSequenceId": self.last_sequence,
            "nodeStates": nodes,
            "edgeStates": edges,
            "driving": self.v > 0,
            "paused": self.paused,
            "actionStates": [],
            "instantActionStates": list(self.instant.values()),
            "powerSupply": {"stateOfCharge": 66.0, "charging": False},
            "operatingMode": "AUTOMATIC",
            "errors": self.errors,
            "safetyState": {"activeEmergencyStop": "NONE", "fieldViolation": False},
        }

    # --- what it is sent ---

    def receive(self, topic: str, payload: bytes) -> None:
        try:
            self.check(topic, json.loads(payload))
            message = msgspec.json.decode(payload, type=SHAPES[topic])
        except msgspec.ValidationError as error:
            print(f"INVALID {topic}: {error}", flush=True)
            return
        if isinstance(message, Order):
            self.take_order(message)
        else:
            for action in message.actions:
                print(f"action {action.action_type}", flush=True)
                self.take_action(action)

    def refuse(self, kind: str, **references: str) -> None:
        listed = [{"referenceKey": key, "referenceValue": value} for key, value in references.items()]
        self.errors.append({"errorType": kind, "errorLevel": "WARNING", "errorReferences": listed})

    def take_order(self, order: Order) -> None:
        body = msgspec.json.encode([order.nodes, order.edges])
        about = {"orderId": order.order_id, "orderUpdateId": str(order.order_update_id)}
        if order.order_id == self.order_id:
            if order.order_update_id == self.update_id and body == self.newest:
                return
            if self.is_cancelled:
                self.refuse("ORDER_UPDATE_FOLLOWING_CANCEL", **about)
            elif order.order_update_id <= self.update_id:
                same = order.order_update_id == self.update_id
                self.refuse("SAME_ORDER_UPDATE_ID" if same else "OUTDATED_ORDER_UPDATE", **about)
            else:
                self.extend(order, about)
        elif self.nodes or self.edges:
            self.refuse("OTHER_ORDER_ACTIVE", orderId=order.order_id)
        elif any(node.node_position.map_id != self.given.get("knows", "local") for node in order.nodes):
            self.refuse("UNKNOWN_MAP_ID", orderId=order.order_id)
        elif not self.is_near(order.nodes[0].node_position):
            self.refuse("START_NODE_OUT_OF_RANGE", orderId=order.order_id)
        else:
            self.begin(order)
        if order.order_id == self.order_id and order.order_update_id == self.update_id:
            self.newest = body

    def is_near(self, node: NodePosition) -> bool:
        return math.dist((self.x, self.y), (node.x, node.y)) <= node.allowed_deviation_xy.a

    def begin(self, order: Order) -> None:
        print("order accepted", flush=True)
        self.order_id, self.update_id, self.is_cancelled = order.order_id, order.order_update_id, False
        self.errors = []
        self.last_node, self.last_sequence = order.nodes[0].node_id, order.nodes[0].sequence_id
        self.nodes, self.edges = order.nodes[1:], order.edges

    def extend(self, order: Order, about: dict[str, str]) -> None:
        nodes = [node for node in self.nodes if node.released]
        ends = (nodes[-1].node_id, nodes[-1].sequence_id) if nodes else (self.last_node, self.last_sequence)
        if ends != (order.nodes[0].node_id, order.nodes[0].sequence_id):
            self.refuse("VALIDATION_FAILURE", **about)
            return
        print("update accepted", flush=True)
        self.update_id = order.order_update_id
        self.nodes = nodes + order.nodes[1:]
        self.edges = [edge for edge in self.edges if edge.released] + order.edges

    def take_action(self, action: InstantAction) -> None:
        kind, values = action.action_type, {one.key: one.value for one in action.action_parameters}
        shown = {"actionId": action.action_id, "actionType": kind, "actionStatus": "FINISHED"}
        if kind in ("cancelOrder", "startPause"):
            shown["actionStatus"] = "RUNNING"
            if kind == "cancelOrder" and not (self.nodes or self.edges):
                shown["actionStatus"] = "FAILED"
                self.refuse("NO_ORDER_TO_CANCEL", actionId=action.action_id)
        elif kind == "stopPause":
            self.paused = False
        elif kind == "initializePosition":
            self.x, self.y, self.theta = values["x"], values["y"], values["theta"]
        elif kind == "clearInstantActions":
            ended = ("FINISHED", "FAILED")
            self.instant = {id: a for id, a in self.instant.items() if a["actionStatus"] not in ended}
        elif kind == "factsheetRequest":
            self.publish("factsheet", qos=1, **factsheet())
        elif kind != "stateRequest":
            shown["actionStatus"] = "FAILED"
            self.refuse("INVALID_INSTANT_ACTION", actionId=action.action_id)
        self.instant[action.action_id] = shown

    # --- how it drives ---

    def drive(self) -> None:
        running = [one for one in self.instant.values() if one["actionStatus"] == "RUNNING"]
        released = [node for node in self.nodes if node.released]
        if running or self.paused or not released:
            self.v = max(0.0, self.v - BRAKES * TICK)
        else:
            self.v = self.given.get("speed", 8.0)
        if running and self.v == 0.0:
            self.stand(running)
        elif self.v > 0 and released:
            self.go_on(released[0], self.v * TICK)

    def stand(self, running: list[dict[str, Any]]) -> None:
        for one in running:
            one["actionStatus"] = "FINISHED"
            if one["actionType"] == "startPause":
                self.paused = True
            else:
                self.nodes, self.edges, self.is_cancelled = [], [], True
        self.due = 0.0

    def go_on(self, node: Node, step: float) -> None:
        x, y = node.node_position.x, node.node_position.y
        left = math.dist((self.x, self.y), (x, y))
        if left > step:
            self.theta = math.atan2(y - self.y, x - self.x)
            self.x += step * (x - self.x) / left
            self.y += step * (y - self.y) / left
            return
        self.x, self.y = x, y
        self.nodes = [one for one in self.nodes if one is not node]
        self.edges = [edge for edge in self.edges if edge.sequence_id > node.sequence_id]
        self.last_node, self.last_sequence = node.node_id, node.sequence_id
        if not any(one.released for one in self.nodes):
            self.v = 0.0
        self.due = 0.0


def main() -> None:
    """Run one vehicle until the program is ended."""
    Vehicle(json.loads(sys.argv[1])).run()


if __name__ == "__main__":
    main()
