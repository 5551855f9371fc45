"""Commands of the gateway as orders, and a vehicle's states as the life of a command."""

from __future__ import annotations

import pytest
from fleet_supervisor.robot_bridge.core.messages.robots import (
    Alive,
    SendPos,
    SetPath,
    SetPosEnd,
    SetPosIni,
    Stopped,
)
from fleet_supervisor.robot_bridge.links.vda5050.ledger import MOST_REMEMBERED, Keep, Ledger, Publish, Settled
from fleet_supervisor.robot_bridge.links.vda5050.presence import MOST_FAULTS, MOST_GREETINGS
from fleet_supervisor.robot_bridge.links.vda5050.tasks import Remembered, RouteLimits, VehicleTask, begin_plan
from fleet_supervisor.robot_bridge.links.vda5050.vehicle import MOST_RESUMED

from tests.robot_bridge.links.vda5050.bench import Bench, fault

TARGET = SetPosEnd(120.0, 50.0)
LONG = SetPath([(100.0, 50.0), (200.0, 50.0), (200.0, 150.0)])


@pytest.fixture(params=["2.1.0", "3.0.0"])
def bench(request):
    made = Bench(version=request.param)
    made.connect()
    return made


def run_to(bench, node):
    """Have the vehicle follow its newest order to ``node``."""
    order = bench.orders[-1]
    x, y = (order.nodes[0].node_position.x, 0.0)
    for one in order.nodes:
        if one.sequence_id == 2 * node:
            x, y = one.node_position.x, one.node_position.y
    bench.state["agvPosition"].update(x=x, y=y)
    bench.accept(order, passed=node)


def test_a_vehicle_that_is_admitted_says_where_it_is():
    bench = Bench()
    bench.hear("connection", {"connectionState": "ONLINE"}, retained=True)
    assert not bench.controller.is_known and "stateRequest" in str(bench.published)
    bench.show()
    assert bench.controller.is_known and bench.sent == []

    bench.admit()
    pose = bench.saying(SendPos)[-1]
    assert (pose.x, pose.y, pose.v, pose.battery) == (100.0, 50.0, 0.0, 0.8)
    bench.wait(1)
    assert bench.saying(Alive)


def test_a_target_is_acknowledged_when_the_vehicle_shows_the_order(bench):
    bench.tell(TARGET, 7)
    (order,) = bench.orders
    assert [(n.node_position.x, n.node_position.y) for n in order.nodes] == [(0.0, 0.0), (20.0, 0.0)]
    assert bench.settled == []

    bench.accept(order)
    assert bench.settled == [Settled(7)]

    run_to(bench, 1)
    assert isinstance(bench.sent[-1], Stopped) and bench.sent[-2].x == 120.0
    assert bench.sent[-2].v == 0.0


def test_what_the_vehicle_refuses_fails_with_its_words(bench):
    bench.tell(TARGET, 7)
    bench.show(errors=[fault("no route to node", orderId=bench.orders[0].order_id)])

    assert bench.settled == [Settled(7, "orderError: no route to node")]
    bench.clear()
    bench.wait(5)
    assert bench.orders == []


def test_a_refusal_that_names_no_order_is_known_by_its_kind(bench):
    bench.show(errors=[fault("an old one")])
    bench.tell(TARGET, 7)
    bench.show()
    assert bench.settled == []
    bench.show(errors=[fault("an old one"), fault("battery empty")])
    assert bench.settled == [Settled(7, "orderError: battery empty")]


def test_an_order_that_is_not_shown_is_published_again_and_then_taken_back(bench):
    bench.tell(TARGET, 7)
    bench.wait(5)
    assert len({(o.order_id, o.order_update_id) for o in bench.orders}) == 1 < len(bench.orders)
    order = bench.orders[0]
    bench.wait(6)
    assert "has not accepted the order" in bench.settled[0].reason
    assert "cancelOrder" in bench.actions

    # It comes to it all the same, much later: what was refused is not driven.
    bench.show(errors=[])
    bench.wait(6)
    bench.show()
    bench.clear()
    bench.accept(order)
    assert bench.actions == ["cancelOrder"]


