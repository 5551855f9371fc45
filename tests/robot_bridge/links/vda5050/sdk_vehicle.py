"""A vehicle of vda5050-sdk, which checks messages by the schemas of 2.1; argument: '{"port": 1883, ...}'."""

from __future__ import annotations

import asyncio
import itertools
import json
import math
import sys
from typing import Any

from vda5050 import VehicleClient, VehicleConfig
from vda5050.model.state import Map

STEP, PUBLISH_EVERY = 0.05, 5
"""s, and how many of them; each message is checked by the schemas."""


async def run(given: dict[str, Any]) -> None:
    vehicle = VehicleClient(
        VehicleConfig(
            manufacturer="Acme",
            serial_number=given["serial"],
            broker_url=f"mqtt://127.0.0.1:{given['port']}",
            validate_messages=True,
        )
    )
    released: dict[int, Any] = {}

    @vehicle.on_order
    async def add(order: Any) -> None:
        if order.order_update_id == 0:
            released.clear()
        released.update({node.sequence_id: node for node in order.nodes if node.released})

    async with vehicle:
        publisher = vehicle.publisher
        publisher.update_position(x=given["x"], y=given["y"], theta=0.0, map_id="local")
        if given.get("maps"):
            publisher.set_maps([Map(map_id=m, map_version="1", map_status="ENABLED") for m in given["maps"]])
        print("vehicle is there", flush=True)
        for number in itertools.count():
            left = len(released)
            drive(vehicle, released, given.get("speed", 8.0) * STEP)
            if number % PUBLISH_EVERY == 0 or len(released) != left:
                await publisher.publish()
            await asyncio.sleep(STEP)


def drive(vehicle: VehicleClient, released: dict[int, Any], step: float) -> None:
    """Drive a step to the next released node that is left; what cancelOrder cleared is not driven."""
    publisher = vehicle.publisher
    if not publisher.node_states and not publisher.edge_states:
        released.clear()
    if not released or publisher.paused:
        publisher.set_driving(False)
        return
    number = min(released)
    node, place = released[number], publisher.agv_position
    left = math.dist((place.x, place.y), (node.node_position.x, node.node_position.y))
    share = 1.0 if left <= step else step / left
    publisher.set_driving(True)
    publisher.update_position(
        x=place.x + share * (node.node_position.x - place.x),
        y=place.y + share * (node.node_position.y - place.y),
        theta=0.0,
        map_id=place.map_id,
    )
    if share == 1.0:
        del released[number]
        publisher.set_driving(bool(released))
        publisher.mark_node_traversed(node.node_id, number)


def main() -> None:
    """Run one vehicle until the program is ended."""
    asyncio.run(run(json.loads(sys.argv[1])))


if __name__ == "__main__":
    main()
