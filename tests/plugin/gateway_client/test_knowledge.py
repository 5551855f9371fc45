"""What the desk knows without Qt: waits, orders, ageing, trails, commands, what the gateway says."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.command_cache import CommandCache, command_in_words
from fleet_supervisor.plugin.gateway_client.fleet_state import (
    MOST_COMMANDS,
    OperatorRequest,
    RequestGround,
    UpdateBuffer,
)
from fleet_supervisor.plugin.gateway_client.protocol import GatewayProtocol
from fleet_supervisor.plugin.gateway_client.report_caches import (
    PlacedConeCache,
    PlanCache,
    QueueCache,
    plan_in,
)
from fleet_supervisor.plugin.gateway_client.request_outbox import RequestOutbox
from fleet_supervisor.plugin.gateway_client.robot_states import STATES, RobotStates, table_from_rows
from fleet_supervisor.plugin.ui.errors import GatewayLinkError
from fleet_supervisor.robot_bridge.core.assignment.plan import ConePlan, document_of
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from fleet_supervisor.robot_bridge.core.messages.queues import queue_report
from fleet_supervisor.robot_bridge.core.messages.records import placement_report
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from fleet_supervisor.robot_bridge.core.reconnection import GatewayAddresses


def test_the_same_order_is_kept_once_and_answered_once():
    outbox = RequestOutbox()
    assert outbox.add(OperatorRequest("a", "send"))
    assert not outbox.add(OperatorRequest("a", "send"))
    assert outbox.answered("a").key == "a"
    assert outbox.answered("a") is None


def test_orders_are_repeated_in_the_order_in_which_they_were_asked():
    outbox = RequestOutbox()
    for number in range(5):
        outbox.add(OperatorRequest(f"order {number}", "send", requested_at=float(number)))
    again, too_old = outbox.renew(now=32.5)
    assert [order.key for order in again] == ["order 3", "order 4"]
    assert [order.key for order in too_old] == ["order 0", "order 1", "order 2"]
    assert len(outbox) == 2


def test_what_stops_robots_is_repeated_first_and_what_it_makes_void_never():
    outbox = RequestOutbox()
    target = {"op": "SetPosEnd", "params": {}}
    for key, method, params in (
        ("r1 goes", "send", {"robot": "r1", **target}),
        ("r2 goes", "send", {"robot": "r2", **target}),
        ("r2 loses a task", "remove_task", {"robot": "r2"}),
        ("r1 stops", "send", {"robot": "r1", "op": "Abort"}),
        ("r1 goes later", "send", {"robot": "r1", **target}),
    ):
        outbox.add(OperatorRequest(key, method, params))
    assert [order.key for order in outbox.withdraw_void()] == ["r1 goes"]
    again, _ = outbox.renew(now=1.0)
    assert [order.key for order in again] == ["r1 stops", "r2 goes", "r2 loses a task", "r1 goes later"]
    outbox.add(OperatorRequest("all stop", "emergency_stop"))
    outbox.answered("all stop")
    assert [order.key for order in outbox.withdraw_void()] == ["r2 goes", "r1 goes later"]
    assert [order.key for order in outbox.renew(now=1.0)[0]] == ["r1 stops", "r2 loses a task"]


def test_what_is_asked_for_after_the_end_of_the_link_is_handed_back():
    buffer = UpdateBuffer()
    addresses = GatewayAddresses("ws://127.0.0.1:1/desk")
    protocol = GatewayProtocol("anna", 10.0, addresses, buffer, ManualClock())
    protocol.end()
    assert protocol.submit(OperatorRequest("stop", "emergency_stop", lasting=True)) == []
    (answer,) = buffer.collect().answers
    assert answer.order.key == "stop" and "closed before the gateway answered" in answer.error


def sighting(report, received=100.0):
    return table_from_rows([to_json(report)], received)


@pytest.mark.parametrize(
    ("age", "stopped", "later", "state"),
    [
        (0.0, False, 2.9, RobotState.FRESH),
        (0.0, False, 3.0, RobotState.STALE),
        (2.0, False, 1.5, RobotState.STALE),
        (0.0, False, 9.9, RobotState.STALE),
        (0.0, False, 10.0, RobotState.LOST),
        (0.0, True, 2.0, RobotState.FRESH),
        (0.0, True, 60.0, RobotState.LOST),
    ],
)
def test_robots_age_by_this_computers_clock_when_nothing_comes(make_robot, age, stopped, later, state):
    picture = RobotStates(stale_after=3.0, lost_after=10.0)
    picture.merge(sighting(make_robot(age=age, stopped=stopped)))
    view = picture.view("r1", 100.0 + later)
    assert view.state is state
    assert view.age == pytest.approx(age + later)


@pytest.mark.parametrize("told", [RobotState.STALE, RobotState.LOST, RobotState.OFFLINE])
def test_a_state_that_the_gateway_knows_better_is_kept(make_robot, told):
    picture = RobotStates()
    picture.merge(sighting(make_robot(state=told, age=0.5)))
    assert picture.view("r1", 100.0).state is told


def test_the_sites_own_limits_decide(make_robot):
    picture = RobotStates(stale_after=1.0, lost_after=2.0)
    picture.merge(sighting(make_robot()))
    assert [picture.view("r1", 100.0 + t).state for t in (0.5, 1.5, 2.5)] == list(STATES[:3])


def test_an_older_sighting_does_not_replace_a_newer_one(make_robot):
    picture = RobotStates()
    picture.merge(sighting(make_robot(x=2.0), received=101.0))
    picture.merge(sighting(make_robot(x=1.0), received=100.0))
    assert picture.view("r1", 101.0).report.x == 2.0


def test_a_robot_without_a_pose_is_known_but_not_drawn(make_robot):
    picture = RobotStates()
    picture.merge(sighting(make_robot("r2", x=None, y=None, theta=None, v=None)))
    picture.merge(sighting(make_robot("r1", theta=None)))
    arrays = picture.arrays(100.0)
    assert [view.name for view in picture.views(100.0)] == ["r1", "r2"]
    assert arrays.names == ["r2", "r1"]
    assert np.isnan(arrays.xy[0]).all() and not np.isnan(arrays.xy[1]).any()
    assert math.isnan(arrays.theta[1])


def command(state=CommandState.QUEUED, steps=1, **more):
    values = {"command": "c1234567", "robot": "r1", "op": "SetPosEnd", "operator": "anna"}
    values["params"] = {"x": 12.3, "y": 40.0, "cone": True}
    values.update(more)
    return CommandReport(state=state, steps=[CommandStep(state, 1.0, "anna")] * steps, **values)


def test_a_report_that_was_overtaken_does_not_set_a_command_back():
    book = CommandCache()
    book.merge([command(CommandState.ACKNOWLEDGED, steps=3)])
    assert book.merge([command(CommandState.QUEUED, steps=1)]) == []
    assert book.get("c1234567").state is CommandState.ACKNOWLEDGED


def test_what_robots_do_is_their_newest_unfinished_target_or_path():
    book = CommandCache()
    book.merge(
        [
            command(CommandState.SUPERSEDED, command="c1000000"),
            command(CommandState.DELIVERED, command="c2000000"),
            command(CommandState.QUEUED, command="c3000000", op="Abort", params={}),
            command(CommandState.REACHED, command="c4000000", robot="r2"),
        ]
    )
    assert [report.command for report in book.under_way()] == ["c2000000"]


def test_commands_are_told_in_words():
    assert command_in_words(command()) == "cone at 12.30, 40.00"
    assert command_in_words(command(op="SetPath", params={"points": [[0, 0], [1, 1]]})) == "route of 2 points"
    assert command_in_words(command(op="Abort", params={})) == "abort"


def test_a_window_that_does_not_look_costs_a_bounded_memory(make_robot):
    mailbox = UpdateBuffer()
    for number in range(3 * MOST_COMMANDS):
        mailbox.add(commands=[command(command=f"command-{number}")])
        mailbox.add(robots=sighting(make_robot(x=float(number)), float(number)))
    news = mailbox.collect()
    assert len(news.robots) == 1
    assert list(news.commands)[-1] == f"command-{3 * MOST_COMMANDS - 1}"
    assert len(news.commands) == MOST_COMMANDS
    assert len(mailbox.collect().robots) == 0


def greeted(site):
    mailbox = UpdateBuffer()
    protocol = GatewayProtocol(
        "anna", 10.0, GatewayAddresses("ws://here/desk"), mailbox, clock=ManualClock(uptime=50.0)
    )
    (hello,) = protocol.begin()
    answer = {"jsonrpc": "2.0", "id": json.loads(hello)["id"]}
    sent = protocol.receive(json.dumps({**answer, "result": {"protocol": 1, "site": to_json(site)}}))
    return protocol, mailbox, [json.loads(text) for text in sent]


def test_after_the_greeting_the_desk_subscribes_and_asks_for_commands(site):
    _, mailbox, sent = greeted(site)
    assert [(request["method"], request["params"]) for request in sent] == [
        ("subscribe", {"rate": 10.0, "form": "columns"}),
        ("get_commands", {"limit": 200}),
        ("get_closures", {}),
        ("get_queue", {"paths": False, "ended": 10}),
        ("get_plans", {"documents": False, "ended": 10}),
    ]
    assert mailbox.collect().site == site


def test_what_a_robot_may_drive_off_on_has_a_deadline_by_the_gateways_clock(site):
    mailbox, clock = UpdateBuffer(), ManualClock(uptime=50.0)
    protocol = GatewayProtocol("anna", 10.0, GatewayAddresses("ws://here/desk"), mailbox, clock)
    asked = OperatorRequest("one", "send", requested_at=40.0, ground=RequestGround.of(site, ""))

    def greeting(more):
        (hello,) = protocol.begin()
        result = {"protocol": 1, "site": to_json(site), **more}
        sent = protocol.receive(
            json.dumps({"jsonrpc": "2.0", "id": json.loads(hello)["id"], "result": result})
        )
        return {one["method"]: one.get("deadline") for one in map(json.loads, sent)}

    protocol.submit(asked)
    without = dict.fromkeys(("subscribe", "get_commands", "get_closures", "get_queue", "get_plans"))
    assert greeting({"now": 1000.0}) == {**without, "send": 1020.0}
    (text,) = protocol.submit(OperatorRequest("stop", "emergency_stop", requested_at=49.0, lasting=True))
    assert "deadline" not in json.loads(text)
    protocol.submit(replace(asked, key="after the stop"))
    # Another gateway has another clock, and an older one none.
    clock.advance(5.0)
    assert greeting({"now": 7.0}) == {**without, "send": 22.0, "emergency_stop": None}
    assert greeting({}) == {**without, "send": None, "emergency_stop": None}
    with pytest.raises(GatewayLinkError, match="the gateway's clock is 'noon', not a finite number"):
        greeting({"now": "noon"})


def test_an_emergency_stop_of_another_desk_makes_void_what_waited_for_the_link_meanwhile(site):
    buffer, addresses = UpdateBuffer(), GatewayAddresses("ws://here/desk")
    protocol = GatewayProtocol("anna", 10.0, addresses, buffer, ManualClock(uptime=50.0))

    def greeting(stop):
        (hello,) = protocol.begin()
        emergency = {"in_force": False, "stop": stop}
        result = {"protocol": 1, "site": to_json(site), "emergency": emergency}
        answer = {"jsonrpc": "2.0", "id": json.loads(hello)["id"], "result": result}
        return [json.loads(text)["method"] for text in protocol.receive(json.dumps(answer))]

    greeting("stop-0001")
    for key, method in (("go", "send"), ("clear", "clear_emergency_stop"), ("remove", "remove_task")):
        protocol.submit(OperatorRequest(key, method, {"robot": "r1"}, requested_at=49.0))
    assert greeting("stop-0001")[-3:] == ["send", "clear_emergency_stop", "remove_task"]
    # By now it was made, and cleared by a supervisor.
    again = greeting("stop-0002")
    assert again[-1] == "remove_task" and "send" not in again and "clear_emergency_stop" not in again
    void = [answer.order.key for answer in buffer.collect().answers]
    assert void == ["go", "clear"]


@pytest.mark.parametrize("cleared_at", [None, 1790000000.0])
def test_a_stop_that_was_cleared_before_its_answer_came_is_not_made_again(site, cleared_at):
    buffer = UpdateBuffer()
    protocol = GatewayProtocol("anna", 10.0, GatewayAddresses("ws://here/desk"), buffer, ManualClock())
    stop = {"command": "stop-0001"}
    protocol.submit(OperatorRequest("mine", "emergency_stop", stop, requested_at=0.0, lasting=True))
    (hello,) = protocol.begin()
    report = {"in_force": cleared_at is None, "stop": "stop-0001", "cleared_at": cleared_at}
    result = {"protocol": 1, "site": to_json(site), "emergency": report}
    answer = {"jsonrpc": "2.0", "id": json.loads(hello)["id"], "result": result}
    sent = [json.loads(text)["method"] for text in protocol.receive(json.dumps(answer))]
    answers = [(one.order.key, one.error) for one in buffer.collect().answers]
    if cleared_at is None:
        assert sent[0] == "emergency_stop" and answers == []
    else:
        assert "emergency_stop" not in sent and answers == [("mine", None)]


def test_of_a_target_and_its_abort_that_are_both_too_old_nobody_says_that_the_stop_ends_it(site):
    buffer, clock = UpdateBuffer(), ManualClock(uptime=50.0)
    protocol = GatewayProtocol("anna", 10.0, GatewayAddresses("ws://here/desk"), buffer, clock)
    for key, op in (("go", "SetPosEnd"), ("stop", "Abort")):
        protocol.submit(OperatorRequest(key, "send", {"robot": "r1", "op": op}, requested_at=49.0))
    clock.advance(40.0)
    (hello,) = protocol.begin()
    answer = {
        "jsonrpc": "2.0",
        "id": json.loads(hello)["id"],
        "result": {"protocol": 1, "site": to_json(site)},
    }
    assert not [text for text in protocol.receive(json.dumps(answer)) if '"send"' in text]
    texts = {one.order.key: one.error for one in buffer.collect().answers}
    assert texts.keys() == {"go", "stop"} and "the stop ends it" not in texts["go"]


def test_a_refusal_sets_the_clock_for_deadlines_right(site):
    mailbox, clock = UpdateBuffer(), ManualClock(uptime=50.0)
    protocol = GatewayProtocol("anna", 10.0, GatewayAddresses("ws://here/desk"), mailbox, clock)
    (hello,) = protocol.begin()
    result = {"protocol": 1, "site": to_json(site), "now": 100.0}
    protocol.receive(json.dumps({"jsonrpc": "2.0", "id": json.loads(hello)["id"], "result": result}))

    def deadline(key):
        request = OperatorRequest(key, "send", requested_at=clock.steady(), ground=RequestGround.of(site, ""))
        (text,) = protocol.submit(request)
        return json.loads(text)

    first = deadline("one")
    assert first["deadline"] == 130.0
    refused = {"code": -32000, "message": "send: it came after its deadline", "data": {"now": 600.0}}
    protocol.receive(json.dumps({"jsonrpc": "2.0", "id": first["id"], "error": refused}))
    (answer,) = mailbox.collect().answers
    assert (answer.error, answer.order.key) == ("send: it came after its deadline", "one")
    assert deadline("two")["deadline"] == 630.0


def test_another_version_of_the_site_is_taken_over_when_the_gateway_tells_of_it(site):
    protocol, mailbox, _ = greeted(site)
    mailbox.collect()
    newer = replace(site, version=2, stale_after=1.0)
    assert protocol.receive(json.dumps({"jsonrpc": "2.0", "method": "site", "params": to_json(newer)})) == []
    assert mailbox.collect().site == newer


def test_commands_come_newest_first_and_are_kept_oldest_first(site):
    protocol, mailbox, sent = greeted(site)
    newest_first = [to_json(command(command=f"command-{n}")) for n in (3, 2, 1)]
    answer = {"jsonrpc": "2.0", "id": sent[1]["id"], "result": {"commands": newest_first}}
    protocol.receive(json.dumps(answer))
    assert list(mailbox.collect().commands) == ["command-1", "command-2", "command-3"]


@pytest.mark.parametrize(
    "params",
    [
        {},
        {"robots": 5},
        {"robots": [{}]},
        {"robots": [{"robot": "r1", "state": "dancing", "age": 0, "link": "sql"}]},
        {"robots": [{"robot": "r1", "state": "fresh", "age": "young", "link": "sql"}]},
        {"robots": [{"robot": "r1", "state": "fresh", "age": 0, "link": "sql", "x": True, "y": 1}]},
    ],
)
def test_positions_that_are_none_are_refused_in_words(site, params):
    protocol, mailbox, _ = greeted(site)
    with pytest.raises(GatewayLinkError, match="ws://here/desk"):
        protocol.receive(json.dumps({"jsonrpc": "2.0", "method": "positions", "params": params}))
    assert len(mailbox.collect().robots) == 0


def test_what_a_newer_gateway_says_besides_is_passed_over(site):
    protocol, _, _ = greeted(site)
    assert protocol.receive('{"jsonrpc": "2.0", "method": "weather", "params": {"rain": true}}') == []


def queue(robot="r1", revision=1, **more):
    values = {"robot": robot, "revision": revision, "state": "running", "robot_state": "fresh"}
    return {**values, "tasks": [], "ended": [], **more}


def placement(number, **more):
    places = {"planned_x": 1.0, "planned_y": 2.0, "x": 1.1, "y": 2.0, "theta": 0.0, "deviation": 0.1}
    facts = {"task": f"task-{number}", "robot": "r1", "placed_at": 5.0, "command": "c"}
    return {"placement": number, **facts, **places, **more}


def told(protocol, **message):
    protocol.receive(json.dumps({"jsonrpc": "2.0", **message}))


def answer_to(protocol, method, **params):
    """Ask for something and return the id that its answer names."""
    (text,) = protocol.submit(OperatorRequest(method, method, params))
    return json.loads(text)["id"]


def test_queues_and_placed_cones_are_taken_from_news_answers_and_refusals(site):
    protocol, mailbox, sent = greeted(site)
    (every,) = [one["id"] for one in sent if one["method"] == "get_queue"]
    told(protocol, id=every, result={"queues": [queue("r1"), queue("r2")]})
    news = mailbox.collect()
    assert news.are_all_queues and set(news.queues) == {"r1", "r2"}
    told(protocol, method="queue", params=queue("r1", 2))
    told(protocol, method="placement", params=placement(7))
    told(protocol, id=answer_to(protocol, "set_queue"), result=queue("r2", 5))
    told(protocol, id=answer_to(protocol, "take_over"), result={"queues": [queue("r3", 6)]})
    told(protocol, id=answer_to(protocol, "get_placements"), result={"placements": [placement(8)]})
    news = mailbox.collect()
    assert {name: one.revision for name, one in news.queues.items()} == {"r1": 2, "r2": 5, "r3": 6}
    assert set(news.placed_cones) == {7, 8} and not news.are_all_queues
    refusal = {"code": -32006, "message": "look again", "data": queue("r1", 9)}
    told(protocol, id=answer_to(protocol, "add_tasks"), error=refusal)
    news = mailbox.collect()
    assert news.queues["r1"].revision == 9
    assert news.answers[-1].outdated and news.answers[-1].error == "look again"


def plan(name="p1", revision=1, **more):
    values = {"plan": name, "revision": revision, "state": "driven", "submitted_by": "anna", "done": 0}
    return {**values, "submitted_at": 5.0, "by_itself": False, "cones": 0, "robots": ["r1"], **more}


DOCUMENT = document_of(ConePlan((), (), (), "stay", "balanced", "preview", "straight"))


def test_plans_are_taken_from_news_answers_and_refusals_and_none_that_was_overtaken(site):
    protocol, mailbox, sent = greeted(site)
    (every,) = [one["id"] for one in sent if one["method"] == "get_plans"]
    told(protocol, id=every, result={"plans": [plan("p1"), plan("p2")]})
    news, book = mailbox.collect(), PlanCache()
    assert news.is_driving and book.merge(news.plans, news.is_driving) == ["p1", "p2"]
    told(protocol, id=answer_to(protocol, "get_plans"), result={"plans": [plan("p1", document=DOCUMENT)]})
    told(protocol, method="plan", params=plan("p1", done=1))
    told(protocol, id=answer_to(protocol, "pause_plan"), result=plan("p2", 2, state="paused"))
    told(
        protocol, id=answer_to(protocol, "replan"), error={"code": -32006, "message": "", "data": plan("p3")}
    )
    news = mailbox.collect()
    assert news.is_driving is None and book.merge(news.plans) == ["p1", "p2", "p3"]
    one = book.get("p1")
    assert one.is_whole and one.report.done == 1 and one.document is not None
    told(protocol, method="plan", params=plan("p1", 2))
    told(protocol, id=answer_to(protocol, "get_plans"), result={"plans": [plan("p1", 1, document=DOCUMENT)]})
    assert book.merge(mailbox.collect().plans) == ["p1"]
    one = book.get("p1")
    assert one.report.revision == 2 and not one.is_whole and one.document is not None


def test_what_a_gateway_says_when_a_link_begins_is_all_that_it_drives(site):
    protocol, mailbox, sent = greeted(site)
    book = PlanCache()
    book.merge({"p1": plan_in(plan("p1", 9, document=DOCUMENT)), "p2": plan_in(plan("p2"))})
    (every,) = [one["id"] for one in sent if one["method"] == "get_plans"]
    # It is another one's backup that is served: a plan may be at an earlier revision.
    told(protocol, id=every, result={"plans": [plan("p1", 3)]})
    news = mailbox.collect()
    assert sorted(book.merge(news.plans, news.is_driving)) == ["p1", "p2"]
    assert book.get("p2") is None and book.get("p1").report.revision == 3 and not book.get("p1").is_whole
    told(protocol, method="plan", params=plan("p1", 4))
    assert book.merge(mailbox.collect().plans) == ["p1"]


def test_a_gateway_that_knows_no_plans_says_so_and_the_link_goes_on(site):
    protocol, mailbox, sent = greeted(site)
    (every,) = [one["id"] for one in sent if one["method"] == "get_plans"]
    told(protocol, id=every, error={"code": -32601, "message": "no such method"})
    assert mailbox.collect().is_driving is False


@pytest.mark.parametrize(
    "wrong", [{"document": {"format": "?"}}, {"state": "gone"}, {"stops": [{}]}, {"stops": [{}] * 20_001}]
)
def test_a_plan_that_is_none_is_refused_in_words(site, wrong):
    protocol, mailbox, _ = greeted(site)
    with pytest.raises(GatewayLinkError, match="ws://here/desk"):
        told(protocol, method="plan", params=plan(**wrong))
    assert not mailbox.collect().plans


def test_of_plans_that_ended_the_newest_are_kept():
    book = PlanCache()
    ended = [plan_in(plan(f"p{k}", state="finished", ended_at=float(k))) for k in range(30)]
    book.merge({one.plan: one for one in (*ended, plan_in(plan("driven")))})
    assert [one.plan for one in book] == [f"p{k}" for k in range(20, 30)] + ["driven"]
    assert [one.plan for one in book.open()] == ["driven"]


def test_a_robot_without_a_queue_has_revision_0_and_one_that_is_gone_is_forgotten():
    book = QueueCache()
    two = {"r1": queue_report(queue("r1", 4)), "r2": queue_report(queue("r2", 2))}
    assert sorted(book.merge(two, are_all=True)) == ["r1", "r2"]
    assert (book.revision("r1"), book.revision("r9")) == (4, 0)
    fewer = {"r2": queue_report(queue("r2", 2))}
    assert book.merge(fewer) == []
    assert book.merge(fewer, are_all=True) == ["r1"] and book.get("r1") is None
    assert book.merge(fewer, are_all=True) == []


def test_of_very_many_placed_cones_the_newest_are_kept(monkeypatch):
    monkeypatch.setattr("fleet_supervisor.plugin.gateway_client.report_caches.MOST_PLACEMENTS", 3)
    book = PlacedConeCache()
    told = {number: placement_report(placement(number)) for number in (4, 1, 5, 2)}
    assert book.merge(told) == [4, 1, 5, 2]
    assert sorted(one.placement for one in book) == [2, 4, 5]
