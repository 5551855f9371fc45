"""Cone plans across three gateways: robots at all, a desk at each, and who carries it on is killed."""

from __future__ import annotations

import contextlib
import itertools
import threading

import pytest
from websockets.exceptions import ConnectionClosed

from robot_bridge.core.assignment.job import STAY, AssignmentJob, ConeTarget, PlanRobot, StraightTravel
from robot_bridge.core.assignment.plan import document_of
from robot_bridge.core.assignment.solver import Objective, assign
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.gateway_pair import GatewayPair, desk_at
from tests.support.patience import BUSY
from tests.support.wire import RefusedError

NUMBERS = itertools.count(1)


@pytest.fixture(scope="module")
def trio(start_bridge, giving_up_site, fleet_url, nats, tmp_path_factory):
    """Three gateways, of which a began first: it carries on what plans do by themselves."""
    folder = tmp_path_factory.mktemp("state")
    return GatewayPair(start_bridge, giving_up_site, fleet_url, folder, "--bus", nats.url, three=True)


@pytest.fixture
def name():
    return f"plan-{next(NUMBERS)}"


@pytest.fixture
def robots(trio, name):
    """Two reference robots, the one at gateway a and the other at b, which end with the test."""
    names = [f"{name}-r1", f"{name}-r2"]
    places = [(20.0, 40.0), (20.0, 46.0)]
    started = [
        bridge.start_robot(robot, (*place, 0.0), options=["--speed", "8"])
        for bridge, robot, place in zip((trio.a, trio.b), names, places, strict=True)
    ]
    yield dict(zip(names, started, strict=True))
    for process in started:
        if process.poll() is None:
            process.kill()
            process.wait(BUSY * 5)


