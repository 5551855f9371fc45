"""Cone plans that the gateway drives: entered in one step, followed, paused, planned again, kept."""

from __future__ import annotations

import asyncio
import threading
from dataclasses import replace

import pytest

from robot_bridge.core.assignment.job import (
    COLLECT,
    STAY,
    AssignmentJob,
    ConeTarget,
    PlanRobot,
    Store,
    StraightTravel,
)
from robot_bridge.core.assignment.plan import document_of
from robot_bridge.core.assignment.solver import Objective, assign
from robot_bridge.core.clock import ClockWatch
from robot_bridge.core.errors import OutdatedError, RefusedError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.plans import (
    ClearPlan,
    ConfirmReplan,
    DiscardReplan,
    GetPlans,
    PausePlan,
    PlanCone,
    PlanState,
    Replan,
    ResumePlan,
    SubmitPlan,
)
from robot_bridge.core.messages.queues import TaskState
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from robot_bridge.gateway.plans.service import PlanService

CONES = {"c1": (30.0, 40.0), "c2": (40.0, 40.0), "c3": (50.0, 40.0), "c4": (60.0, 40.0)}
LOST = 20.0
"""seconds that r2 is not heard for."""


def plan_of(robots=("r1", "r2"), cones=tuple(CONES), capacity=4):
    targets = tuple(ConeTarget(name, *CONES[name]) for name in cones)
    drivers = tuple(PlanRobot(name, 20.0, 40.0, capacity, aboard=capacity) for name in robots)
    job = AssignmentJob(targets, drivers, (), STAY)
    return assign(job, StraightTravel(job), Objective(time_limit_s=0.2))


class Drive:
    """A plan in a yard: an operator, two robots that obey at once, and the gateway that looks after it."""

    def __init__(self, line):
        self.line, self.yard, self.pushed = line, line.yard, []
        self.begin()

    def begin(self):
        fleet = self.yard.fleet
        fleet.listeners.add(self)
        self.plans = PlanService(
            fleet.queue_context,
            fleet.queues,
            fleet.roads.closures,
            fleet.emergency,
            fleet.listeners,
            fleet.events,
        )

    async def restart(self):
        await self.yard.restart()
        self.begin()
        await self.plans.restore()

    def notify(self, method, key, params):
        if method == "plan":
            self.pushed.append(params)

    async def submit(self, plan=None, name="plan-1", **more):
        plan = plan or plan_of()
        cones = [PlanCone(target.id, target.id, "row") for target in plan.targets]
        request = SubmitPlan(name, document_of(plan), cones, seconds=0.2, **more)
        report = await self.plans.submit(request, "Ada")
        await self.line.advance()
        return report

    async def seen(self, name="plan-1", **how):
        (report,) = (await self.plans.read(GetPlans(name, **how))).plans
        return report

    async def go(self, *, robots=("r1", "r2"), times=1):
        """Let each robot drive what it was sent to its end, so many times, and the gateway look."""
        await self.drive_on(robots=robots, times=times)
        await self.plans.follow()

    async def drive_on(self, *, robots=("r1", "r2"), times=1):
        """Let each robot drive what it was sent to its end, so many times; the plan is not looked at."""
        for _ in range(times):
            for robot in robots:
                await self.yard.acknowledge_all(robot)
                for task in (await self.line.report(robot, paths=True)).tasks[:1]:
                    for x, y in task.path[::4]:
                        await self.yard.at(x, y, v=1.0, robot=robot)
                    await self.yard.at(task.x, task.y, robot=robot)
            await self.line.advance()

    async def planned(self):
        """Wait for what is being planned."""
        await self.plans._replanner._tasks.wait()

    async def lose(self, robot="r2", other="r1"):
        """Let one robot fall silent for long, and the other go on being heard."""
        self.yard.now += LOST
        x, y = (self.yard.fleet.robots.get(other).pose.x, self.yard.fleet.robots.get(other).pose.y)
        await self.yard.at(x, y, robot=other)
        self.yard.fleet.age()
        await self.line.advance()
        await self.plans.follow()

    def cones(self):
        return sorted(self.yard.sql("select cone from placements"))


@pytest.fixture
async def drive(line):
    return Drive(line)


@pytest.fixture
async def line(two):
    from tests.support.bridge.queue_line import Line

    for robot in ("r1", "r2"):
        await two.at(20.0, 40.0, robot=robot)
    return Line(two)


