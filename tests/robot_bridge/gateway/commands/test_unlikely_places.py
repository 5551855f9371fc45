"""A robot that says to be where it cannot be is heard and marked, and keeps its place on the map."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.robots import Alive, Ready, SendGPS, SendPos, Stopped


@pytest.fixture
async def standing(roads):
    """Robot r1, which stands at (20, 8)."""
    await roads.ready()
    await roads.acknowledge_all()
    await roads.at(20.0, 8.0)
    roads.now += 0.1
    return roads


def told(yard, robot="r1"):
    (report,) = [one for one in yard.fleet.reports() if one.robot == robot]
    return report


def place(yard):
    return told(yard).x, told(yard).y


async def refused(yard, request, text):
    with pytest.raises(RefusedError, match=text):
        await yard.fleet.receive("r1", "websocket", request, None)


async def test_a_place_far_from_the_site_does_not_move_it(standing):
    await refused(
        standing, SendPos(5e6, 8.0, 0.0, 0.0), r"\(5000000.00, 8.00\) is 4999.8 km outside site sample"
    )
    assert place(standing) == (20.0, 8.0)
    assert "place_within_m" in told(standing).status
    assert not standing.fleet.robots.is_placed("r1")
    await standing.at(21.0, 8.0)
    assert (place(standing), told(standing).status) == ((21.0, 8.0), None)
    assert standing.fleet.robots.is_placed("r1")


async def test_it_stays_heard_meanwhile(standing):
    for _ in range(30):
        standing.now += 1.0
        await refused(standing, SendPos(5e6, 8.0, 0.0, 0.0), "km outside site")
        standing.fleet.age()
    assert told(standing).state.value == "fresh"


async def test_a_gps_without_a_fix_does_not_move_it(standing):
    await refused(standing, SendGPS(0.0, 0.0), "lat and lon are both 0, as receivers say without a fix")
    assert place(standing) == (20.0, 8.0)
    assert "without a fix" in told(standing).status


async def test_a_gps_on_another_continent_does_not_move_it(standing):
    await refused(standing, SendGPS(40.0, -74.0), "km outside site sample|has no place in the site's CRS")
    assert place(standing) == (20.0, 8.0)


async def test_what_is_far_and_what_is_a_leap_is_for_the_site_to_say(standing, own_site):
    settings = own_site.settings
    limits = replace(settings.limits, place_within_m=50.0, leap_m=5.0)
    own_site.take_over(replace(own_site.site, settings=replace(settings, limits=limits)))
    await refused(standing, SendPos(20.0, -51.0, 0.0, 0.0), "at most 0.05 km are believed")
    await refused(
        standing, SendPos(50.0, 8.0, 0.0, 0.0), r"30 m from where it was a moment ago, more than 5 m"
    )
    await standing.at(24.0, 8.0)
    assert place(standing) == (24.0, 8.0)


async def test_a_leap_is_believed_when_the_robot_goes_on_from_there(standing):
    said = 0
    for _ in range(40):
        standing.now += 0.1
        said += 1
        try:
            await standing.at(2500.0 + said, 8.0)
            break
        except RefusedError:
            assert place(standing) == (20.0, 8.0)
    assert place(standing) == (2500.0 + said, 8.0)
    assert said == pytest.approx(31, abs=2)


async def test_two_robots_under_one_account_do_not_take_turns_on_the_map(standing):
    for _ in range(100):
        standing.now += 0.05
        await refused(standing, SendPos(2500.0, 8.0, 0.0, 0.0), "from where it was a moment ago")
        standing.now += 0.05
        await standing.at(20.0, 8.0)
    assert place(standing) == (20.0, 8.0)


async def test_a_robot_that_starts_anew_may_be_anywhere(standing):
    standing.now += 10
    await standing.ready(magic=2)
    await standing.at(2500.0, 8.0)
    assert place(standing) == (2500.0, 8.0)


async def test_a_robot_that_was_away_may_have_come_far(standing):
    standing.now += 60
    await standing.at(2500.0, 8.0)
    assert place(standing) == (2500.0, 8.0)


async def test_a_long_reason_of_a_refusal_is_cut(standing):
    await standing.send("a")
    for row in await standing.deliver():
        await standing.ack(row.id, ok=False, reason="no\x1b]0;way\n" * 100_000)
    assert len(await standing.reason("a")) == 500


async def test_params_that_are_too_long_are_never_fetched(yard):
    yard.ask("r1", Ready(1))
    yard.sql("insert into rr (robot, op, params) values ('r1', 'Alive', ?)", '{"a": "' + "x" * 100_000 + '"}')
    rows = await yard.fleet.outboxes.read_requests("sql")
    assert [(row.op, row.params is None, row.size) for row in rows] == [
        ("Ready", False, 12),
        ("Alive", True, 100_009),
    ]
    await yard.link.poll()
    (text,) = [p for op, p in yard.sql("select op, params from sa order by id") if '"ok": false' in (p or "")]
    assert "Alive: params has 100009 characters; at most 65536 are taken" in text


async def test_a_robot_that_says_too_much_at_a_time_is_heard_and_marked(yard):
    yard.ask("r1", Ready(1))
    await yard.link.poll()
    yard.now += 60
    yard.fleet.age()
    assert told(yard).state.value == "lost"
    yard.sql("insert into rr (robot, op, params) values ('r1', 'SendPos', ?)", '{"status": "' + "x" * 100_000)
    await yard.link.poll()
    assert (told(yard).state.value, "SendPos: params has" in told(yard).status) == ("fresh", True)


AHEAD = 1.79e9
"""seconds by which the robot's clock differs from the yard's."""


async def said(yard, fix, v=0.0, x=20.0):
    """Have the robot say a position of time ``fix``, half a second later."""
    yard.now += 0.5
    await yard.fleet.receive("r1", "websocket", SendPos(x, 8.0, 0.0, v, fix_t=AHEAD + fix), None)
    yard.fleet.age()


async def test_a_fix_that_is_repeated_is_told_as_old_and_says_no_more_where_it_is(standing):
    fix = standing.now
    for _ in range(6):
        await said(standing, fix)
    assert (told(standing).status, round(told(standing).pose_age, 1)) == (None, 2.5)
    assert standing.fleet.robots.is_placed("r1")
    for _ in range(2):
        await said(standing, fix)
    assert "3 s old when it came" in told(standing).status
    assert not standing.fleet.robots.is_placed("r1")
    await said(standing, standing.now)
    assert (told(standing).status, told(standing).pose_age) == (None, 0.0)
    assert standing.fleet.robots.is_placed("r1")


async def test_positions_that_waited_show_the_robot_where_it_was_and_not_as_being_there(standing):
    await said(standing, standing.now, 1.0)
    began = standing.now
    standing.now += 60.0
    for k in range(40):
        await standing.fleet.receive(
            "r1", "websocket", SendPos(20.0 + k, 8.0, 0.0, 1.0, fix_t=AHEAD + began + k), None
        )
    assert (place(standing), round(told(standing).pose_age)) == ((59.0, 8.0), 20)
    assert "old when it came" in told(standing).status


async def test_neither_standing_nor_arrival_is_judged_by_a_repeated_fix(standing):
    await said(standing, standing.now)
    fix = standing.now
    for _ in range(8):
        await said(standing, fix)
    await standing.send("there", x=20.0, y=8.0)
    await standing.acknowledge_all()
    await said(standing, fix)
    assert (await standing.states())["there"] == "acknowledged"
    await said(standing, standing.now)
    assert (await standing.states())["there"] == "reached"


async def test_a_robot_that_drove_and_says_only_that_it_is_alive_is_marked(standing):
    await standing.at(25.0, 8.0, v=1.0)
    for alive in (1.0, 1.0, 1.1):
        assert told(standing).status is None
        standing.now += alive
        await standing.fleet.receive("r1", "websocket", Alive(), None)
        standing.fleet.age()
    assert "has said none for 3 s" in told(standing).status
    assert told(standing).state.value == "fresh"
    assert not standing.fleet.robots.is_placed("r1")
    await standing.at(30.0, 8.0, v=1.0)
    assert told(standing).status is None


@pytest.mark.parametrize("stopped", [False, True])
async def test_a_robot_that_stands_need_not_say_where(standing, stopped):
    await standing.at(25.0, 8.0, v=1.0 if stopped else 0.0)
    if stopped:
        await standing.fleet.receive("r1", "websocket", Stopped(), None)
    for _ in range(20):
        standing.now += 1.0
        await standing.fleet.receive("r1", "websocket", Alive(), None)
        standing.fleet.age()
    assert told(standing).status is None
