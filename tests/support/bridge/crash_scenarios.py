"""What robots and operators do while the gateway dies; each scenario checks itself what it came to.

Only what must hold wherever the gateway died is checked: an operator may have been too late for a robot that
drove on meanwhile.
"""

from __future__ import annotations

from robot_bridge.core.messages.queues import (
    GetQueue,
    MakeCurrent,
    PauseQueue,
    PauseRobot,
    QueueTask,
    Share,
    SharedTask,
    TakeOver,
    TaskKind,
)
from robot_bridge.core.messages.records import GetObservations, ReviewObservation
from robot_bridge.core.messages.roads import CloseRoad, ResolveConflict
from robot_bridge.core.messages.robots import SetObject
from robot_bridge.core.messages.safety import ClearEmergencyStop
from tests.support.bridge.crash_play import START_ANEW
from tests.support.bridge.living_robots import SqlRobot, WebSocketRobot
from tests.support.bridge.queue_line import PLACES, task
from tests.support.bridge.road_places import SOUTH, highest

BEGIN = (41.0, 40.0)
AHEAD = 0.4
"""metres ahead of a robot that a cone stands, where it does not stand beneath it."""
COURSE = ["task-000a", "task-000b", "task-000c", "task-000d"]
COURSE_CONES = [PLACES["b"], PLACES["c"]]
SHORT_COURSE = COURSE[:2]
OTHER = QueueTask("task-0002", 41.0, 70.0, kind=TaskKind.PLACE, cone="X")
BEFORE_OTHER = (41.0, 60.0)
DRAWN = [BEGIN, PLACES["a"], PLACES["b"], PLACES["c"]]
LAP = [BEGIN, (44.0, 40.0), (44.0, 43.0), (41.0, 43.0), (41.0, 41.0)]
"""A lap that ends beside its beginning, so short that it is driven while no gateway is there."""
OUT_OF_REACH = 15
"""seconds for which robots are out of reach: they come to the end of what they do, and are lost."""
CROSSING = [(16.0, 8.0), (44.0, 22.0), (90.0, 22.0)], [(13.0, 22.0), (56.0, 22.0), (56.0, 40.0)]
"""The ways of r1 and r2, who meet where the road from the south joins the ring."""


def course(**more):
    """A drive, two cones with and without a path, and a drive along a path."""
    return [
        task("a"),
        task("b", "place", path=[PLACES["a"], PLACES["b"]], cone="B", **more),
        task("c", "place", cone="C", **more),
        task("d", path=[PLACES["c"], PLACES["d"]]),
    ]


def short_course():
    """A drive and a cone, for those who are stopped on the drive and go on."""
    return [task("a"), task("b", "place", cone="B")]


async def cones(play, robot=WebSocketRobot):
    await play.begin(robot(play, "r1", BEGIN))
    await play.set_queue(*course())
    await play.until_done()
    play.check({"r1": COURSE})
    play.check_cones(COURSE_CONES)
    assert play.robots["r1"].record.ends[-1] == PLACES["d"]


async def cones_over_sql(play):
    await cones(play, SqlRobot)


async def cones_ahead_of_their_robot(play):
    play.ahead(AHEAD)
    await play.begin(WebSocketRobot(play, "r1", BEGIN, offset=(AHEAD, 0.0)))
    await play.set_queue(*course(theta=0.0))
    await play.until_done()
    play.check({"r1": COURSE})
    play.check_cones(COURSE_CONES)


async def one_after_another(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", (56.0, 55.0)))
    await play.set_queue(task("a", "place", cone="A", after=["task-000c"]), task("b"))
    await play.set_queue(task("c", "place", cone="C"), task("d", "place", cone="D"), robot="r2")
    await play.until_done()
    play.check({"r1": COURSE[:2], "r2": COURSE[2:]})
    play.check_cones([PLACES["a"], PLACES["c"], PLACES["d"]])
    ((began,),) = play.sql("select began_at from queue_tasks where id = 'task-000a'")
    ((ended,),) = play.sql("select ended_at from queue_tasks where id = 'task-000c'")
    assert began >= ended


async def paused(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN))
    await play.set_queue(*short_course())
    await play.wait(3)
    play.about_to_stop()
    await play.ask(lambda fleet: fleet.queues.pause(PauseQueue("r1"), "Ada"))
    await play.wait(8)
    await play.until(lambda: play.open_commands() == [])
    assert (await play.queue()).state.value == "paused"
    await play.resume()
    await play.until_done()
    play.check({"r1": SHORT_COURSE})
    play.check_cones([PLACES["b"]])


