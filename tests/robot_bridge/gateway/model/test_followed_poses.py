"""Poses that are followed leave robots as those that are considered, whatever is odd about some of them."""

from __future__ import annotations

import math
import random
from dataclasses import asdict, replace
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from robot_bridge.core.errors import BridgeError
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.settings_tables import LimitSettings
from robot_bridge.gateway.model.events import EventBus, RobotReturned
from robot_bridge.gateway.model.position_checks import PlaceChecks
from robot_bridge.gateway.model.robot_columns import RobotColumns
from robot_bridge.gateway.model.robots import Robots

LIMITS = LimitSettings(place_within_m=60.0, leap_m=100.0)
BOUNDS = SiteBounds(0.0, 0.0, 100.0, 100.0)
SITE = SiteSettings("s", "S", 1, "EPSG:32633", (0.0, 0.0), BOUNDS, limits=LIMITS)
LINK, ROUNDS, STEP = "yard", 250, 0.1


class Side:
    """Robots whose poses are considered one by one, or followed where there is nothing to consider."""

    ODD: ClassVar = (
        *("late", "outside", "leap", "standing", "fix", "magic"),
        *("silent", "stopped", "other link", "anew"),
        *("battery", "status", "accuracy"),
    )

    def __init__(self, names, *, follows):
        events = EventBus()
        self.robots, self.follows = Robots(events=events), follows
        self.checks = PlaceChecks(SimpleNamespace(settings=SITE))
        self.followed = 0
        self.back, self.unseen = [], []
        events.subscribe(RobotReturned, lambda one: self.back.append((one.robot, round(one.away_s, 3))))
        for number, name in enumerate(names):
            self.robots.ready(name, number + 1, LINK, 0.0)

    def receive(self, poses, now):
        for name, pose in poses:
            moved = self.robots.follow(name, pose, LINK, now, self.checks.near()) if self.follows else None
            self.followed += bool(moved)
            if moved is None:
                self._receive_one(name, pose, now)

    def _receive_one(self, name, pose, now):
        try:
            self.robots.check_run(name, pose.magic, LINK)
        except BridgeError:
            return
        fault = self.checks.fault(self.robots.get(name), (pose.x, pose.y), now)
        if fault is not None:
            self.robots.disbelieve(name, LINK, now, fault)
            return
        unseen = self.robots.is_unseen(name, now)
        if self.robots.observe(name, pose, LINK, now) and unseen:
            self.unseen.append((name, now))

    def happen(self, odd, name, now):
        if odd == "stopped":
            self.robots.note_received(name, LINK, now, stopped=True)
        elif odd == "other link":
            self.robots.note_received(name, "other", now)
        elif odd == "anew":
            self.robots.ready(name, round(now * 1000), LINK, now)
        elif odd == "silent":
            self.robots.age(now)

    def rows(self):
        """What the columns say of each robot, and what they would say if all were written now."""
        fresh = RobotColumns()
        for robot in self.robots.own():
            fresh.write(robot)
        return [
            {
                name: (
                    *np.nan_to_num(places.table[:, row], nan=-1.0).tolist(),
                    places.states[row],
                    places.flags[row],
                )
                for row, name in enumerate(places.names)
            }
            for places in (self.robots.own_places(), fresh.places())
        ]

    def details(self):
        """What other gateways need to know of each robot once it has changed."""
        return {
            one.name: (one.doubt, one.pose and one.pose.battery, one.pose and one.pose.status)
            for one in self.robots.own()
        }

    def state(self):
        names = self.robots.names()
        return (
            self.back,
            self.unseen,
            [{**asdict(self.robots.get(name)), "revision": 0, "described": 0} for name in names],
        )


def odd_pose(pose, odd, chance):
    if odd == "late":
        return replace(pose, t=pose.t - chance.uniform(0.2, 60))
    if odd == "outside":
        return replace(pose, y=-70.0 + pose.y)
    if odd == "leap":
        far = chance.choice((-110.0, 110.0))
        return replace(pose, x=pose.x + far) if chance.random() < 0.5 else replace(pose, y=pose.y + far)
    if odd == "magic":
        return replace(pose, magic=chance.choice((1, 5)))
    if odd in ("battery", "accuracy"):
        return replace(pose, **{odd: chance.choice((0.1, 0.2, 0.5))})
    if odd == "status":
        return replace(pose, status=chance.choice(("busy", "idle")))
    if odd == "standing":
        return replace(pose, v=0.0, t=None)
    return replace(pose, fix_t=pose.t - chance.uniform(0, 1)) if odd == "fix" else pose


def test_poses_that_are_followed_leave_robots_as_those_that_are_considered():
    chance = random.Random(3)
    names = [f"r{n}" for n in range(8)]
    considered, followed = Side(names, follows=False), Side(names, follows=True)
    now = 1000.0
    for number in range(ROUNDS):
        now += STEP
        poses = []
        for n, name in enumerate([*names, "ghost"]):
            odd = chance.choice(Side.ODD) if chance.random() < 0.08 else None
            if odd == "silent":
                now += chance.choice((0.0, 3.1, 11.0))
            for side in (considered, followed):
                side.happen(odd, name, now) if name != "ghost" else None
            if odd != "silent":
                poses.append((name, odd_pose(SendPos(number * STEP, n + 0.5, 0.0, 1.0, t=now), odd, chance)))
        for side in (considered, followed):
            before, since = side.details(), side.robots.revision
            side.receive(poses, now)
            changed = {name for name, details in side.details().items() if details != before[name]}
            assert changed <= {robot.name for robot in side.robots.own_described(since)}, (number, now)
        assert followed.state() == considered.state(), (number, now)
        for side in (considered, followed):
            rows, written = side.rows()
            assert rows == written, (number, now)
            since = side.robots.revision - chance.randrange(12)
            changed = {robot.name for robot in side.robots.own(since)}
            assert set(side.robots.own_places(since).names) == changed
    # Nearly all poses of a fleet that drives need no second look.
    assert followed.followed > ROUNDS * len(names) / 3


def test_every_pose_that_is_followed_has_a_revision_of_its_own():
    side = Side(["a", "b"], follows=True)
    for now in (1.0, 1.1):
        since = side.robots.revision
        side.receive([(name, SendPos(1.0, 1.0, 0.0, 1.0)) for name in "ab"], now)
        assert sorted(one.revision - since for one in side.robots.changed(since)) == [1, 2]
    assert side.followed == 2


def test_a_robot_that_was_lost_by_shorter_limits_is_back():
    side = Side(["a"], follows=True)
    side.receive([("a", SendPos(1.0, 1.0, 0.0, 1.0))], 1.0)
    side.robots.limit(1.0, 2.0)
    side.robots.age(4.0)
    side.robots.limit(30.0, 60.0)
    side.receive([("a", SendPos(1.0, 1.0, 0.0, 1.0))], 4.0)
    assert (side.back, side.robots.get("a").state) == ([("a", 3.0)], RobotState.FRESH)


def test_where_poses_need_no_second_look_is_as_the_settings_are_now():
    site = SimpleNamespace(settings=SITE)
    checks = PlaceChecks(site)
    assert checks.near()[:4] == (-60.0, -60.0, 160.0, 160.0)
    site.settings = replace(SITE, limits=replace(LIMITS, place_within_m=10.0, leap_m=7.0))
    assert checks.near() == pytest.approx((-10.0, -10.0, 110.0, 110.0, 7.0 / math.sqrt(2)))