def submission(name, robots, count=8, **more):
    """Return what asks for a plan by which ``robots`` place ``count`` cones."""
    cones = [ConeTarget(f"{name}-c{k}", 30.0 + 6 * (k // 2), 40.0 + 6 * (k % 2)) for k in range(count)]
    drivers = tuple(
        PlanRobot(robot, 20.0, 40.0 + 6 * k, count, aboard=count) for k, robot in enumerate(robots)
    )
    job = AssignmentJob(tuple(cones), drivers, (), STAY)
    plan = assign(job, StraightTravel(job), Objective(time_limit_s=0.2))
    return {
        "plan": name,
        "document": document_of(plan),
        "cones": [{"id": cone.id, "cone": cone.id} for cone in cones],
        "seconds": 0.2,
        **more,
    }


def desks_of(trio, robots):
    desks = [desk_at(bridge, operator=operator) for bridge, operator in (
        (trio.a, "Ada"), (trio.b, "Ben"), (trio.c, "Cleo"),
    )]  # fmt: skip
    for desk in desks:
        desk.wait_for_robots(*robots)
    return desks


def placed(trio, name):
    """Return how often each cone of a plan was put down."""
    query = "select cone, count(*) from placements where plan = ? group by cone order by cone"
    return dict(trio.c.sql(query, name))


def is_in(desk, name, *states):
    return desk.plans.get(name, {}).get("state") in states


def owners(trio, robots):
    query = "select robot, gw from robot_owners where robot = any(cast(? as text[]))"
    return dict(trio.c.sql(query, "{" + ",".join(robots) + "}"))


def test_a_plan_goes_on_when_the_gateway_that_carries_it_on_is_killed(trio, robots, name):
    ada, ben, cleo = desks_of(trio, robots)
    assert set(owners(trio, robots).values()) == {"a", "b"}
    report = cleo.ask("submit_plan", submission(name, robots))
    assert (report["state"], sorted(report["robots"])) == ("driven", sorted(robots))
    for desk in (ada, ben):
        desk.until(lambda desk=desk: is_in(desk, name, "driven"))
    # The same again, at another gateway, is the same plan.
    again = ben.ask("submit_plan", submission(name, robots))
    assert [stop["task"] for stop in again["stops"]] == [stop["task"] for stop in report["stops"]]
    wait_until(lambda: len(placed(trio, name)) >= 2)
    trio.a.kill_gateway()
    for desk in (ben, cleo):
        desk.until(lambda desk=desk: is_in(desk, name, "finished"), 60.0)
    assert placed(trio, name) == dict.fromkeys([f"{name}-c{k}" for k in range(8)], 1)
    # Every desk is sent every cone, whoever's robot put it down.
    cones = {f"{name}-c{k}" for k in range(8)}
    for desk in (ben, cleo):
        desk.until(lambda desk=desk: cones <= {one["cone"] for one in desk.placements.values()})
        assert [one["plan"] for one in desk.ask("get_plans")["plans"]].count(name) == 1
    assert "a" not in owners(trio, robots).values()
    trio.a.start_gateway()


def test_what_is_left_is_planned_by_whoever_is_there(trio, robots, name):
    """A robot is lost, and the gateway that would plan its cones for others is killed with it."""
    first, second = robots
    cleo = desks_of(trio, robots)[2]
    # Wherever the lost one comes to stand, it is in nobody's way.
    anywhere = {"clearance_m": 0.0, "apart_m": 0.0}
    cleo.ask("submit_plan", submission(name, robots, by_itself=True, **anywhere))
    wait_until(lambda: len(placed(trio, name)) >= 2)
    leader = leading(trio)
    other = next(bridge for bridge in (trio.a, trio.b, trio.c) if bridge is not leader)
    robots[second].kill()
    leader.kill_gateway()
    desk = desk_at(other)
    desk.ask("get_plans", {"plan": name})
    desk.until(lambda: is_in(desk, name, "finished"), 30.0)
    assert placed(trio, name) == {f"{name}-c{k}": 1 for k in range(8)}
    assert desk.plans[name]["robots"] == [first]
    leader.start_gateway()


class Speaker:
    """Says where robots are, again and again: on a busy machine a step takes longer than a silence may."""

    def __init__(self):
        self._lock, self._over, self._said = threading.Lock(), threading.Event(), {}
        self._thread = threading.Thread(target=self._repeat, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._thread.join()

    def say(self, wire, x, y, v=0.0):
        with self._lock:
            self._said[wire] = {"x": x, "y": y, "theta": 0.5, "v": v}
            wire.tell("SendPos", self._said[wire])
        wire.listen(0.1)

    def _repeat(self):
        while not self._over.wait(0.5):
            with self._lock:
                for wire, place in self._said.items():
                    # Its gateway was killed, or the test is over.
                    with contextlib.suppress(ConnectionClosed, OSError):
                        wire.tell("SendPos", place)


@pytest.fixture
def speaker():
    with Speaker() as speaker:
        yield speaker


@pytest.fixture
def wires(trio, name, speaker):
    """Robots that do nothing by themselves, at gateway a and at b."""
    places = {f"{name}-r1": (20.0, 40.0), f"{name}-r2": (20.0, 46.0)}
    at = (trio.a, trio.b)
    robots = {}
    for bridge, (robot, place) in zip(at, places.items(), strict=True):
        robots[robot] = trio.robot(bridge, robot, at=place)
        speaker.say(robots[robot], *place)
    return robots


def state_of(desk, robot):
    return desk.queues.get(robot, {}).get("state")


def test_every_desk_sees_pauses_replans_and_ends_a_plan(trio, name, wires, speaker):
    robots = wires
    ada, ben, cleo = desks_of(trio, robots)
    ben.ask("submit_plan", submission(name, robots))
    for wire in robots.values():
        wire.hear("SetPath")
    paused = cleo.ask("pause_plan", {"plan": name, "reason": "people on the track"})
    assert (paused["state"], paused["by"]) == ("paused", "Cleo")
    for desk in (ada, ben):
        desk.until(lambda desk=desk: is_in(desk, name, "paused"))
        desk.until(lambda desk=desk: {state_of(desk, robot) for robot in robots} == {"paused"})
    # One that has seen an older plan is refused, with the newer one.
    with pytest.raises(RefusedError, match="at revision 2, not 1") as refused:
        ada.ask("resume_plan", {"plan": name, "revision": 1})
    assert refused.value.data["state"] == "paused"
    for wire, y in zip(robots.values(), (40.0, 46.0), strict=True):
        speaker.say(wire, 20.0, y)
    going_on = ada.ask("resume_plan", {"plan": name, "revision": paused["revision"]})
    cleo.until(lambda: is_in(cleo, name, "driven"))
    cleo.until(lambda: {state_of(cleo, robot) for robot in robots} == {"running"})
    ben.ask("replan", {"plan": name, "revision": going_on["revision"]})
    # It is planned at the gateway that leads, and confirmed at any.
    cleo.until(lambda: is_in(cleo, name, "proposed"))
    confirmed = cleo.ask("confirm_replan", {"plan": name, "revision": cleo.plans[name]["revision"]})
    assert confirmed["state"] == "driven"
    ada.until(lambda: {state_of(ada, robot) for robot in robots} == {"running"})
    # A stop pauses it, and nothing of it goes on before somebody says so.
    ben.ask("emergency_stop", {"command": f"stop-{name}"})
    for wire in robots.values():
        assert wire.obey_until("Abort")["params"]["emergency"]
    cleo.until(lambda: is_in(cleo, name, "paused"))
    with pytest.raises(RefusedError, match="emergency stop is in force"):
        cleo.ask("resume_plan", {"plan": name, "revision": cleo.plans[name]["revision"]})
    ben.ask("clear_emergency_stop", {"reason": "seen"})
    ada.ask("clear_plan", {"plan": name})
    for desk in (ben, cleo):
        desk.until(lambda desk=desk: is_in(desk, name, "cleared"))
    for wire in robots.values():
        # By its answer what was sent before has come.
        wire.ask("Alive")
    assert not [call for wire in robots.values() for call in wire.calls if call["method"] == "SetPath"]


@pytest.mark.parametrize("round", range(2))
def test_a_robot_has_one_plan_whichever_gateway_is_asked(trio, name, wires, round):
    ada, ben, _ = desks_of(trio, wires)
    plans = [submission(f"{name}-{number}", wires) for number in range(2)]
    asked = [(desk, desk.begin("submit_plan", plan)) for desk, plan in zip((ada, ben), plans, strict=True)]
    entered = []
    for desk, id in asked:
        with contextlib.suppress(RefusedError):
            entered.append(desk.answer(id)["plan"])
    (plan,) = entered
    stored = trio.c.sql("select distinct plan from plan_stops where plan like ?", f"{name}-%")
    assert stored == [(plan,)]
    open_tasks = "select count(*) from queue_tasks where state in ('waiting', 'current') and robot like ?"
    assert trio.c.sql(open_tasks, f"{name}-%") == [(8,)]
    ben.ask("clear_plan", {"plan": plan})


def test_tasks_are_taken_over_by_a_robot_of_another_gateway(trio, name, wires):
    """The task that is being done, too: its robot is aborted by its own gateway."""
    giver, taker = robots = wires
    cleo = desks_of(trio, robots)[2]
    tasks = [
        {"task": f"{name}-t{k}", "x": 30.0 + k, "y": 40.0, "path": [[20.0, 40.0], [30.0 + k, 40.0]]}
        for k in range(2)
    ]
    queue = cleo.ask("set_queue", {"robot": giver, "revision": 0, "tasks": tasks})
    robots[giver].hear("SetPath")
    paths = [[[20.0, 46.0], [30.0 + k, 40.0]] for k in range(2)]
    shared = [{"task": one["task"], "path": path} for one, path in zip(tasks, paths, strict=True)]
    shares = [{"robot": taker, "revision": 0, "tasks": shared}]
    given = {"robot": giver, "revision": queue["revision"], "shares": shares}
    found = cleo.ask("take_over", given)["queues"]
    assert {one["robot"]: len(one["tasks"]) for one in found} == {giver: 0, taker: 2}
    robots[giver].hear("Abort")
    assert robots[taker].hear("SetPath")["points"] == paths[0]
    cleo.until(lambda: len(cleo.queues.get(taker, {}).get("tasks", ())) == 2)
    cleo.until(lambda: cleo.queues[taker]["tasks"][0]["state"] == "current")
    cleo.until(lambda: state_of(cleo, giver) == "paused")


def test_a_robot_gives_way_to_one_of_another_gateway(trio, name, speaker):
    first, second = f"{name}-r1", f"{name}-r2"
    one = trio.robot(trio.a, first, at=(16.0, 8.0))
    two = trio.robot(trio.b, second, at=(13.0, 22.0))
    speaker.say(one, 16.0, 8.0)
    speaker.say(two, 13.0, 22.0)
    ada, ben, cleo = desks_of(trio, [first, second])
    ben.send(f"c-{first}", first, "SetPath", points=[[16.0, 8.0], [44.0, 22.0], [90.0, 22.0]])
    ben.send(f"c-{second}", second, "SetPath", points=[[13.0, 22.0], [56.0, 22.0], [56.0, 40.0]])
    for wire in (one, two):
        wire.hear("SetPath")

    def meet(desk):
        found = desk.ask("get_conflicts")["conflicts"]
        return [one for one in found if {one["robot"], one["other"]} == {first, second}]

    for desk in (ada, ben, cleo):
        wait_until(lambda desk=desk: meet(desk))
    ways = cleo.ask("get_ways_out", {"robot": first, "other": second})["ways"]
    assert any(way["possible"] and way["robot"] == first for way in ways)
    asked = {"robot": first, "other": second, "by": "waiting"}

    def resolved():
        with contextlib.suppress(RefusedError):
            return cleo.ask("resolve_conflict", asked)

    assert wait_until(resolved)["became"] == "waits"
    waits_at = one.hear("SetPath")["points"][-1]
    for share in (0.5, 1.0):
        x, y = (16.0 + share * (waits_at[0] - 16.0), 8.0 + share * (waits_at[1] - 8.0))
        speaker.say(one, x, y, 1.0 - share)
    # Its gateway dies. The one that has it then sends it on once it need not wait any more.
    assert trio.c.sql("select other from holds where robot = ?", first) == [(second,)]
    trio.a.kill_gateway()
    trio.c.sql("update holds set until = 0 where robot = ?", first)
    speaker.say(two, 56.0, 22.0, 1.0)
    speaker.say(two, 56.0, 40.0)
    cleo.wait_for_step(f"c-{second}", "reached")
    one = trio.robot(trio.c, first, at=tuple(waits_at))
    speaker.say(one, *waits_at)
    call = one.wait_for("SetPath", 20.0)
    assert call["params"]["points"][-1] == [90.0, 22.0]
    trio.a.start_gateway()


def leading(trio):
    alive = "select gw from gateways where lease_until > extract(epoch from clock_timestamp()) order by since"
    return getattr(trio, trio.c.sql(alive)[0][0])