ALL = [("c1",), ("c2",), ("c3",), ("c4",)]


async def test_a_plan_is_entered_followed_and_finished_and_every_operator_hears_of_it(drive):
    report = await drive.submit()
    assert (report.state, report.cones, report.done, report.robots) == (PlanState.DRIVEN, 4, 0, ["r1", "r2"])
    assert {stop.id for stop in report.stops} == set(CONES) and drive.pushed
    await drive.go(times=8)
    seen = await drive.seen()
    assert (seen.state, seen.done) == (PlanState.FINISHED, 4)
    assert {stop.state for stop in seen.stops} == {TaskState.DONE}
    assert drive.cones() == ALL and drive.pushed[-1]["state"] == "finished"


async def test_all_of_it_is_entered_or_nothing(drive):
    with pytest.raises(OutdatedError):
        await drive.submit(revisions={"r2": 7})
    assert [(await drive.line.report(robot)).tasks for robot in ("r1", "r2")] == [[], []]
    assert drive.yard.sql("select count(*) from plans") == [(0,)]
    await drive.submit(revisions={"r1": 0, "r2": 0})
    assert all([(await drive.line.report(robot)).tasks for robot in ("r1", "r2")])


async def test_submitted_twice_it_is_driven_once(drive):
    plan = plan_of()
    first, again = await drive.submit(plan), await drive.submit(plan)
    assert [stop.task for stop in first.stops] == [stop.task for stop in again.stops]
    with pytest.raises(RefusedError, match="'r1' drives plan 'plan-1'"):
        await drive.submit(plan, "plan-2")


async def test_it_is_paused_by_anybody_and_goes_on_from_there(drive):
    await drive.submit()
    report = await drive.plans.pause(PausePlan("plan-1", "people on the track"), "Bob")
    assert (report.state, report.by, report.reason) == (PlanState.PAUSED, "Bob", "people on the track")
    await drive.go(times=4)
    assert len(drive.cones()) <= 2
    with pytest.raises(OutdatedError):
        await drive.plans.resume(ResumePlan("plan-1", report.revision - 1), "Ada")
    await drive.plans.resume(ResumePlan("plan-1", report.revision), "Ada")
    await drive.line.advance()
    await drive.go(times=8)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == ALL


@pytest.mark.parametrize("set_back", [0.0, 365 * 86400.0])
async def test_the_cones_of_a_lost_robot_are_placed_by_another_by_itself(drive, set_back):
    await drive.submit(by_itself=True)
    await drive.go(robots=["r1"])
    drive.yard.now += LOST
    watch = ClockWatch(drive.yard.clock)
    drive.yard.clock.wall -= set_back
    if set_back:
        drive.yard.fleet.clock_was_set(watch.measure_step())
    await drive.lose()
    assert (await drive.seen()).state is PlanState.REPLANNING
    await drive.planned()
    report = await drive.seen()
    assert (report.state, report.robots, report.problems) == (PlanState.DRIVEN, ["r1"], [])
    await drive.line.advance()
    await drive.go(robots=["r1"], times=8)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == ALL
    assert (await drive.line.report("r2")).tasks == []


async def test_a_new_plan_by_which_robots_come_too_near_is_not_sent_by_itself(drive):
    # r2 is lost 10 m from its next cone: whoever places that one stands closer to r2 than is allowed.
    await drive.submit(by_itself=True, apart_m=25.0)
    await drive.go(robots=["r1"])
    await drive.lose()
    await drive.planned()
    report = await drive.seen()
    assert report.state is PlanState.PROPOSED and report.meetings
    assert (await drive.line.report("r1")).state.value == "paused"
    await drive.plans.confirm(ConfirmReplan("plan-1", report.revision), "Bob")
    assert (await drive.seen()).state is PlanState.DRIVEN


