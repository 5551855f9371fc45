"""Virtual vehicles at a real broker, led from a desk through a real gateway and adapter."""

from __future__ import annotations

import signal

from tests.robot_bridge.links.vda5050.driving import (
    SLOW,
    abort_on_the_way,
    begin,
    begin_sdk,
    reason,
    replace_on_the_way,
    send,
    steps,
    wait_at,
    wait_for_standing,
    wait_under_way,
)
from tests.support.bridge.bridge_programs import wait_until
from tests.support.processes import freeze


def test_a_target_is_reached(desk, vehicle):
    wait_at(desk, vehicle, 20.0, 8.0)
    command = send(desk, vehicle, x=40.0, y=8.0)
    desk.wait_for_step(command, "reached")
    wait_at(desk, vehicle, 40.0, 8.0)
    assert steps(desk, command) == ["queued", "delivered", "acknowledged", "reached"]


def test_a_route_is_followed(desk, vehicle):
    points = [[20.0, 8.0], [55.0, 8.0], [55.0, 14.0], [40.0, 14.0]]
    command = send(desk, vehicle, "SetPath", points=points)
    desk.wait_for_step(command, "reached", 60)
    wait_at(desk, vehicle, 40.0, 14.0)


def test_a_vehicle_of_another_make_follows_a_route_and_stops(desk, yard):
    vehicle = begin_sdk(yard, desk)
    points = [[20.0, 8.0], [55.0, 8.0], [55.0, 14.0], [40.0, 14.0]]
    command = send(desk, vehicle, "SetPath", points=points)
    desk.wait_for_step(command, "reached", 60)

    drive = send(desk, vehicle, "SetPath", points=[[40.0, 14.0], [80.0, 14.0], [80.0, 12.0]])
    abort_on_the_way(desk, vehicle, drive, 42.0)


def test_what_the_vehicle_refuses_fails_with_its_words(desk, yard):
    vehicle = begin_sdk(yard, desk, maps=["attic"])
    command = send(desk, vehicle, x=40.0, y=8.0)
    desk.wait_for_step(command, "failed")
    assert "maps not available on the vehicle: local" in reason(desk, command)


def test_another_target_on_the_way_takes_the_place_of_the_first(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    replace_on_the_way(desk, vehicle)


def test_an_abort_stops_it(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    drive = send(desk, vehicle, x=90.0, y=8.0)
    abort_on_the_way(desk, vehicle, drive)


def test_an_emergency_stop_stops_it_until_it_is_cleared_and_sent_again(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    drive = send(desk, vehicle, x=90.0, y=8.0)
    wait_under_way(desk, vehicle)
    desk.ask("emergency_stop", {"reason": "test"})
    try:
        desk.wait_for_step(drive, "aborted")
        wait_for_standing(desk, vehicle)
        desk.until(lambda: "paused" in (desk.robots[vehicle].get("status") or ""))
    finally:
        desk.ask("clear_emergency_stop", {"reason": "test"})
    assert wait_for_standing(desk, vehicle) < 80.0
    again = send(desk, vehicle, x=20.0, y=12.0)
    desk.wait_for_step(again, "reached")


def test_a_vehicle_that_does_not_answer_to_an_abort_is_said(desk, yard):
    vehicle = begin(yard, desk, speed=SLOW)
    send(desk, vehicle, x=90.0, y=8.0)
    wait_under_way(desk, vehicle)
    freeze(yard.running[vehicle].pid)
    abort = send(desk, vehicle, "Abort")
    desk.wait_for_step(abort, "failed")
    assert "DOES NOT ANSWER cancelOrder: stop it at the vehicle" in reason(desk, abort)

    # It is told on and on, and stops when it comes to itself.
    yard.running[vehicle].send_signal(signal.SIGCONT)
    assert wait_for_standing(desk, vehicle) < 80.0


def test_a_start_position_is_the_vehicles_own_from_then_on(desk, vehicle):
    command = send(desk, vehicle, "SetPosIni", x=60.0, y=30.0, theta=0.5)
    desk.until(lambda: "acknowledged" in steps(desk, command))
    wait_at(desk, vehicle, 60.0, 30.0)


def test_what_others_publish_ends_nothing(desk, yard, vehicle):
    hostile = [
        ("uagv/v2/Acme/x%00y/state", "{}"),
        (f"uagv/v2/Acme/{vehicle}/state", "[" * 5000),
        (f"uagv/v2/Acme/{vehicle}/state", '{"headerId": 1}'),
        (f"uagv/v2/Acme/{vehicle}/connection", '{"connectionState": "GONE"}'),
        ("uagv/v2/Acme/../state", "{}"),
        ("uagv/v2/Acme/-bad name-/connection", ONLINE % ("Acme", "-bad name-")),
        (f"uagv/v2/Acme/{vehicle}/factsheet", "NaN"),
        (f"uagv/v2/Other/{vehicle}/connection", ONLINE % ("Other", vehicle)),
        (f"uagv/v2/Acme/{vehicle}/connection", ONLINE % ("Somebody", "else")),
    ]
    for topic, payload in hostile:
        yard.publish(topic, payload)
    command = send(desk, vehicle, x=30.0, y=8.0)
    desk.wait_for_step(command, "reached")
    assert "Traceback" not in yard.output("adapter")
    wait_until(lambda: f"robot '{vehicle}' is Acme/{vehicle} already" in yard.output("adapter"))


ONLINE = (
    '{"headerId": 1, "timestamp": "2026-11-23T12:00:00Z", "version": "2.0.0", "manufacturer": "%s",'
    ' "serialNumber": "%s", "connectionState": "ONLINE"}'
)
