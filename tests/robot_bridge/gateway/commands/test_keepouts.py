"""Nobody is sent into a keepout of the site, whatever desk asks, unless that is overridden.

The sample site's keepouts are the water basin around (66, 32) and the excavation around (95, 151).
"""

from __future__ import annotations

import dataclasses

import pytest

from robot_bridge.core.errors import OverridableError, RefusedError
from robot_bridge.core.messages.commands import Send, SetPositions, TargetPosition
from robot_bridge.core.messages.queues import AddTasks, SetQueue, Share, SharedTask, TakeOver, TaskKind
from robot_bridge.core.sites.settings_tables import ConeSettings
from robot_bridge.gateway.site.site_maps import SiteMaps
from tests.support.bridge.queue_line import task

BASIN = (66.0, 32.0)
THROUGH = [(20.0, 40.0), (66.0, 25.0), (66.0, 40.0)]
BESIDE = [(20.0, 40.0), (50.0, 40.0), (66.0, 40.0)]
IN_IT = r"\(66\.00, 32\.00\) lies in the keepout 'Water basin': choose a place or way outside it"
ACROSS_IT = r"the path to \(66\.00, 40\.00\) enters the keepout 'Water basin'"


def send(op, override=None, **params):
    return Send("command-a", "r1", op, params, override=override)


def to(id, place, **more):
    return dataclasses.replace(task("a"), task=id, x=place[0], y=place[1], **more)


INTO = to("task-into", BASIN)
ACROSS = to("task-across", THROUGH[-1], path=THROUGH)
AROUND = to("task-around", BESIDE[-1], path=BESIDE)


@pytest.mark.parametrize(
    ("op", "params", "said"),
    [("SetPosEnd", dict(zip("xy", BASIN, strict=True)), IN_IT), ("SetPath", {"points": THROUGH}, ACROSS_IT)],
)
async def test_a_command_into_a_keepout_is_refused_unless_it_is_overridden(line, op, params, said):
    with pytest.raises(RefusedError, match=said):
        await line.yard.fleet.orders.send(send(op, **params), "Ada")
    assert await line.yard.states() == {}
    assert line.yard.waiting() == []
    report = await line.yard.fleet.orders.send(send(op, override="it is drained", **params), "Ada")
    assert report.steps[0].reason == "override: it is drained"


async def test_what_was_sent_before_is_answered_as_it_stands_whatever_is_a_keepout_by_now(line):
    into = {"x": BASIN[0], "y": BASIN[1]}
    sent = await line.yard.fleet.orders.send(send("SetPosEnd", override="it is drained", **into), "Ada")
    assert await line.yard.fleet.orders.send(send("SetPosEnd", **into), "Ada") == sent


async def test_so_it_is_when_the_site_ends_before_it_by_now_or_the_robot_is_not_known_any_more(
    line, monkeypatch
):
    asked = send("SetPosEnd", x=50.0, y=40.0)
    sent = await line.yard.fleet.orders.send(asked, "Ada")
    other = dataclasses.replace(asked, command="command-b")
    monkeypatch.setattr(SiteMaps, "contains", lambda _site, _x, _y: False)
    with pytest.raises(RefusedError, match="lies outside site"):
        await line.yard.fleet.orders.send(other, "Ada")
    assert await line.yard.fleet.orders.send(asked, "Ada") == sent
    line.yard.sql("delete from robots where name = 'r1'")
    await line.yard.restart()
    with pytest.raises(RefusedError, match="'r1' is not known"):
        await line.yard.fleet.orders.send(other, "Ada")
    assert await line.yard.fleet.orders.send(asked, "Ada") == sent


async def test_a_path_around_a_keepout_and_a_robot_that_is_said_to_stand_in_one_are_no_matter(line):
    await line.yard.fleet.orders.send(send("SetPath", points=BESIDE), "Ada")
    begin = Send("command-b", "r1", "SetPosIni", {"x": BASIN[0], "y": BASIN[1]})
    assert (await line.yard.fleet.orders.send(begin, "Ada")).state.value == "queued"


async def test_of_several_targets_none_is_sent_when_one_lies_in_a_keepout(line):
    wanted = [TargetPosition("r1", 50.0, 40.0), TargetPosition("r2", *BASIN)]
    with pytest.raises(RefusedError, match=IN_IT):
        await line.yard.fleet.orders.set_positions(SetPositions(wanted), "Ada")
    assert await line.yard.states() == {}


