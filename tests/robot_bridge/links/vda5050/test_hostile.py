"""What anybody who may publish at the broker can do to the adapter, tried."""

from __future__ import annotations

import asyncio
import json
import logging
import random

import pytest

from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.base.settings import read_settings
from robot_bridge.links.vda5050.adapter import Vda5050Adapter
from robot_bridge.links.vda5050.ledger import Keep, Publish
from robot_bridge.links.vda5050.messages import Action, InstantActions, Order
from robot_bridge.links.vda5050.settings import Vda5050Settings
from robot_bridge.links.vda5050.tasks import Remembered
from robot_bridge.links.vda5050.vehicle import VehicleController
from tests.robot_bridge.links.vda5050.bench import state


@pytest.fixture
def adapter(tmp_path):
    return make(tmp_path)


def make(folder, *lines):
    file = folder / "yard.toml"
    file.write_text("\n".join(["[vda5050]", *lines]), encoding="utf-8")
    return Vda5050Adapter(*read_settings(file, "vda5050", Vda5050Settings))


def head(serial, manufacturer="Acme", **more):
    return {
        "headerId": 1,
        "timestamp": "2026-11-23T12:00:00.00Z",
        "version": "2.1.0",
        "manufacturer": manufacturer,
        "serialNumber": serial,
        **more,
    }


def online(adapter, serial, manufacturer="Acme"):
    body = head(serial, manufacturer, connectionState="ONLINE")
    adapter.receive(f"uagv/v2/{manufacturer}/{serial}/connection", json.dumps(body).encode())


def test_thousands_of_serial_numbers_make_no_thousands_of_vehicles(tmp_path, caplog):
    adapter = make(tmp_path, "most_vehicles = 5")
    for number in range(2000):
        online(adapter, f"agv-{number}")
    assert len(adapter.vehicles) == 5
    assert len(caplog.records) < 20


def test_what_nobody_foresaw_in_a_message_concerns_its_vehicle_alone(adapter, monkeypatch, caplog):
    receive = VehicleController.receive_message

    def failing_for_the_first(self, message, *arguments, **more):
        if self.vehicle.serial_number == "1":
            raise ZeroDivisionError("nobody foresaw it")
        receive(self, message, *arguments, **more)

    monkeypatch.setattr(VehicleController, "receive_message", failing_for_the_first)
    online(adapter, "1")
    online(adapter, "2")
    assert len(adapter.vehicles) == 2
    assert "vehicle Acme/1: internal error" in caplog.text


def test_who_speaks_for_another_vehicle_is_refused(adapter, caplog):
    adapter.receive("uagv/v2/Acme/1/connection", json.dumps(head("2", connectionState="ONLINE")).encode())
    assert adapter.vehicles == []
    assert "vehicle Acme/1: connection: it says to be of 'Acme'/'2'" in caplog.text


def test_a_second_manufacturer_takes_no_robots_name(adapter, caplog):
    online(adapter, "agv-1")
    online(adapter, "agv-1", "Other")
    assert adapter.vehicles == ["agv-1"]
    assert "robot 'agv-1' is Acme/agv-1 already" in caplog.text


def test_only_listed_vehicles_are_led(tmp_path):
    adapter = make(
        tmp_path, "[[vda5050.vehicles]]", 'manufacturer = "Acme"', 'serial = "7"', 'robot = "agv-7"'
    )
    online(adapter, "7")
    online(adapter, "8")
    assert adapter.vehicles == ["agv-7"]


def test_a_flood_of_nonsense_is_counted_and_not_written(adapter, caplog):
    caplog.set_level(logging.WARNING)
    for _ in range(500):
        adapter.receive("uagv/v2/Acme/1/state", b"[" * 10_000)
        adapter.receive("uagv/v2/Acme/1/state", b"x" * (2 << 20))
    assert len(caplog.records) < 20


def test_changed_messages_end_nothing(adapter, caplog):
    """Of 500 states bytes are changed, cut off or put in; those that pass are dealt with."""
    dice = random.Random(5050)
    online(adapter, "1")
    whole = json.dumps(head("1", **state())).encode()
    adapter.receive("uagv/v2/Acme/1/state", whole)
    for _ in range(500):
        bad = bytearray(whole)
        for _ in range(dice.randint(1, 6)):
            place = dice.randrange(len(bad))
            bad[place : place + dice.randint(0, 3)] = dice.randbytes(dice.randint(0, 3))
        adapter.receive("uagv/v2/Acme/1/state", bytes(bad))
    assert "Traceback" not in caplog.text and "internal error" not in caplog.text
    adapter.receive("uagv/v2/Acme/1/state", whole)
    assert adapter.vehicles == ["1"]