def test_a_long_path_is_released_piece_by_piece(bench):
    bench.tell(LONG, 7)
    passed = 0
    for _ in range(40):
        order = bench.orders[-1]
        base = max(n.sequence_id for n in order.nodes if n.released) // 2
        passed = min(passed + 1, base)
        run_to(bench, passed)
        if bench.saying(Stopped):
            break
        bench.wait(0.5)

    updates = {order.order_update_id for order in bench.orders}
    assert updates == set(range(len(updates))) and len(updates) > 3
    assert len({order.order_id for order in bench.orders}) == 1
    assert bench.settled == [Settled(7)]
    assert bench.saying(SendPos)[-1].x == 200.0 and bench.saying(SendPos)[-1].y == 150.0


def test_an_update_that_the_vehicle_refuses_fails_the_command_and_stops_it(bench):
    bench.tell(LONG, 7)
    run_to(bench, 1)
    update = bench.orders[-1]
    assert update.order_update_id == 1
    bench.show(errors=[fault("no stitching", orderId=update.order_id, orderUpdateId="1")])

    assert bench.settled[-1] == Settled(7, "orderError: no stitching")
    assert bench.actions == ["cancelOrder"]


def test_an_order_that_the_vehicle_ends_early_fails(bench):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    faults = [fault("blocked by a pallet", level="FATAL")]
    bench.show(nodeStates=[], edgeStates=[], driving=False, errors=faults)

    assert bench.settled[-1].reason == (
        "the vehicle ended its order at node 0: orderError: blocked by a pallet"
    )


def test_cones_are_refused(bench):
    bench.tell(SetPosEnd(120.0, 50.0, cone=True), 7)
    assert bench.settled == [Settled(7, "vehicles of VDA 5050 place and collect no cones")]


@pytest.mark.parametrize("seconds", [0.0, 3.0])
def test_an_abort_cancels_and_is_acknowledged_when_the_vehicle_stands(bench, seconds):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    bench.clear()
    bench.halt()
    assert bench.actions == ["cancelOrder"] and bench.halts == 0

    bench.wait(seconds)
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FINISHED"}
    bench.show(nodeStates=[], edgeStates=[], driving=False, actionStates=[cancel])
    assert bench.halts == 1
    assert ("startPause" in bench.actions) == (seconds > 2)


def test_an_abort_of_a_vehicle_that_drives_on_pauses_it_and_is_said(bench):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    bench.halt()
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "RUNNING"}
    bench.show(actionStates=[cancel])
    bench.wait(6)

    assert bench.actions.count("cancelOrder") == 1, "one that runs is not repeated"
    assert bench.actions.count("startPause") > 1
    assert "DRIVES ON" in bench.saying(SendPos)[-1].status
    assert bench.halts == 0

    bench.show(paused=True, driving=False)
    assert bench.halts == 1
    assert "stands paused" in bench.saying(SendPos)[-1].status


def test_an_abort_that_nothing_answers_is_repeated_and_said(bench):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    bench.halt()
    bench.live(6)
    assert bench.actions.count("cancelOrder") > 2
    assert "DOES NOT ANSWER" in bench.saying(SendPos)[-1].status


def test_an_emergency_stop_pauses_at_once_and_before_anything_is_kept(bench):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    bench.clear()
    bench.halt(emergency=True)

    assert [type(e) for e in bench.effects[:2]] == [Publish, Publish]
    assert bench.actions == ["cancelOrder", "startPause"]
    assert any(isinstance(e, Keep) for e in bench.effects[2:])


def test_the_pause_of_an_emergency_stop_ends_with_the_next_task(bench):
    bench.halt(emergency=True)
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FAILED"}
    bench.show(paused=True, actionStates=[cancel])
    bench.wait(1)
    assert bench.halts == 1 and "stopPause" not in bench.actions

    bench.clear()
    bench.tell(TARGET, 9)
    assert bench.actions == ["stopPause"] and bench.orders == []
    bench.show(paused=False)
    assert len(bench.orders) == 1


