"""What the tests with real vehicles do at a desk: begin, send, wait for what is seen."""

from __future__ import annotations

import itertools
import math

import pytest

NUMBERS = itertools.count(1)
SLOW = 2.0
"""m/s of vehicles that are to be met on their way."""


def begin(yard, desk, x=20.0, y=8.0, **options):
    name = f"agv-{next(NUMBERS)}"
    yard.start_vehicle(name, x, y, **options)
    desk.wait_for_robots(name)
    return name


def wait_at(desk, name, x, y):
    """Wait until a vehicle is seen at (x, y)."""
    desk.until(lambda: math.dist((desk.robots[name]["x"], desk.robots[name]["y"]), (x, y)) <= 0.2)


def wait_under_way(desk, name, x=20.0):
    desk.until(lambda: desk.robots[name]["x"] > x + 1)


def wait_for_standing(desk, name):
    """Wait until a vehicle is seen to stand, and is at the same place a second later; return where."""
    place = math.inf
    while True:
        desk.until(lambda: desk.robots[name]["state"] == "fresh" and desk.robots[name]["v"] == 0.0)
        before, place = place, desk.robots[name]["x"]
        if abs(place - before) <= 0.01:
            return place
        desk.listen(1.0)


def send(desk, name, op="SetPosEnd", **params):
    command = f"command-{next(NUMBERS)}"
    desk.send(command, name, op, **params)
    return command


def replace_on_the_way(desk, vehicle):
    """Give a SLOW vehicle that is under way another target; assert that it drives there instead."""
    first = send(desk, vehicle, x=90.0, y=8.0)
    wait_under_way(desk, vehicle)
    second = send(desk, vehicle, x=20.0, y=10.0)
    desk.wait_for_step(second, "reached")
    assert desk.commands[first]["state"] == "superseded"


def abort_on_the_way(desk, vehicle, drive, x=20.0):
    """Abort ``drive`` once the vehicle is beyond ``x``; assert that it stands before x = 79."""
    wait_under_way(desk, vehicle, x)
    abort = send(desk, vehicle, "Abort")
    desk.wait_for_step(abort, "acknowledged")
    desk.wait_for_step(drive, "aborted")
    assert wait_for_standing(desk, vehicle) < 79.0


def steps(desk, command):
    return [step["state"] for step in desk.commands[command]["steps"]]


def reason(desk, command):
    return desk.commands[command]["steps"][-1]["reason"]


def begin_sdk(yard, desk, **options):
    """A vehicle of version 2.1 that stands at (20, 8)."""
    pytest.importorskip("vda5050", reason="vda5050-sdk is missing; make setup installs it")
    name = f"agv-{next(NUMBERS)}"
    yard.start_sdk_vehicle(name, 20.0, 8.0, **options)
    desk.wait_for_robots(name)
    return name


def orders_of(yard, vehicle):
    """How often a vehicle took on a new order, by its own log."""
    return {"accepted as new": yard.output(vehicle).count("Order accepted with mode 'new'")}
