"""A vehicle's controller with the gateway and the vehicle played by hand."""

from __future__ import annotations

import itertools
import json
from typing import Any

from fleet_supervisor.robot_bridge.core.messages.robots import Request, SetPath, SetPosEnd, SetPosIni
from fleet_supervisor.robot_bridge.links.vda5050.ledger import Halted, Keep, Publish, Settled, VehicleReport
from fleet_supervisor.robot_bridge.links.vda5050.messages import Order, VehicleId, decode_message
from fleet_supervisor.robot_bridge.links.vda5050.tasks import Remembered
from fleet_supervisor.robot_bridge.links.vda5050.vehicle import VehicleController, VehicleSettings

VEHICLE = VehicleId("Acme", "agv-1")


class ShiftedMap:
    """A map whose origin is (100, 50) of the site frame."""

    def to_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        return x + 100, y + 50, theta

    def from_site(self, x: float, y: float, theta: float) -> tuple[float, float, float]:
        return x - 100, y - 50, theta


class CountedNames:
    """action-1, action-2, and so on."""

    def __init__(self) -> None:
        self._counter = itertools.count(1)

    def draw(self) -> str:
        """Return the next one."""
        return f"action-{next(self._counter)}"


class Bench:
    """Time stands until a test lets it pass; the vehicle speaks ``version``."""

    def __init__(self, remembered: Remembered | None = None, version: str = "2.1.0", **settings: Any) -> None:
        self.version = version
        self.now = 1000.0
        self.header = itertools.count(1)
        self.state = state()
        self.controller = VehicleController(
            VEHICLE,
            VehicleSettings(**settings, version=version),
            {"hall": ShiftedMap()},
            remembered,
            CountedNames(),
            self.now,
        )
        self.sent: list[Request] = []
        self.published: list[Any] = []
        self.settled: list[Settled] = []
        self.halts = 0
        self.kept: Remembered | None = remembered
        self.effects: list[Any] = []

    def connect(self) -> None:
        self.hear("connection", {"connectionState": "ONLINE"})
        self.show()
        self.admit()
        self.clear()

    def admit(self) -> None:
        self.controller.set_admitted(True, self.now)
        self.collect()

    def hear(self, topic: str, body: dict[str, Any], *, retained: bool = False) -> None:
        head = {
            "headerId": next(self.header),
            "timestamp": "2026-11-23T12:00:00.00Z",
            "version": self.version,
            "manufacturer": VEHICLE.manufacturer,
            "serialNumber": VEHICLE.serial_number,
        }
        major = self.version[0]
        body = {**head, **(body if major == "2" else of_3_0(topic, body))}
        message = decode_message(topic, json.dumps(body).encode(), major)
        self.controller.receive_message(message, self.now, retained=retained)
        self.collect()

    def show(self, **changes: Any) -> None:
        """Have the vehicle publish its state with these changes."""
        self.state.update(changes)
        self.hear("state", self.state)

    def accept(self, order: Order, passed: int = 0) -> None:
        """Have the vehicle show an order, of which it is behind node ``passed``."""
        nodes = [
            {"nodeId": node.node_id, "sequenceId": node.sequence_id, "released": node.released}
            for node in order.nodes
            if node.sequence_id > 2 * passed
        ]
        edges = [
            {"edgeId": edge.edge_id, "sequenceId": edge.sequence_id, "released": edge.released}
            for edge in order.edges
            if edge.sequence_id > 2 * passed
        ]
        self.show(
            orderId=order.order_id,
            orderUpdateId=order.order_update_id,
            nodeStates=nodes,
            edgeStates=edges,
            lastNodeSequenceId=2 * passed,
            lastNodeId=f"{order.order_id}-{passed}",
            driving=bool(nodes),
        )

    def tell(self, message: SetPosEnd | SetPath | SetPosIni, command_id: int, *, again: bool = False) -> None:
        self.controller.command(message, command_id, self.now, again=again)
        self.collect()

    def halt(self, *, emergency: bool = False) -> None:
        self.controller.halt(self.now, emergency=emergency)
        self.collect()

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds * 4)):
            self.now += 0.25
            self.controller.advance(self.now)
            self.collect()

    def live(self, seconds: int) -> None:
        """Wait while the vehicle publishes its state every second."""
        for _ in range(seconds):
            self.show()
            self.wait(1)

    def collect(self) -> None:
        for effect in self.controller.drain():
            self.effects.append(effect)
            if isinstance(effect, VehicleReport):
                self.sent.append(effect.request)
            elif isinstance(effect, Publish):
                self.published.append(effect.message)
            elif isinstance(effect, Settled):
                self.settled.append(effect)
            elif isinstance(effect, Halted):
                self.halts += 1
            elif isinstance(effect, Keep):
                self.kept = effect.remembered

    def clear(self) -> None:
        for seen in (self.sent, self.published, self.settled, self.effects):
            seen.clear()

    @property
    def orders(self) -> list[Order]:
        return [message for message in self.published if isinstance(message, Order)]

    @property
    def actions(self) -> list[str]:
        """The instant actions that stop, pause or place the vehicle, without questions."""
        done = [action for m in self.published if not isinstance(m, Order) for action in m.actions]
        return [action.action_type for action in done if not action.action_type.endswith("Request")]

    def action_id(self, action_type: str) -> str:
        done = [action for m in self.published if not isinstance(m, Order) for action in m.actions]
        return [action.action_id for action in done if action.action_type == action_type][-1]

    def saying(self, kind: type[Request]) -> list[Any]:
        return [request for request in self.sent if isinstance(request, kind)]