def test_a_pause_that_waits_behind_another_is_lifted_before_the_vehicle_drives(bench):
    bench.halt(emergency=True)
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FINISHED"}
    waiting = {"actionId": "p2", "actionType": "startPause", "actionStatus": "PAUSED"}
    bench.show(paused=True, actionStates=[cancel, waiting])
    bench.clear()
    bench.tell(TARGET, 9)
    bench.show(paused=False, actionStates=[cancel, waiting])
    assert bench.actions == ["stopPause"] and bench.orders == []

    bench.show(paused=True, actionStates=[cancel, waiting | {"actionStatus": "FINISHED"}])
    bench.wait(2)
    assert bench.actions == ["stopPause", "stopPause"] and bench.orders == []
    bench.show(paused=False)
    assert len(bench.orders) == 1


def test_an_idle_state_from_before_the_cancel_does_not_end_a_stop(bench):
    bench.tell(TARGET, 7)
    order = bench.orders[0]
    bench.halt()
    bench.show()  # on its way when the order was sent
    assert bench.halts == 0
    bench.accept(order)
    assert bench.halts == 0
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FINISHED"}
    bench.show(nodeStates=[], edgeStates=[], driving=False, actionStates=[cancel])
    assert bench.halts == 1


def test_another_target_cancels_first_and_then_drives(bench):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    bench.clear()
    bench.tell(TARGET, 8)
    assert bench.actions == ["cancelOrder"] and bench.orders == []

    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FINISHED"}
    bench.show(nodeStates=[], edgeStates=[], driving=False, actionStates=[cancel])
    bench.wait(0.25)
    assert bench.orders[-1].order_id.startswith("8-")


def test_a_vehicle_that_forgot_its_order_is_given_what_is_left(bench):
    bench.tell(LONG, 7)
    order = bench.orders[-1]
    run_to(bench, 1)
    bench.clear()
    bench.show(orderId="", orderUpdateId=0, nodeStates=[], edgeStates=[], lastNodeSequenceId=0, driving=False)
    bench.wait(0.25)

    again = bench.orders[-1]
    assert again.order_id != order.order_id and again.order_update_id == 0
    assert again.nodes[0].node_position.x == 25.0 and again.nodes[1].node_position.x > 25.0
    bench.accept(again)
    assert bench.settled == []


NO_ORDER = {"orderId": "", "nodeStates": [], "edgeStates": [], "lastNodeSequenceId": 0, "driving": False}
RELEASED = {"operatingMode": "AUTOMATIC", "safetyState": {"eStop": "NONE", "fieldViolation": False}}
BY_HAND = pytest.mark.parametrize(
    ("taken_over", "words"),
    [
        ({"operatingMode": "MANUAL"}, "operating mode MANUAL"),
        (
            {"safetyState": {"eStop": "MANUAL", "fieldViolation": False}},
            "own emergency stop is active",
        ),
    ],
)


@BY_HAND
@pytest.mark.parametrize("order_goes", ["with it", "when it is handed back", "before it"])
def test_a_vehicle_that_lost_its_order_by_hand_does_not_drive_off_by_itself(
    bench, taken_over, words, order_goes
):
    bench.tell(TARGET, 7)
    bench.accept(bench.orders[-1])
    bench.clear()
    if order_goes == "before it":
        bench.show(**NO_ORDER)
    bench.show(**taken_over, **(NO_ORDER if order_goes == "with it" else {}))
    assert bool(bench.settled) == (order_goes != "when it is handed back")
    bench.live(5)
    sent = len(bench.orders)
    bench.show(**RELEASED, **NO_ORDER)
    bench.live(10)
    assert len(bench.orders) == sent
    assert [one.command_id for one in bench.settled] == [7]
    assert words in bench.settled[0].reason and "send it again" in bench.settled[0].reason
    # An order that was on its way to it is not driven either.
    assert order_goes != "before it" or "cancelOrder" in bench.actions


