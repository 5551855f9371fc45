"""Many VDA 5050 vehicles at one broker: ``vda_crowd.py PORT VEHICLES RATE``; they drive without an order."""

from __future__ import annotations

import json
import sys
import time
from datetime import UTC, datetime
from typing import Any

import paho.mqtt.client as mqtt

MAKER = "Bench"


def body(n: int, number: int, **more: Any) -> str:
    """Return a message of vehicle ``n`` as JSON."""
    stamp = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    head = {"headerId": number, "timestamp": stamp, "version": "2.1.0", "manufacturer": MAKER}
    return json.dumps({**head, "serialNumber": f"agv-{n}", **more})


def state(n: int, number: int) -> str:
    """Return the state of vehicle ``n``, a metre further than the one before."""
    place = {"x": 10.0 + n % 30 + number % 50, "y": 20.0 + n / 10, "theta": 0.0, "mapId": "yard"}
    return body(
        n,
        number,
        **{"orderId": "", "orderUpdateId": 0, "lastNodeId": "", "lastNodeSequenceId": 0},
        **{"driving": True, "paused": False, "operatingMode": "AUTOMATIC", "nodeStates": []},
        **{"edgeStates": [], "actionStates": [], "errors": [], "information": [], "loads": []},
        batteryState={"batteryCharge": 80.0, "charging": False},
        safetyState={"eStop": "NONE", "fieldViolation": False},
        agvPosition={**place, "positionInitialized": True},
        velocity={"vx": 1.0, "vy": 0.0, "omega": 0.0},
    )


def main(port: int, vehicles: int, rate: float) -> None:
    """Publish the states of all vehicles, evenly, until killed."""
    client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
    client.max_inflight_messages_set(10_000)
    client.connect("127.0.0.1", port)
    client.loop_start()
    topics = [f"uagv/v2/{MAKER}/agv-{n}" for n in range(vehicles)]
    for n, topic in enumerate(topics):
        client.publish(f"{topic}/connection", body(n, 1, connectionState="ONLINE"), qos=1, retain=True)
    print("up", flush=True)
    begin, number, gap = time.monotonic(), 0, 1 / (vehicles * rate)
    while True:
        while begin + number * gap <= time.monotonic():
            n = number % vehicles
            client.publish(f"{topics[n]}/state", state(n, number // vehicles + 1))
            number += 1
        time.sleep(0.005)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]))