@pytest.mark.parametrize("kind", ["state", "connection", "factsheet", "visualization", "order"])
@pytest.mark.parametrize("payload", [b"", b"null", b"{}", b"[]", b'"x"', b"1e400", b'{"errors": null}'])
def test_what_is_no_message_ends_nothing(adapter, caplog, kind, payload):
    adapter.receive(f"uagv/v2/Acme/1/{kind}", payload)
    assert "internal error" not in caplog.text


async def test_what_nobody_foresaw_of_one_vehicle_keeps_no_other_from_its_turn(adapter, monkeypatch, caplog):
    online(adapter, "first")
    online(adapter, "second")
    first, second = adapter._vehicles.values()
    turns = []

    def fail(now):
        turns.append("first")
        raise KeyError("odd")

    monkeypatch.setattr(first.controller, "advance", fail)
    monkeypatch.setattr(second.controller, "advance", lambda now: turns.append("second"))
    ticking = asyncio.create_task(adapter._tick())
    while len(turns) < 4:
        await asyncio.sleep(0.01)
        assert not ticking.done(), turns
    ticking.cancel()
    assert turns[:4] == ["first", "second"] * 2
    assert "vehicle Acme/first" in caplog.text


def carry_out(adapter, *messages):
    """Have the adapter publish what its vehicle's controller says; return what waits, urgent first."""
    (vehicle,) = adapter._vehicles.values()
    vehicle.controller.drain()
    vehicle.controller.drain = lambda: [Keep(Remembered()), *map(Publish, messages)]
    adapter._broker._is_connected = True
    adapter._carry_out(vehicle)
    queues = adapter._broker._urgent, adapter._broker._outgoing
    return [[topic.rpartition("/")[2] for topic, _ in queue] for queue in queues]


ORDER = Order(order_id="7", order_update_id=0, nodes=[], edges=[])
CANCEL = InstantActions(actions=[Action(action_type="cancelOrder", action_id="a")])


def test_a_stop_comes_before_all_orders_and_takes_back_its_own_that_still_waits(adapter):
    online(adapter, "1")
    assert carry_out(adapter, ORDER) == [[], ["order"]]
    assert carry_out(adapter, CANCEL) == [["instantActions"], []]


def test_an_emergency_stop_reaches_vehicles_that_have_said_no_state(adapter, monkeypatch, caplog):
    for serial in ("1", "2", "3"):
        online(adapter, serial)
    first, _, third = adapter._vehicles.values()
    monkeypatch.setattr(first.controller, "halt", lambda now, *, emergency: [].pop())
    third.is_introduced = True
    adapter._broker._is_connected = True
    adapter._broker._urgent.clear()
    adapter.stop_unannounced()
    sent = [(topic, json.loads(payload)["actions"]) for topic, payload in adapter._broker._urgent]
    assert [(topic, [one["actionType"] for one in actions]) for topic, actions in sent] == [
        ("uagv/v2/Acme/2/instantActions", ["cancelOrder"]),
        ("uagv/v2/Acme/2/instantActions", ["startPause"]),
    ]
    assert "vehicle Acme/1" in caplog.text


def test_on_a_full_disk_no_order_is_published_and_every_stop_is(adapter, tmp_path, caplog):
    online(adapter, "1")
    (tmp_path / "yard.vehicles").write_text("no folder", encoding="utf-8")
    assert carry_out(adapter, ORDER) == [[], []]
    assert carry_out(adapter, CANCEL) == [["instantActions"], []]
    assert "vehicle Acme/1" in caplog.text


@pytest.mark.parametrize("table", ["frame", "vda5050.maps.hall"])
def test_coordinates_in_degrees_are_refused(tmp_path, table):
    with pytest.raises(LinkError, match=f"{table}.crs = 'wgs84': these robots are sent metres"):
        make(tmp_path, f"[{table}]", 'crs = "wgs84"')