@BY_HAND
def test_a_vehicle_that_dropped_its_nodes_by_hand_at_the_end_of_its_base_is_released_no_more(
    bench, taken_over, words
):
    bench.tell(LONG, 7)
    bench.controller.set_admitted(False, bench.now)
    run_to(bench, 1)
    bench.show(nodeStates=[], edgeStates=[], driving=False, **taken_over)
    bench.admit()
    bench.clear()
    bench.show(**RELEASED)
    bench.live(5)
    assert bench.orders == []


@BY_HAND
def test_a_vehicle_that_kept_its_order_by_hand_and_is_started_again_later_goes_on(bench, taken_over, words):
    bench.tell(TARGET, 7)
    bench.accept(bench.orders[-1])
    bench.clear()
    bench.show(**taken_over)
    bench.show(**RELEASED)
    bench.show(**NO_ORDER)
    bench.wait(0.25)
    assert bench.settled == [] and len(bench.orders) == 1


def test_a_vehicle_that_starts_up_without_its_order_goes_on():
    bench = Bench(version="3.0.0")
    bench.connect()
    bench.tell(TARGET, 7)
    bench.accept(bench.orders[-1])
    bench.clear()
    bench.show(**NO_ORDER, operatingMode="STARTUP")
    bench.live(3)
    assert bench.orders == [] and bench.settled == []
    bench.show(operatingMode="AUTOMATIC")
    bench.wait(0.25)
    assert len(bench.orders) == 1


def test_a_vehicle_that_forgets_its_order_again_and_again_is_given_it_no_more(bench):
    bench.tell(LONG, 7)
    for _ in range(MOST_RESUMED + 1):
        bench.accept(bench.orders[-1])
        bench.show(orderId="", orderUpdateId=0, nodeStates=[], edgeStates=[], lastNodeSequenceId=0)
        bench.show(driving=False)
        bench.wait(0.25)
    assert len({order.order_id for order in bench.orders}) == MOST_RESUMED + 1
    assert bench.settled[-1].reason == "the vehicle lost its order again and again"


def test_an_adapter_that_is_started_anew_goes_on(bench):
    bench.tell(LONG, 7)
    run_to(bench, 1)
    update = bench.orders[-1]
    bench.accept(update, passed=1)

    again = Bench(remembered=bench.kept, version=bench.version)
    again.state = bench.state
    again.connect()
    again.tell(LONG, 7, again=True)
    assert again.settled == [Settled(7)]
    again.wait(1)
    assert again.orders == [] and again.actions == []

    again.state["agvPosition"].update(x=100.0, y=100.0)
    passed = (update.nodes[-1].sequence_id) // 2
    again.show(nodeStates=[], edgeStates=[], lastNodeSequenceId=2 * passed, lastNodeId="n", driving=False)
    assert again.saying(Stopped)

    # The gateway was not told yet that it was taken on when the first adapter died.
    last = Bench(remembered=again.kept, version=bench.version)
    last.connect()
    last.tell(LONG, 7, again=True)
    assert last.settled == [Settled(7)] and last.orders == []


def test_an_order_that_was_not_sent_when_the_adapter_died_is_sent_then(bench):
    bench.tell(TARGET, 7)
    order = bench.orders[0]
    again = Bench(remembered=bench.kept, version=bench.version)
    again.connect()
    again.wait(20)
    assert again.orders == [], "nobody knows whether it still is to be driven"

    again.tell(TARGET, 7, again=True)
    again.wait(0.25)
    assert again.orders[0].order_id == order.order_id
    again.accept(order)
    assert again.settled == [Settled(7)]


def test_an_order_that_came_through_when_the_adapter_died_is_acknowledged(bench):
    bench.tell(TARGET, 7)
    again = Bench(remembered=bench.kept, version=bench.version)
    again.connect()
    again.accept(bench.orders[0])
    assert again.settled == [Settled(7)] and again.orders == []


def test_nothing_is_released_while_no_desk_could_stop_it(bench):
    bench.tell(LONG, 7)
    bench.controller.set_admitted(False, bench.now)
    run_to(bench, 1)
    bench.wait(5)
    assert {order.order_update_id for order in bench.orders} == {0}

    bench.admit()
    bench.wait(0.25)
    assert bench.orders[-1].order_update_id == 1