async def test_unless_that_was_chosen_somebody_has_to_ask_and_to_confirm(drive):
    await drive.submit()
    await drive.go(robots=["r1"])
    await drive.lose()
    report = await drive.seen()
    assert report.state is PlanState.DRIVEN and [one.robot for one in report.problems] == ["r2"]
    await drive.plans.replan(Replan("plan-1", report.revision), "Bob")
    await drive.planned()
    report = await drive.seen(documents=True)
    assert report.state is PlanState.PROPOSED and report.proposal is not None
    assert (await drive.line.report("r1")).state.value == "paused"
    discarded = await drive.plans.discard(DiscardReplan("plan-1", report.revision), "Bob")
    assert discarded.state is PlanState.DRIVEN and (await drive.line.report("r1")).state.value == "running"
    await drive.plans.replan(Replan("plan-1", discarded.revision), "Bob")
    await drive.planned()
    await drive.plans.confirm(ConfirmReplan("plan-1", (await drive.seen()).revision), "Bob")
    await drive.line.advance()
    await drive.go(robots=["r1"], times=8)
    assert drive.cones() == ALL


async def test_a_cone_begun_since_the_plan_was_looked_at_last_is_not_given_to_another(drive):
    await drive.submit()
    await drive.drive_on(robots=["r1"], times=2)
    report = await drive.seen()
    await drive.plans.replan(Replan("plan-1", report.revision), "Ada")
    await drive.planned()
    await drive.plans.confirm(ConfirmReplan("plan-1", (await drive.seen()).revision), "Ada")
    await drive.line.advance()
    await drive.go(times=8)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == ALL


@pytest.mark.parametrize("cones", [("c1", "c2"), tuple(CONES)], ids=["its last one", "with others to come"])
async def test_a_cone_that_a_robot_was_at_when_it_was_planned_again_is_not_forgotten(drive, cones):
    await drive.submit(plan_of(cones=cones), by_itself=True)
    for robot in ("r1", "r2"):
        await drive.yard.acknowledge_all(robot)
    # What each robot is at counts as done in the plan of what is left; then one of them is lost over it.
    report = await drive.seen()
    await drive.plans.replan(Replan("plan-1", report.revision), "Ada")
    await drive.plans.follow()
    await drive.planned()
    assert (await drive.seen()).state is PlanState.DRIVEN
    await drive.line.advance()
    await drive.go(robots=["r1"])
    await drive.lose()
    assert (await drive.seen()).state is PlanState.REPLANNING
    await drive.planned()
    assert (await drive.seen()).robots == ["r1"]
    await drive.line.advance()
    await drive.go(robots=["r1"], times=8)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == [(cone,) for cone in cones]


@pytest.mark.parametrize("moment", ["before", "while it is confirmed"])
async def test_a_proposal_is_refused_when_one_of_its_cones_was_begun(drive, monkeypatch, moment):
    await drive.submit()
    await drive.plans.replan(Replan("plan-1", 1), "Ada")
    await drive.planned()
    report = await drive.seen()

    async def go_on():
        for robot in ("r1", "r2"):
            await drive.line.resume(robot)
        await drive.drive_on(times=2)

    if moment == "before":
        await go_on()
    else:
        enter = drive.yard.fleet.queues.enter

        async def enter_late(*args):
            await go_on()
            return await enter(*args)

        monkeypatch.setattr(drive.yard.fleet.queues, "enter", enter_late)
    with pytest.raises(RefusedError, match=r"(begun|placed) since .*replan"):
        await drive.plans.confirm(ConfirmReplan("plan-1", report.revision), "Ada")
    monkeypatch.undo()
    report = await drive.plans.discard(DiscardReplan("plan-1", report.revision), "Ada")
    await drive.go(times=8)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == ALL


async def test_a_lost_robot_that_places_its_cone_all_the_same_has_the_proposal_refused(drive):
    await drive.submit()
    await drive.go(robots=["r1"])
    await drive.lose()
    await drive.plans.replan(Replan("plan-1", (await drive.seen()).revision), "Bob")
    await drive.planned()
    await drive.drive_on(robots=["r2"], times=2)
    with pytest.raises(RefusedError, match=r"placed since .*replan"):
        await drive.plans.confirm(ConfirmReplan("plan-1", (await drive.seen()).revision), "Bob")
    await drive.plans.replan(Replan("plan-1", (await drive.seen()).revision), "Bob")
    await drive.planned()
    await drive.plans.confirm(ConfirmReplan("plan-1", (await drive.seen()).revision), "Bob")
    await drive.line.advance()
    await drive.go(times=8)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == ALL