async def test_keepouts_are_looked_for_once_however_many_targets_there_are(line, monkeypatch):
    asked = []
    entered = SiteMaps.keepouts_entered

    def noted(site, tracks):
        asked.append(tracks)
        return entered(site, tracks)

    monkeypatch.setattr(SiteMaps, "keepouts_entered", noted)
    await line.yard.fleet.orders.set_positions(
        SetPositions([TargetPosition("r1", 50.0, 40.0), TargetPosition("r2", 52.0, 40.0)]), "Ada"
    )
    assert asked == [[[(50.0, 40.0)], [(52.0, 40.0)]]]


async def test_a_site_without_keepouts_is_not_asked_for_them(line, monkeypatch):
    monkeypatch.setattr(SiteMaps, "has_keepouts", False)
    monkeypatch.delattr(SiteMaps, "keepouts_entered")
    await line.yard.fleet.orders.set_positions(SetPositions([TargetPosition("r1", 50.0, 40.0)]), "Ada")
    assert await line.yard.states() != {}


@pytest.mark.parametrize("request_of", [SetQueue, AddTasks])
@pytest.mark.parametrize(("wrong", "said"), [(INTO, IN_IT), (ACROSS, ACROSS_IT)])
async def test_a_queue_takes_no_task_into_a_keepout_unless_it_is_overridden(line, request_of, wrong, said):
    ask = line.queues.set if request_of is SetQueue else line.queues.add
    with pytest.raises(RefusedError, match=said):
        await ask(request_of("r1", 0, [AROUND, wrong]), "Ada")
    assert (await line.report()).tasks == []
    report = await ask(request_of("r1", 0, [AROUND, wrong], override="it is drained"), "Ada")
    assert [one.task for one in report.tasks] == [AROUND.task, wrong.task]


async def test_all_that_an_override_of_a_queue_would_reach_is_told(line):
    wrong = [to(f"task-into-{n}", (66.0, 31.0 + n / 10)) for n in range(4)]
    with pytest.raises(OverridableError, match="; and 2 more: choose a place") as refused:
        await line.queues.set(SetQueue("r1", 0, [ACROSS, AROUND, *wrong]), "Ada")
    assert refused.value.found == [
        "the path to (66.00, 40.00) enters the keepout 'Water basin'",
        *(f"(66.00, 31.{n}0) lies in the keepout 'Water basin'" for n in range(4)),
    ]


async def test_a_task_that_was_overridden_stays_in_its_queue_when_that_is_put_in_another_order(line):
    asked = SetQueue("r1", 0, [task("a"), AROUND, ACROSS], override="it is drained")
    revision = (await line.queues.set(asked, "Ada")).revision
    again = SetQueue("r1", revision, [task("a"), ACROSS, AROUND])
    revision = (await line.queues.set(again, "Ada")).revision
    other = dataclasses.replace(ACROSS, path=[(30.0, 10.0), *THROUGH[1:]])
    with pytest.raises(RefusedError, match=ACROSS_IT):
        await line.queues.set(SetQueue("r1", revision, [task("a"), other, AROUND]), "Ada")


async def test_where_a_cone_stands_ahead_of_its_robot_the_robots_place_counts(line, monkeypatch):
    settings = dataclasses.replace(line.yard.site.settings, cones=ConeSettings(offset_ahead_m=4.0))
    monkeypatch.setattr(type(line.yard.site), "settings", settings)
    # The basin's northern rim is at y = 34.9, its southern one at 29.5.
    for y, theta, enters in ((33.0, -1.5708, False), (28.0, -1.5708, True)):
        place = to(f"task-cone-{y:g}", (66.0, y), theta=theta, kind=TaskKind.PLACE)
        asked = line.queues.add(AddTasks("r1", (await line.report()).revision, [place]), "Ada")
        if enters:
            with pytest.raises(RefusedError, match=IN_IT):
                await asked
        else:
            assert [one.task for one in (await asked).tasks] == [place.task]


async def test_a_robot_takes_over_no_path_through_a_keepout_unless_it_is_overridden(line):
    await line.set(task("a"), AROUND)
    request = TakeOver("r1", 1, [Share("r2", 0, [SharedTask(AROUND.task, THROUGH)])])
    with pytest.raises(RefusedError, match=ACROSS_IT):
        await line.queues.take_over(request, "Ada")
    request = dataclasses.replace(request, override="it is drained")
    taken = (await line.queues.take_over(request, "Ada")).queues
    assert [[one.task for one in report.tasks] for report in taken] == [["task-000a"], [AROUND.task]]