def test_the_order_of_another_fleet_control_is_said_and_fails_ours(bench):
    bench.tell(TARGET, 7)
    bench.accept(bench.orders[0])
    bench.state["orderId"] = "theirs"
    bench.show()
    assert bench.settled[-1].reason == "another fleet control gave it order 'theirs'"
    bench.wait(0.25)
    assert "order 'theirs' of somebody else" in bench.saying(SendPos)[-1].status


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"operatingMode": "MANUAL"}, "operating mode MANUAL"),
        ({"safetyState": {"eStop": "MANUAL", "fieldViolation": False}}, "emergency stop"),
    ],
)
def test_a_vehicle_that_cannot_drive_refuses_with_the_reason(bench, changes, words):
    bench.show(**changes)
    assert words in bench.saying(SendPos)[-1].status
    bench.tell(TARGET, 7)
    bench.live(9)
    assert words in bench.settled[0].reason and bench.orders == []


@pytest.mark.parametrize("topic", ["state", "visualization"])
@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mapId": "attic"}, "map 'attic' is not in the settings"),
        ({"positionInitialized": False}, "does not know where it is"),
        ({"x": 9e8}, "its position has no place on the site"),
    ],
)
def test_a_vehicle_without_a_place_is_alive_and_not_where_it_was(bench, changes, words, topic):
    bench.show(driving=True)
    here = dict(bench.state["agvPosition"])
    bench.clear()
    lost = here | changes
    bench.hear("visualization", {"agvPosition": lost})
    bench.state["agvPosition"] = lost
    for _ in range(2):
        if topic == "state":
            bench.show(driving=False)
        bench.wait(1)
    bench.admit()
    assert bench.saying(SendPos) == [] and bench.saying(Alive)
    assert words in bench.controller.status(bench.now) and words in bench.controller.alarm(bench.now)
    bench.tell(TARGET, 7)
    bench.live(9)
    assert words in bench.settled[0].reason and bench.orders == []

    bench.state["agvPosition"] = here | {"x": 3.0}
    bench.show()
    assert bench.saying(SendPos)[-1].x == 103.0 and bench.controller.alarm(bench.now) is None


def test_a_vehicle_whose_states_have_no_position_any_more_is_not_where_it_was(bench):
    del bench.state["agvPosition"]
    bench.clear()
    bench.live(2)
    assert bench.saying(SendPos) == [] and bench.saying(Alive)
    assert bench.controller.alarm(bench.now) == "the vehicle says no position"
    # One that says its position in visualization alone is where that was.
    at = {"x": 3.0, "y": 0.0, "theta": 0.0, "mapId": "hall", "positionInitialized": True}
    bench.hear("visualization", {"agvPosition": at})
    bench.clear()
    bench.live(2)
    assert bench.saying(SendPos)[-1].x == 103.0 and bench.controller.alarm(bench.now) is None


@pytest.mark.parametrize("sign", [1, -1])
def test_a_speed_that_is_none_does_not_withhold_the_position(bench, sign):
    bench.show(driving=True, velocity={"vx": sign * 100.0, "vy": 100.0})
    assert bench.saying(SendPos)[-1].v == sign * 100.0 and bench.controller.status(bench.now) is None


def test_a_vehicle_that_is_gone_refuses_and_is_not_alive(bench):
    bench.hear("connection", {"connectionState": "CONNECTIONBROKEN"})
    bench.clear()
    bench.tell(TARGET, 7)
    bench.wait(9)
    assert "CONNECTIONBROKEN" in bench.settled[0].reason
    assert bench.saying(Alive) == [] and bench.orders == []