@pytest.mark.parametrize("state", ["driven", "proposed"])
async def test_a_gateway_that_is_started_again_goes_on_with_it(drive, state):
    await drive.submit(by_itself=state == "driven")
    await drive.go()
    before = drive.cones()
    if state == "proposed":
        await drive.plans.replan(Replan("plan-1", 1), "Ada")
        await drive.planned()
    tasks = [stop.task for stop in (await drive.seen()).stops]
    poses = {robot: drive.yard.fleet.robots.get(robot).pose for robot in ("r1", "r2")}
    places = {robot: (pose.x, pose.y) for robot, pose in poses.items()}
    await drive.restart()
    report = await drive.seen()
    assert (report.state.value, report.done) == (state, len(before))
    assert [stop.task for stop in report.stops] == tasks
    for robot, (x, y) in places.items():
        await drive.yard.ready(robot)
        await drive.yard.at(x, y, robot=robot)
    if state == "proposed":
        await drive.plans.confirm(ConfirmReplan("plan-1", report.revision), "Bob")
    await drive.line.advance()
    await drive.go(times=10)
    assert (await drive.seen()).state is PlanState.FINISHED and drive.cones() == ALL


async def test_after_a_restart_robots_have_time_to_come_back_before_it_is_planned_again(drive):
    await drive.submit(by_itself=True)
    await drive.go(robots=["r1"])
    pose = drive.yard.fleet.robots.get("r1").pose
    drive.yard.now += 60.0
    await drive.restart()
    drive.yard.fleet.age()
    await drive.plans.follow()
    report = await drive.seen()
    assert report.state is PlanState.DRIVEN and len(report.problems) == 2
    await drive.yard.ready("r1")
    await drive.yard.at(pose.x, pose.y)
    await drive.plans.follow()
    assert (await drive.seen()).state is PlanState.DRIVEN
    await drive.lose()
    assert (await drive.seen()).state is PlanState.REPLANNING
    await drive.planned()
    assert (await drive.seen()).robots == ["r1"]


async def test_planning_that_counts_no_more_says_nothing_of_what_is_planned_instead(drive, monkeypatch):
    begun, may_end = asyncio.Event(), threading.Event()
    loop, counts = asyncio.get_running_loop(), [99, 0]

    def count(_proposal, _ground):
        meetings = counts.pop(0)
        if meetings:
            loop.call_soon_threadsafe(begun.set)
            may_end.wait(60)
        return meetings

    monkeypatch.setattr("robot_bridge.gateway.plans.replanning.count_meetings", count)
    await drive.submit()
    await drive.plans.replan(Replan("plan-1", 1), "Ada")
    await begun.wait()
    tasks = drive.plans._replanner._tasks
    discarded = await drive.plans.discard(DiscardReplan("plan-1", (await drive.seen()).revision), "Ada")
    await drive.plans.replan(Replan("plan-1", discarded.revision), "Ada")
    await tasks.wait(1)
    may_end.set()
    await tasks.wait()
    report = await drive.seen()
    assert (report.state, report.meetings) == (PlanState.PROPOSED, 0)


async def test_planning_that_the_gateways_end_cut_short_begins_anew(drive):
    await drive.submit()
    await drive.plans.replan(Replan("plan-1", 1), "Ada")
    await drive.plans.finish()
    await drive.restart()
    assert (await drive.seen()).state is PlanState.REPLANNING
    await drive.planned()
    assert (await drive.seen()).state is PlanState.PROPOSED


async def test_after_an_emergency_stop_it_waits_for_somebody(drive):
    await drive.submit(by_itself=True)
    await drive.go()
    await drive.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await drive.line.advance()
    await drive.plans.follow()
    report = await drive.seen()
    assert (report.state, report.by_itself) == (PlanState.PAUSED, False)
    with pytest.raises(RefusedError, match="emergency stop"):
        await drive.plans.resume(ResumePlan("plan-1", report.revision), "Ada")
    with pytest.raises(RefusedError, match="emergency stop"):
        await drive.plans.replan(Replan("plan-1", report.revision), "Ada")
    await drive.yard.fleet.emergency.clear(ClearEmergencyStop("seen"), "Sue")
    done = drive.cones()
    await drive.lose()
    assert (await drive.seen()).state is PlanState.PAUSED and drive.cones() == done


