"""What the geofence does when a stop cannot be done at once, is not needed, or cannot be judged."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import numpy as np
import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.records import GetObservations, ReviewObservation
from robot_bridge.core.messages.robots import Alive, SetObject
from robot_bridge.core.messages.safety import EmergencyStop, FenceAlarm, Geofence
from robot_bridge.core.sites.fences import Fences
from robot_bridge.core.sites.settings_tables import GeofenceSettings
from robot_bridge.gateway.cluster.robot_relay import REPORT_HOLDS_S
from robot_bridge.gateway.fleet import geofence as watch
from robot_bridge.gateway.model.events import FenceJudged, FenceJudgedElsewhere, RobotClaimed, RobotLeft
from robot_bridge.gateway.model.fence_stays import LEFT_AFTER_S
from robot_bridge.gateway.model.robot_columns import LOCATED, ReportedElsewhere

IN_THE_BASIN = 66.0, 32.0
OUTSIDE = 60.0, 22.0
PATIENCE = 30.0
"""seconds after which what does not come about has failed."""


@pytest.fixture
async def guarded(roads, monkeypatch):
    """A yard with r1 on its way outside of every keepout; robots in keepouts are aborted."""
    monkeypatch.setattr(watch, "RETRY_AFTER_S", 0.01)
    settings = replace(roads.site.settings, geofence=GeofenceSettings(in_keepout="abort"))
    roads.site.take_over(replace(roads.site.site, settings=settings))
    await roads.drive("one", [OUTSIDE, (100.0, 22.0)])
    await look(roads)
    yield roads
    for acting in list(roads.fleet.geofence._acting._tasks):
        acting.cancel()


async def look(yard):
    """Let the geofence judge, act, and tell."""
    async with asyncio.timeout(PATIENCE):
        await yard.fleet.geofence.watch()
        await yard.fleet.geofence._acting.wait()
    return yard.fleet.geofence.report()


async def test_a_robot_outside_is_no_alarm_and_one_inside_is_aborted_once(guarded):
    assert (await look(guarded)).alarms == []
    await guarded.at(*IN_THE_BASIN, v=1.0)
    (alarm,) = (await look(guarded)).alarms
    assert (alarm.robot, alarm.name, alarm.outcome) == ("r1", "Water basin", "aborted")
    assert guarded.news["geofence"]["alarms"][0]["name"] == "Water basin"
    assert await guarded.acknowledge_all() == ["Abort"]
    for _ in range(3):
        await guarded.at(66.0, 31.0)
        await look(guarded)
    assert await guarded.acknowledge_all() == []


def seen_elsewhere(yard, place, *, located=True, names=("far",)):
    """Take in where gateway south says that its robots are."""
    table = np.array([[*place, 0.0, 0.0, 0.0, 0.0]] * len(names), dtype="<f4")
    flags = np.full(len(names), LOCATED * located, dtype=np.uint8)
    rows = np.arange(len(names), dtype=np.uint32)
    yard.fleet.robots.observe_elsewhere(
        ReportedElsewhere("south", 1, rows, list(names), table, flags, yard.now)
    )


def reported_elsewhere(yard, *alarms, **more):
    yard.fleet.events.publish(FenceJudgedElsewhere("south", Geofence(yard.now, list(alarms), **more)))


def basin(robot, outcome="aborted", since=1000.0):
    return FenceAlarm(robot, "keepout", "Water basin", since, 66.0, 32.0, "abort", outcome)


async def test_a_robot_that_may_have_driven_on_since_it_said_where_it_is_is_not_judged(guarded):
    await guarded.at(*OUTSIDE, v=1.0)
    assert (await look(guarded)).unjudged == []
    for _ in range(4):
        guarded.now += 1.0
        await guarded.fleet.receive("r1", "websocket", Alive(), None)
    guarded.fleet.age()
    assert (await look(guarded)).unjudged == ["r1"]


async def test_a_robot_of_a_gateway_that_reports_nothing_is_told_of_and_left_to_that(guarded):
    seen_elsewhere(guarded, IN_THE_BASIN, located=False)
    report = await look(guarded)
    assert (report.alarms, report.unjudged) == ([], ["far"])
    seen_elsewhere(guarded, OUTSIDE)
    report = await look(guarded)
    assert (report.alarms, report.unjudged) == ([], [])
    seen_elsewhere(guarded, IN_THE_BASIN)
    (alarm,) = (await look(guarded)).alarms
    assert (alarm.robot, alarm.name, alarm.outcome) == ("far", "Water basin", "none")
    guarded.now += 20
    guarded.fleet.robots.age(guarded.now)
    assert (await look(guarded)).unjudged == ["far", "r1"]


async def test_of_very_many_in_a_keepout_the_newest_are_told_and_the_others_counted(guarded):
    names = [f"far-{number}" for number in range(3000)]
    seen_elsewhere(guarded, IN_THE_BASIN, names=names)
    assert len((await look(guarded)).alarms) == watch.MOST_ALARMS
    guarded.now += 1
    await guarded.at(*IN_THE_BASIN, v=1.0)
    report = await look(guarded)
    assert (report.alarms[0].robot, report.more) == ("r1", 3001 - watch.MOST_ALARMS)
    told = guarded.news["geofence"]
    assert (len(told["alarms"]), told["more"]) == (watch.MOST_ALARMS, report.more)
    seen_elsewhere(guarded, IN_THE_BASIN, located=False, names=names)
    report = await look(guarded)
    assert (len(report.unjudged), report.unjudged_more) == (watch.MOST_UNJUDGED, 3000 - watch.MOST_UNJUDGED)


async def test_what_another_gateway_reports_is_told_and_its_robots_are_not_judged_here(guarded):
    seen_elsewhere(guarded, IN_THE_BASIN)
    assert [alarm.outcome for alarm in (await look(guarded)).alarms] == ["none"]
    reported_elsewhere(guarded)
    assert (await look(guarded)).alarms == []
    reported_elsewhere(guarded, basin("far"), more=3, unjudged=["u"], unjudged_more=2, fault="no areas")
    report = await look(guarded)
    assert report.alarms == [basin("far")]
    assert (report.more, report.unjudged, report.unjudged_more) == (3, ["u"], 2)
    assert report.fault == "gateway south: no areas" and report.keepouts
    # Once it has been silent for long its robots are judged here, whether they move or not.
    guarded.clock.uptime += REPORT_HOLDS_S
    (alarm,) = (await look(guarded)).alarms
    assert (alarm.robot, alarm.outcome) == ("far", "none")


async def test_others_hear_of_the_robots_of_this_gateway_alone(guarded):
    heard = []
    guarded.fleet.events.subscribe(FenceJudged, lambda judged: heard.append(judged.report))
    seen_elsewhere(guarded, IN_THE_BASIN)
    await guarded.at(*IN_THE_BASIN, v=1.0)
    assert sorted(alarm.robot for alarm in (await look(guarded)).alarms) == ["far", "r1"]
    assert [alarm.robot for alarm in heard[-1].alarms] == ["r1"]


async def come_from_south(yard, *alarms, after=0.0):
    """Have robot far, of which gateway south reports so, say Ready here in the basin; return the alarms."""
    seen_elsewhere(yard, IN_THE_BASIN)
    reported_elsewhere(yard, *alarms)
    await look(yard)
    yard.clock.uptime += after
    await yard.ready("far")
    await yard.acknowledge_all("far")
    await yard.at(*IN_THE_BASIN, v=1.0, robot="far")
    return (await look(yard)).alarms


async def test_a_robot_that_was_stopped_at_another_gateway_may_drive_out(guarded):
    (alarm,) = await come_from_south(guarded, basin("far"))
    assert (alarm.outcome, alarm.since) == ("aborted", 1000.0)
    assert await guarded.acknowledge_all("far") == []


async def test_a_robot_may_drive_out_though_the_gateway_that_stopped_it_says_no_more_of_it(guarded):
    seen_elsewhere(guarded, IN_THE_BASIN)
    reported_elsewhere(guarded, basin("far"))
    guarded.fleet.events.publish(RobotClaimed("far"))
    (alarm,) = await come_from_south(guarded)
    assert (alarm.outcome, alarm.since) == ("aborted", 1000.0)
    assert await guarded.acknowledge_all("far") == []
    # Who drives in again is stopped again.
    for _ in range(2):
        guarded.now += LEFT_AFTER_S
        await guarded.at(*OUTSIDE, v=1.0, robot="far")
        report = await look(guarded)
    assert report.alarms == []
    guarded.now += 60.0
    await guarded.at(*IN_THE_BASIN, v=1.0, robot="far")
    assert [alarm.outcome for alarm in (await look(guarded)).alarms] == ["aborted"]
    assert await guarded.acknowledge_all("far") == ["Abort"]


@pytest.mark.parametrize("is_seen", [True, False])
async def test_a_robot_that_was_judged_here_before_its_gateway_reported_may_drive_out(guarded, is_seen):
    seen_elsewhere(guarded, IN_THE_BASIN)
    assert [alarm.outcome for alarm in (await look(guarded)).alarms] == ["none"], "south says nothing yet"
    reported_elsewhere(guarded, basin("far"))
    if is_seen:
        await look(guarded)
    guarded.fleet.events.publish(RobotClaimed("far"))
    await guarded.ready("far")
    await guarded.acknowledge_all("far")
    await guarded.at(*IN_THE_BASIN, v=1.0, robot="far")
    (alarm,) = (await look(guarded)).alarms
    assert (alarm.outcome, alarm.since) == ("aborted", 1000.0)
    assert await guarded.acknowledge_all("far") == []


@pytest.mark.parametrize("gone", ["judged outside", "at another gateway"])
async def test_what_was_reported_of_a_robot_that_came_counts_once(guarded, gone):
    seen_elsewhere(guarded, IN_THE_BASIN)
    reported_elsewhere(guarded, basin("far"))
    guarded.fleet.events.publish(RobotClaimed("far"))
    if gone == "at another gateway":
        guarded.fleet.events.publish(RobotLeft("far", "south"))
    else:
        reported_elsewhere(guarded)
        await guarded.ready("far")
        await guarded.at(*OUTSIDE, v=1.0, robot="far")
        assert (await look(guarded)).alarms == []
        guarded.fleet.events.publish(RobotLeft("far", "south"))
    (alarm,) = await come_from_south(guarded)
    assert (alarm.outcome, alarm.since) == ("aborted", guarded.now)


async def test_what_was_reported_of_a_robot_long_ago_does_not_keep_it_from_being_stopped(guarded):
    (alarm,) = await come_from_south(guarded, basin("far"), after=REPORT_HOLDS_S)
    assert (alarm.outcome, alarm.since) == ("aborted", guarded.now)
    assert await guarded.acknowledge_all("far") == ["Abort"]


@pytest.mark.parametrize("outcome", ["none", "asked", "failed"])
async def test_a_robot_that_another_gateway_could_not_stop_is_stopped(guarded, outcome):
    (alarm,) = await come_from_south(guarded, basin("far", outcome))
    assert alarm.outcome == "aborted"
    assert await guarded.acknowledge_all("far") == ["Abort"]


async def test_a_robot_that_was_judged_here_outside_is_stopped_whatever_is_reported_of_it(guarded):
    reported_elsewhere(guarded, basin("r1"))
    assert (await look(guarded)).alarms == [], "it is this gateway's by now"
    await guarded.at(*IN_THE_BASIN, v=1.0)
    assert [alarm.outcome for alarm in (await look(guarded)).alarms] == ["aborted"]
    assert await guarded.acknowledge_all() == ["Abort"]


async def test_a_robot_that_came_in_at_another_gateway_is_stopped_when_it_comes_here(guarded):
    seen_elsewhere(guarded, IN_THE_BASIN)
    assert [alarm.outcome for alarm in (await look(guarded)).alarms] == ["none"]
    await guarded.ready("far")
    await guarded.acknowledge_all("far")
    (alarm,) = (await look(guarded)).alarms
    assert (alarm.robot, alarm.outcome) == ("far", "aborted")
    assert await guarded.acknowledge_all("far") == ["Abort"]


async def test_a_stop_that_cannot_be_stored_is_tried_until_it_is(guarded, monkeypatch):
    database, run = guarded.database, guarded.database.run
    failures = []

    async def away(work, *arguments):
        if len(failures) < 3:
            failures.append(work)
            raise StoreError("the database is away")
        return await run(work, *arguments)

    await guarded.at(*IN_THE_BASIN, v=1.0)
    monkeypatch.setattr(database, "run", away)
    assert (await look(guarded)).alarms[0].outcome == "aborted"
    assert len(failures) == 3
    assert await guarded.acknowledge_all() == ["Abort"]


async def test_a_failed_stop_is_told_with_the_reason_and_given_up_when_the_robot_has_left(
    guarded, monkeypatch
):
    async def away(work, *arguments):
        raise StoreError("the database is away")

    monkeypatch.setattr(guarded.database, "run", away)
    await guarded.at(*IN_THE_BASIN, v=1.0)
    geofence = guarded.fleet.geofence
    async with asyncio.timeout(PATIENCE):
        await geofence.watch()
        while geofence.report().alarms[0].outcome != "failed":
            # By itself it waits for nothing where no robot has moved.
            await asyncio.sleep(0)
            await geofence.watch()
    assert "the database is away" in geofence.report().alarms[0].reason
    await guarded.at(*OUTSIDE, v=1.0)
    await geofence.watch()
    guarded.now += 3
    await look(guarded)
    assert geofence.report().alarms == []
    assert len(geofence._acting) == 0


async def test_a_robot_that_cannot_be_paused_is_aborted(guarded, monkeypatch):
    settings = replace(guarded.site.settings, geofence=GeofenceSettings(in_keepout="pause"))
    guarded.site.take_over(replace(guarded.site.site, settings=settings))

    async def refused(request, operator):
        raise watch.MessageError("the path is too long to be kept")

    monkeypatch.setattr(guarded.fleet.pauses, "pause", refused)
    await guarded.at(*IN_THE_BASIN, v=1.0)
    (alarm,) = (await look(guarded)).alarms
    assert (alarm.action, alarm.outcome) == ("pause", "aborted")
    assert await guarded.acknowledge_all() == ["Abort"]


async def test_an_emergency_stop_in_force_is_stop_enough(guarded):
    await guarded.fleet.emergency.stop(EmergencyStop("stop-0001"), "Eve")
    await guarded.acknowledge_all()
    await guarded.at(*IN_THE_BASIN)
    (alarm,) = (await look(guarded)).alarms
    assert alarm.outcome == "stopped"
    assert await guarded.acknowledge_all() == []


async def test_a_robot_that_is_not_heard_is_named_and_its_alarm_stays(guarded):
    await guarded.at(*IN_THE_BASIN)
    await look(guarded)
    await guarded.acknowledge_all()
    guarded.now += 60
    guarded.fleet.age()
    report = await look(guarded)
    assert report.unjudged == ["r1"]
    assert [(alarm.name, alarm.current) for alarm in report.alarms] == [("Water basin", False)]


async def test_a_removed_robot_has_no_alarm(guarded):
    await guarded.at(*IN_THE_BASIN)
    await look(guarded)
    guarded.fleet.robots.remove("r1")
    assert (await look(guarded)).alarms == []


async def test_areas_that_cannot_be_used_are_told_and_robots_are_judged_by_the_next_publication(
    guarded, monkeypatch
):
    def broken(*_everything):
        raise ValueError("no ring")

    with monkeypatch.context() as patch:
        patch.setattr(Fences, "of", broken)
        guarded.site.take_over(replace(guarded.site.site))
        assert (await look(guarded)).fault == "the site's areas cannot be used: no ring"
    await guarded.at(*IN_THE_BASIN)
    guarded.site.take_over(replace(guarded.site.site))
    report = await look(guarded)
    assert (report.fault, len(report.alarms)) == (None, 1)


async def test_what_nobody_foresaw_of_places_is_told_and_ends_no_gateway(guarded, monkeypatch, caplog):
    def broken(*_everything):
        raise ZeroDivisionError("no height")

    await guarded.at(20.0, 8.0)
    with monkeypatch.context() as patch:
        patch.setattr(watch, "find_stays", broken)
        assert [(await look(guarded)).fault for _ in range(3)] == [
            "the site's areas cannot be used: no height"
        ] * 3
    assert caplog.text.count("Traceback") == 1
    await guarded.at(*IN_THE_BASIN)
    report = await look(guarded)
    assert (report.fault, len(report.alarms)) == (None, 1)


async def test_what_nobody_foresaw_of_who_is_near_a_robot_is_told_and_ends_no_gateway(
    guarded, monkeypatch, caplog
):
    def broken(*_everything):
        raise ZeroDivisionError("no speed")

    await guarded.ready("phone", abilities=[])
    await guarded.at(*OUTSIDE, robot="phone")
    nearness = guarded.fleet.nearness
    with monkeypatch.context() as patch:
        patch.setattr("robot_bridge.gateway.fleet.nearness._judged", broken)
        for _ in range(3):
            await nearness.watch()
        assert nearness.report().fault == "it cannot be judged: no speed"
    assert caplog.text.count("Traceback") == 1
    await nearness.watch()
    report = nearness.report()
    assert (report.fault, [(alarm.seen, alarm.robot) for alarm in report.alarms]) == (None, [("phone", "r1")])


async def test_a_settings_change_does_not_stop_a_robot_again(guarded):
    await guarded.at(*IN_THE_BASIN)
    await look(guarded)
    await guarded.acknowledge_all()
    await look(guarded)
    guarded.site.take_over(replace(guarded.site.site))
    await look(guarded)
    assert await guarded.acknowledge_all() == []
    assert len(guarded.fleet.geofence.report().alarms) == 1


async def see(yard, object, place):
    """Let another robot see an object at ``place``; return the observation."""
    await yard.ready("r2")
    await yard.fleet.receive("r2", "websocket", SetObject(*place, object, label="cone"), None)
    (seen,) = (await yard.fleet.observations.newest(GetObservations(limit=1))).observations
    return seen.observation


async def test_an_object_that_an_operator_accepted_is_an_obstacle_until_it_is_rejected(guarded):
    settings = replace(guarded.site.settings, geofence=GeofenceSettings(at_obstacle="abort"))
    guarded.site.take_over(replace(guarded.site.site, settings=settings))
    before = (await look(guarded)).obstacles
    seen = await see(guarded, "c7", OUTSIDE)
    assert (await look(guarded)).alarms == []
    await guarded.fleet.observations.review(ReviewObservation(seen, accept=True), "Ada")
    report = await look(guarded)
    (alarm,) = report.alarms
    assert (alarm.kind, alarm.name, alarm.outcome) == ("obstacle", "cone c7", "aborted")
    assert report.obstacles == before + 1
    assert await guarded.acknowledge_all() == ["Abort"]
    # Another one elsewhere is no new entry into this one.
    other = await see(guarded, "c8", (40.0, 40.0))
    await guarded.fleet.observations.review(ReviewObservation(other, accept=True), "Ada")
    await guarded.at(*OUTSIDE)
    assert [one.name for one in (await look(guarded)).alarms] == ["cone c7"]
    assert await guarded.acknowledge_all() == []
    await guarded.fleet.observations.review(ReviewObservation(seen, accept=False, revise=True), "Ada")
    await look(guarded)
    guarded.now += LEFT_AFTER_S
    await guarded.at(*OUTSIDE)
    assert (await look(guarded)).alarms == []
    guarded.site.show([])


async def test_a_robot_that_has_not_said_where_it_is_since_it_connected_is_not_judged_but_named(guarded):
    await guarded.at(*IN_THE_BASIN)
    await guarded.ready(magic=2)
    report = await look(guarded)
    assert (report.alarms, report.unjudged) == ([], ["r1"])