def test_a_vehicle_with_a_task_that_answers_nothing_is_not_alive(bench):
    bench.wait(20)
    assert bench.saying(Alive), "an idle one may say its state every 30 s"
    bench.tell(TARGET, 7)
    bench.accept(bench.orders[0])
    bench.wait(8)
    assert "stateRequest" in str(bench.published)
    bench.clear()
    bench.wait(4)
    assert bench.sent == []
    bench.tell(LONG, 8)
    bench.wait(9)
    assert bench.settled[-1].reason == "the vehicle has not shown yet that it stopped"
    bench.show()
    bench.wait(2)
    assert bench.saying(Alive)


def test_a_last_will_that_comes_late_of_an_older_connection_ends_with_the_next_state(bench):
    bench.hear("connection", {"connectionState": "ONLINE"})
    bench.hear("connection", {"connectionState": "CONNECTIONBROKEN"})
    bench.clear()
    bench.wait(2)
    assert bench.sent == []
    bench.show()
    bench.wait(1)
    assert bench.saying(SendPos) and bench.saying(Alive)


def test_a_vehicle_that_leaves_in_order_says_so(bench):
    bench.hear("connection", {"connectionState": "OFFLINE"})
    assert bench.sent == [Stopped()]


def test_a_start_position_is_acknowledged_when_the_vehicle_took_it(bench):
    bench.tell(SetPosIni(110.0, 50.0, 0.5), 7)
    values = {p.key: p.value for p in bench.published[-1].actions[0].action_parameters}
    assert values == {"x": 10.0, "y": 0.0, "theta": 0.5, "mapId": "hall", "lastNodeId": ""}
    bench.show(actionStates=[{"actionId": bench.action_id("initPosition"), "actionStatus": "FINISHED"}])
    assert bench.settled == [Settled(7)]


def test_faults_are_the_status_the_worst_first(bench):
    bench.show(errors=[fault("low battery"), fault("motor", level="FATAL")])
    assert bench.saying(SendPos)[-1].status == "FATAL orderError: motor; WARNING orderError: low battery"


def test_errors_and_the_safety_state_are_an_alarm_and_warnings_are_none(bench):
    bench.show(errors=[fault("low battery"), fault("motor", level="FATAL")])
    assert bench.controller.alarm(bench.now) == "FATAL orderError: motor"
    bench.show(errors=[fault("low battery")])
    assert bench.controller.alarm(bench.now) is None
    bench.show(errors=[], safetyState={"eStop": "MANUAL", "fieldViolation": True})
    alarm = "emergency stop at the vehicle (MANUAL); protective field violated"
    assert bench.controller.alarm(bench.now) == alarm
    bench.show(safetyState={"eStop": "NONE", "fieldViolation": False})
    assert bench.controller.alarm(bench.now) is None


def test_two_vehicles_under_one_serial_number_are_said_and_sent_nowhere(bench):
    for number in (500, 3, 501, 4, 502, 5, 503):
        bench.hear("state", {**bench.state, "headerId": number})
    assert "two vehicles speak" in bench.controller.alarm(bench.now)
    assert "two vehicles speak under this serial number" in bench.saying(SendPos)[-1].status
    bench.clear()
    bench.tell(TARGET, 7)
    bench.halt()
    assert bench.orders == [] and bench.actions == ["cancelOrder"]


def test_one_that_starts_anew_is_one_vehicle(bench):
    for number in (500, 501, 0, 1, 2):
        bench.hear("state", {**bench.state, "headerId": number})
    assert bench.saying(SendPos)[-1].status is None


def test_a_retained_state_moves_no_vehicle(bench):
    bench.state["agvPosition"]["x"] = 77.0
    bench.clear()
    bench.hear("state", bench.state, retained=True)
    assert bench.sent == []


def test_a_vehicle_that_still_drives_has_not_stopped(bench):
    bench.tell(LONG, 7)
    bench.accept(bench.orders[-1])
    bench.halt()
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FINISHED"}
    bench.show(nodeStates=[], edgeStates=[], driving=True, actionStates=[cancel])
    assert bench.halts == 0
    bench.show(driving=False)
    assert bench.halts == 1


def test_an_order_on_its_way_is_cancelled_before_the_next(bench):
    bench.tell(TARGET, 7)
    bench.tell(LONG, 8)
    assert bench.actions == ["cancelOrder"] and len(bench.orders) == 1
    assert bench.settled == [Settled(7, "another task came in its place")]