async def test_a_plan_that_is_cleared_is_followed_no_more_and_its_tasks_stay(drive):
    await drive.submit()
    report = await drive.plans.clear(ClearPlan("plan-1"), "Bob")
    assert report.state is PlanState.CLEARED
    assert await drive.plans.clear(ClearPlan("plan-1"), "Bob") == report
    assert (await drive.line.report("r1")).tasks
    await drive.submit(plan_of(), "plan-2")


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"document": {}}, "no plan"),
        ({"cones": []}, "does not name cone"),
    ],
)
async def test_what_is_no_plan_is_refused(drive, change, why):
    plan = plan_of()
    asked = {"document": document_of(plan), "cones": [PlanCone(one.id, one.id) for one in plan.targets]}
    with pytest.raises(RefusedError, match=why):
        await drive.plans.submit(SubmitPlan("plan-1", **{**asked, **change}), "Ada")


@pytest.mark.parametrize(
    "wrong", [{"plan": ""}, {"plan": "a\nb"}, {"seconds": 0}, {"clearance_m": -1}, {"stand": [(0, 0)] * 5001}]
)
def test_bounds_of_a_submission(wrong):
    with pytest.raises(MessageError):
        SubmitPlan(**{"plan": "p", "document": {}, "cones": [], **wrong})


async def test_planning_that_takes_too_long_leaves_the_robots_standing_and_says_so(drive, monkeypatch):
    monkeypatch.setattr("robot_bridge.gateway.plans.replanning.PATIENCE", 0.0)
    await drive.submit()
    await drive.plans.replan(Replan("plan-1", 1), "Ada")
    await drive.planned()
    report = await drive.seen()
    assert report.state is PlanState.PAUSED and "could not be planned" in report.reason


async def test_paths_that_are_led_round_what_stands_are_driven(drive):
    plan = plan_of(["r1"])
    (one,) = plan.robots
    first, *others = one.stops
    (x, y), end = first.path[0], first.path[-1]
    bent = replace(first, path=((x, y), ((x + end[0]) / 2, y + 2.0), end))
    trip = replace(one.trips[0], stops=(bent, *others))
    await drive.submit(replace(plan, robots=(replace(one, trips=(trip,)),)))
    assert (await drive.line.report("r1", paths=True)).tasks[0].path[1][1] == y + 2.0


async def test_a_stop_at_which_a_cone_is_collected_names_the_placed_cone(drive):
    plan = plan_of(["r1"], ["c1"])
    await drive.submit(plan)
    await drive.go(robots=["r1"], times=2)
    target = replace(plan.targets[0], kind=COLLECT)
    store = Store("depot", 20.0, 40.0, 0.0)
    job = AssignmentJob((target,), (PlanRobot("r1", 30.0, 40.0, 4),), (store,), STAY)
    collecting = assign(job, StraightTravel(job), Objective(time_limit_s=0.2))
    request = SubmitPlan("back", document_of(collecting), [PlanCone("c1", "c1", "row", 1, 0.0)], seconds=0.2)
    report = await drive.plans.submit(request, "Ada")
    assert {stop.id: stop.placement for stop in report.stops} == {"c1": 1, "depot": None}


@pytest.fixture(params=["postgresql", "mariadb"])
def server_url(request, new_database):
    return new_database(request.param)


@pytest.fixture
async def server_drive(server_url, site_maps):
    from tests.support.bridge.queue_line import Line
    from tests.support.bridge.yard import yard_of_two

    async with yard_of_two(site_maps, server_url) as yard:
        for robot in ("r1", "r2"):
            await yard.at(20.0, 40.0, robot=robot)
        yield Drive(Line(yard))


async def test_a_server_keeps_it_as_well(server_drive):
    await test_a_gateway_that_is_started_again_goes_on_with_it(server_drive, "proposed")


async def test_what_nobody_foresaw_of_one_plan_keeps_no_other_from_being_followed(drive, monkeypatch, caplog):
    await drive.submit(plan_of(["r1"], ["c1"]), "first")
    await drive.submit(plan_of(["r2"], ["c2"]), "second")
    follow = drive.plans._check

    async def fails_of_the_first(one):
        if one.plan.name == "first":
            raise ZeroDivisionError
        await follow(one)

    monkeypatch.setattr(drive.plans, "_check", fails_of_the_first)
    await drive.go(times=3)
    assert (await drive.seen("second")).state is PlanState.FINISHED
    assert (await drive.seen("first")).state is PlanState.DRIVEN and "plan first" in caplog.text