async def aborted(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    await play.set_queue(*short_course())
    await play.set_queue(OTHER, robot="r2")
    await play.wait(2)
    play.about_to_stop()
    for name in play.robots:
        await play.abort(name)
    await play.until(lambda: all(robot.record.stops for robot in play.robots.values()))
    await play.stand_for(6)
    await play.resume_until_done()
    play.check({"r1": SHORT_COURSE, "r2": [OTHER.task]})
    play.check_cones([OTHER, PLACES["b"]], interrupted=True)


async def aborted_too_late(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    await play.set_queue(task("a", "place"), task("b", "place"))
    await play.set_queue(OTHER, robot="r2")
    await play.until(lambda: all(robot.record.began for robot in play.robots.values()))
    for robot in play.robots.values():
        robot.says_late, robot.away_until = True, play.now + OUT_OF_REACH
    play.about_to_stop()
    for name in play.robots:
        await play.abort(name)
    await play.until(lambda: all(robot.record.stops for robot in play.robots.values()))
    await play.wait(3)
    await play.resume_all()
    await play.until_done()
    play.check()
    play.check_cones([OTHER, PLACES["a"], PLACES["b"]], interrupted=True)


async def halted(play):
    """Robots that were sent beside their queues are paused, and go on: the cone is put down once."""
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    (x, y), way = PLACES["b"], [BEFORE_OTHER, (41.0, 90.0)]
    await play.order("one", "SetPosEnd", x=x, y=y, cone=True)
    await play.order("two", "SetPath", robot="r2", points=way)
    await play.wait(2)
    play.about_to_stop()
    for name in play.robots:
        await play.ask(lambda fleet, name=name: fleet.pauses.pause(PauseRobot(name), "Ada"))
    await play.until(lambda: play.open_commands() == [])
    kept = play.sql("select robot from queue_tasks order by robot")
    assert kept == [("r1",), ("r2",)] or play.was_disturbed
    await play.stand_for(6)
    await play.resume_all()
    await play.until(lambda: play.is_done() or play.is_held("r2", "off what is left of the path"))
    put_down = play.robots["r1"].record.placed
    if not play.is_done():
        # It had started anew, and was paused on its way back to where its path begins.
        assert play.how == START_ANEW and play.was_disturbed
        await play.until(lambda: play.open_commands() == [])
    else:
        play.check()
        assert play.robots["r2"].record.ends[-1] == way[-1]
    assert set(put_down) == {(x, y)}
    assert len(put_down) == 1 or play.how == START_ANEW


async def continued_at_once(play):
    """Robots are paused, and told to go on before they can have stopped: each cone is put down once."""
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    await play.set_queue(*short_course())
    await play.set_queue(OTHER, robot="r2")
    await play.wait(2)
    play.about_to_stop()
    for name in play.robots:
        await play.ask(lambda fleet, name=name: fleet.pauses.pause(PauseRobot(name), "Ada"))
    await play.resume_until_done()
    play.check({"r1": SHORT_COURSE, "r2": [OTHER.task]})
    play.check_cones([OTHER, PLACES["b"]], interrupted=True)


async def made_current(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN))
    await play.set_queue(*(task(id, "place") for id in "abc"))
    await play.wait(2)

    async def first(fleet):
        (seen,) = (await fleet.queues.read(GetQueue("r1"))).queues
        return await fleet.queues.make_current(MakeCurrent("r1", seen.revision, "task-000c"), "Ada")

    await play.ask_once(first)
    await play.until_done()
    play.check()
    play.check_cones([PLACES[id] for id in "abc"], interrupted=True)


async def taken_over(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", (56.0, 55.0)))
    await play.set_queue(task("a", "place"), task("b", "place"))
    await play.set_queue(task("c", "place"), robot="r2")
    await play.wait(2)

    async def take(fleet):
        (given,) = (await fleet.queues.read(GetQueue("r1"))).queues
        (mine,) = (await fleet.queues.read(GetQueue("r2"))).queues
        tasks = [one.task for one in mine.tasks if one.state.value == "waiting"]
        tasks += [one.task for one in given.tasks]
        share = Share("r2", mine.revision, [SharedTask(one) for one in tasks])
        return await fleet.queues.take_over(TakeOver("r1", given.revision, [share]), "Ada")

    await play.ask_once(take)
    await play.until_done()
    play.check(paused=["r1"])
    play.check_cones([PLACES[id] for id in "abc"], interrupted=True)


async def stopped(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    await play.set_queue(*short_course())
    await play.set_queue(OTHER, robot="r2")
    await play.wait(2)
    play.about_to_stop()
    await play.stop("stop-0001")
    await play.until(lambda: all(robot.record.stops for robot in play.robots.values()))
    await play.stand_for(6)
    await play.until(lambda: play.fleet.emergency.report().standing == 2)
    report = play.fleet.emergency.report()
    assert (report.in_force, report.stored, report.by) == (True, True, "Ada")
    for robot in play.robots.values():
        robot.must_stand = True
    await play.ask(lambda fleet: fleet.emergency.clear(ClearEmergencyStop("all is well", "stop-0001"), "Eve"))
    await play.wait(3)
    await play.resume_all()
    await play.until_done()
    assert not play.fleet.emergency.in_force
    ((id, _, by, _, _, cleared_by, _),) = play.sql("select * from emergency_stops")
    assert (id, by, cleared_by) == ("stop-0001", "Ada", "Eve")
    play.check({"r1": SHORT_COURSE, "r2": [OTHER.task]})
    play.check_cones([OTHER, PLACES["b"]], interrupted=True)


async def ordered_beside_its_queue(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN))
    await play.set_queue(task("b", "place"), task("c", "place"))
    await play.wait(2)
    await play.order("beside", "SetPosEnd", x=45.0, y=45.0)
    await play.until(lambda: (45.0, 45.0) in play.robots["r1"].record.ends)
    await play.until(lambda: play.state_of("beside") == "reached")
    await play.resume_all()
    await play.until_done()
    play.check()
    play.check_cones([PLACES["b"], PLACES["c"]], interrupted=True)


async def along_a_drawn_path(play, robot=WebSocketRobot):
    await play.begin(robot(play, "r1", BEGIN))
    await play.order("drawn", "SetPath", points=DRAWN)
    await play.until_done()
    play.check()
    assert play.state_of("drawn") == "reached"
    assert play.robots["r1"].record.ends[-1] == DRAWN[-1]


async def along_a_drawn_path_over_sql(play):
    await along_a_drawn_path(play, SqlRobot)


async def a_lap(play, robot=WebSocketRobot):
    await play.begin(robot(play, "r1", LAP[-1]))
    for number in ("one", "two"):
        await play.order(number, "SetPath", points=LAP)
        await play.until_done()
    play.check()
    assert [play.state_of("one"), play.state_of("two")] == ["reached", "reached"]
    assert len(play.robots["r1"].record.ends) >= 2


async def a_lap_over_sql(play):
    await a_lap(play, SqlRobot)


async def started_anew(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    await play.order("drawn", "SetPath", points=DRAWN)
    await play.set_queue(OTHER, robot="r2")
    await play.wait(2)
    for robot in play.robots.values():
        robot.start_anew()
    await play.wait(2)
    await play.until_done()
    play.check({"r2": [OTHER.task]})
    assert play.robots["r1"].record.ends[-1] == DRAWN[-1]
    assert play.robots["r2"].record.ends[-1] == (OTHER.x, OTHER.y)


async def seen(play):
    await play.begin(WebSocketRobot(play, "r1", BEGIN), SqlRobot(play, "r2", BEFORE_OTHER))
    for number, robot in enumerate(play.robots.values()):
        robot.see(SetObject(30.0 + number, 20.0, "cone-7", source="1"))
        await play.turn()
        robot.see(SetObject(30.0 + number, 22.0, "cone-8", source="2"))
    await play.until(lambda: play.sql("select count(*) from observations") >= [(4,)])
    await play.wait(2)

    async def review(fleet):
        for one in (await fleet.observations.newest(GetObservations())).observations:
            told = ReviewObservation(one.observation, one.object == "cone-7", reason="looked at it")
            await fleet.observations.review(told, "Ada")

    await play.ask(review)
    await play.turn()
    # What a robot tells once more after it has started anew is something new.
    once = "distinct" if play.how == START_ANEW else ""
    found = play.sql(f"select {once} robot, object, state from observations order by robot, object")
    kinds = [("cone-7", "accepted"), ("cone-8", "rejected")]
    assert found == [(robot, *one) for robot in ("r1", "r2") for one in kinds]
    play.check()


async def led_round_a_closed_road(play, robot=WebSocketRobot):
    await play.begin(robot(play, "r1", (10.0, 8.0)))
    along = [(10.0, 8.0), (126.0, 8.0)]
    tasks = [QueueTask("task-0001", 126.0, 8.0, path=along), QueueTask("task-0002", 126.0, 12.0)]
    await play.set_queue(*tasks)
    await play.until(lambda: play.robots["r1"].record.began)
    await play.ask(lambda fleet: fleet.roads.closures.close(CloseRoad("closure-1", *SOUTH), "Ada"))
    has_passed = play.robots["r1"].x > SOUTH[0]
    assert not has_passed or play.was_disturbed
    await play.until(lambda: play.is_done() or play.is_held("r1", "no other way"))
    (closed,) = play.fleet.roads.closures.report().closures
    assert closed.edges == 1
    if not play.is_done():
        # It was in the midst of that road by then.
        assert play.was_disturbed
        assert play.robots["r1"].y == SOUTH[1]
        return
    play.check({"r1": [one.task for one in tasks]})
    assert has_passed or highest(play.robots["r1"].record.driven) > 21.0


async def led_round_a_closed_road_over_sql(play):
    await led_round_a_closed_road(play, SqlRobot)


async def waited_with_its_queue(play):
    await play.begin(WebSocketRobot(play, "r1", CROSSING[0][0]), WebSocketRobot(play, "r2", CROSSING[1][0]))
    await play.set_queue(QueueTask("task-0001", *CROSSING[0][-1], path=CROSSING[0]))
    await play.turn()
    await _let_pass(play)


async def waited_beside_its_queue(play):
    await play.begin(WebSocketRobot(play, "r1", CROSSING[0][0]), WebSocketRobot(play, "r2", CROSSING[1][0]))
    await play.order("one", "SetPath", points=CROSSING[0])
    await _let_pass(play)


async def _let_pass(play):
    await play.order("two", "SetPath", robot="r2", points=CROSSING[1])
    await play.wait(2)
    await play.ask_once(
        lambda fleet: fleet.roads.traffic.resolve(ResolveConflict("r1", "r2", "waiting"), "Ada")
    )
    assert play.sql("select robot from holds") == [("r1",)] or play.was_disturbed
    await play.until(lambda: play.sql("select robot from holds") == [])
    await play.until_done()
    play.check()
    for name, way in zip(("r1", "r2"), CROSSING, strict=True):
        assert play.robots[name].record.ends[-1] == way[-1]


SCENARIOS = {
    scenario.__name__: scenario
    for scenario in (
        cones,
        cones_over_sql,
        cones_ahead_of_their_robot,
        one_after_another,
        paused,
        aborted,
        aborted_too_late,
        halted,
        continued_at_once,
        made_current,
        taken_over,
        stopped,
        ordered_beside_its_queue,
        along_a_drawn_path,
        along_a_drawn_path_over_sql,
        a_lap,
        a_lap_over_sql,
        started_anew,
        seen,
        led_round_a_closed_road,
        led_round_a_closed_road_over_sql,
        waited_with_its_queue,
        waited_beside_its_queue,
    )
}