@pytest.mark.parametrize("accepted", [True, False])
def test_what_was_aborted_is_not_driven_again_nor_remembered(bench, accepted):
    bench.tell(TARGET, 7)
    order = bench.orders[0]
    if accepted:
        bench.accept(order)
    bench.halt()
    assert bench.kept.task is None and bench.kept.revoked == [order.order_id]
    bench.clear()
    cancel = {"actionId": "action-2", "actionStatus": "FINISHED"}
    bench.show(orderId="", nodeStates=[], edgeStates=[], driving=False, actionStates=[cancel])
    bench.live(5)
    assert bench.orders == [] and bench.settled == []


def test_a_vehicle_that_says_to_stand_stands(bench):
    bench.show(velocity={"vx": 0.3}, driving=True)
    assert bench.saying(SendPos)[-1].v == 0.3
    bench.show(driving=False)
    assert bench.saying(SendPos)[-1].v == 0.0


def test_the_speed_of_a_vehicle_that_says_none_is_measured(bench):
    del bench.state["velocity"]
    bench.show(driving=True)
    bench.now += 0.5
    bench.state["agvPosition"]["x"] += 1.0
    bench.show()
    assert bench.saying(SendPos)[-1].v == pytest.approx(2.0)
    # One that drives and was silent for long does not stand.
    bench.now += 20.0
    bench.state["agvPosition"]["x"] += 10.0
    bench.show()
    assert bench.saying(SendPos)[-1].v == pytest.approx(0.5)
    # Where it was while it did not know that is no place that it has come from.
    bench.state["agvPosition"].update(x=1000.0, positionInitialized=False)
    bench.show()
    bench.now += 0.5
    bench.state["agvPosition"].update(x=12.0, positionInitialized=True)
    bench.show()
    assert bench.saying(SendPos)[-1].v == 0.0


def test_a_pause_that_holds_is_not_asked_for_again_unless_it_may_be_lifted(bench):
    bench.halt(emergency=True)
    cancel = {"actionId": bench.action_id("cancelOrder"), "actionStatus": "FAILED"}
    bench.show(paused=True, actionStates=[cancel])
    bench.clear()
    bench.halt(emergency=True)
    assert bench.actions == ["cancelOrder"]
    bench.live(3)

    bench.tell(TARGET, 9)
    bench.clear()
    bench.halt(emergency=True)
    assert bench.actions == ["cancelOrder", "startPause"], "stopPause may be on its way"


def test_a_base_that_ends_where_the_message_had_to_end_is_no_end_of_the_order(bench):
    bench.hear("factsheet", {"protocolLimits": {"maxArrayLens": {"order.nodes": 2}}})
    bench.tell(LONG, 7)
    for passed in range(1, 8):
        order = bench.orders[-1]
        nodes = [node.sequence_id for node in order.nodes]
        assert len(nodes) == 2 and nodes[-1] == 2 * passed
        bench.state["agvPosition"].update(x=order.nodes[-1].node_position.x)
        bench.accept(order, passed=passed)
        bench.wait(0.25)
    assert bench.settled == [Settled(7)]


def test_the_last_node_of_the_order_before_releases_nothing(bench):
    bench.tell(LONG, 7)
    order = bench.orders[-1]
    nodes = [{"nodeId": n.node_id, "sequenceId": n.sequence_id, "released": n.released} for n in order.nodes]
    bench.show(orderId=order.order_id, nodeStates=nodes, lastNodeSequenceId=12, driving=True)
    bench.wait(1)
    assert {order.order_update_id for order in bench.orders} == {0}