def state() -> dict[str, Any]:
    """A vehicle that stands at (0, 0) of its map and has no order."""
    return {
        "orderId": "",
        "orderUpdateId": 0,
        "lastNodeId": "",
        "lastNodeSequenceId": 0,
        "driving": False,
        "paused": False,
        "operatingMode": "AUTOMATIC",
        "nodeStates": [],
        "edgeStates": [],
        "actionStates": [],
        "batteryState": {"batteryCharge": 80.0, "charging": False},
        "errors": [],
        "safetyState": {"eStop": "NONE", "fieldViolation": False},
        "agvPosition": {"x": 0.0, "y": 0.0, "theta": 0.0, "mapId": "hall", "positionInitialized": True},
        "velocity": {"vx": 0.0, "vy": 0.0, "omega": 0.0},
    }


def of_3_0(topic: str, body: dict[str, Any]) -> dict[str, Any]:
    """What a vehicle of 3.0 publishes in place of ``body``, which is of 2.1."""
    told = dict(body)
    if topic == "connection":
        broken = body["connectionState"] == "CONNECTIONBROKEN"
        return {"connectionState": "CONNECTION_BROKEN"} if broken else told
    if (position := told.pop("agvPosition", None)) is not None:
        localized = {"localized": position["positionInitialized"]}
        told["mobileRobotPosition"] = {
            **{name: value for name, value in position.items() if name != "positionInitialized"},
            **localized,
        }
    if topic == "state":
        battery, safety = told.pop("batteryState"), told["safetyState"]
        told["powerSupply"] = {"stateOfCharge": battery["batteryCharge"], "charging": battery["charging"]}
        told["safetyState"] = {
            "activeEmergencyStop": safety["eStop"],
            "fieldViolation": safety["fieldViolation"],
        }
        actions = told.pop("actionStates")
        # Those of orders are none that a bench knows: what it publishes are instant actions.
        told["actionStates"], told["instantActionStates"] = [], actions
    return told


def fault(text: str, level: str = "WARNING", **references: str) -> dict[str, Any]:
    """An error of a vehicle that refers to what is named."""
    listed = [{"referenceKey": key, "referenceValue": value} for key, value in references.items()]
    return {
        "errorType": "orderError",
        "errorDescription": text,
        "errorLevel": level,
        "errorReferences": listed,
    }