def test_a_vehicle_that_says_it_cannot_come_to_a_node_fails_the_command_and_is_stopped():
    bench = Bench(version="3.0.0")
    bench.connect()
    bench.tell(TARGET, 7)
    order = bench.orders[-1]
    bench.accept(order)
    elsewhere = fault("no way", "CRITICAL", nodeId="of-another-order") | {"errorType": "NODE_UNREACHABLE"}
    bench.show(errors=[elsewhere])
    assert [one.reason for one in bench.settled] == [None]
    here = fault("no way", "CRITICAL", nodeId=order.nodes[-1].node_id) | {"errorType": "NODE_UNREACHABLE"}
    bench.show(errors=[fault("a scratch"), here])
    assert bench.settled[-1].reason == "NODE_UNREACHABLE: no way"
    assert bench.actions[-1] == "cancelOrder"
    assert "CRITICAL NODE_UNREACHABLE: no way; WARNING" in bench.saying(SendPos)[-1].status


def test_a_vehicle_that_hibernates_is_offline_and_is_sent_nothing():
    bench = Bench(version="3.0.0")
    bench.connect()
    bench.hear("connection", {"connectionState": "HIBERNATING"})
    assert bench.saying(Stopped)
    bench.tell(TARGET, 7)
    bench.wait(10)
    assert bench.orders == [] and "HIBERNATING" in bench.settled[-1].reason


def test_instant_actions_that_have_ended_are_cleared_unless_one_is_waited_for():
    bench = Bench(version="3.0.0")
    bench.connect()
    ended = [{"actionId": f"old-{n}", "actionStatus": "FINISHED"} for n in range(21)]
    bench.tell(SetPosIni(110.0, 50.0, 0.5), 6)
    bench.show(actionStates=ended)
    assert "clearInstantActions" not in bench.actions
    init = {"actionId": bench.action_id("initPosition"), "actionStatus": "FINISHED"}
    bench.show(actionStates=[*ended, init])
    bench.show()
    assert bench.actions.count("clearInstantActions") == 1


def test_of_many_errors_the_worst_are_told():
    bench = Bench()
    bench.connect()
    worse = [fault(f"broken {n}", "FATAL") for n in range(MOST_FAULTS + 1)]
    bench.show(errors=[fault("a scratch"), *worse])
    status = bench.saying(SendPos)[-1].status
    assert status.count("FATAL") == MOST_FAULTS and "scratch" not in status
    assert bench.controller.alarm(bench.now).count("FATAL") == MOST_FAULTS


def test_a_vehicle_that_says_online_again_and_again_is_two():
    bench = Bench()
    bench.connect()
    for _ in range(MOST_GREETINGS):
        bench.hear("connection", {"connectionState": "ONLINE"})
    assert "two vehicles speak" in bench.controller.alarm(bench.now)


def test_only_the_newest_tasks_are_remembered_as_done_or_given_up():
    ledger = Ledger(Remembered(), 0.0)
    for number in range(MOST_REMEMBERED + 1):
        ledger.begin(VehicleTask(number, TARGET, 0.0))
        ledger.end_task()
        given_up = VehicleTask(1000 + number, TARGET, 0.0)
        given_up.begin(begin_plan(f"order-{number}", "hall", (0, 0), [(1, 1)], None, RouteLimits()))
        ledger.begin(given_up)
        ledger.refuse_task("a test asked for it")
    kept = [one.remembered for one in ledger.drain() if isinstance(one, Keep)][-1]
    assert len(kept.ended) == len(kept.revoked) == MOST_REMEMBERED
    assert ledger.has_ended(MOST_REMEMBERED) and not ledger.has_ended(0)
    assert ledger.is_revoked("order-1") and not ledger.is_revoked("order-0")


def test_a_position_that_is_said_again_is_as_old_as_it_is_unless_the_vehicle_stands(bench):
    bench.show(driving=False)
    first = bench.saying(SendPos)[-1]
    assert first.fix_t is not None
    bench.controller.set_admitted(True, bench.now)
    bench.collect()
    assert (bench.saying(SendPos)[-1].x, bench.saying(SendPos)[-1].fix_t) == (first.x, None)
    bench.show(driving=True)
    driving = bench.saying(SendPos)[-1]
    bench.controller.set_admitted(True, bench.now)
    bench.collect()
    assert bench.saying(SendPos)[-1].fix_t == driving.fix_t is not None
