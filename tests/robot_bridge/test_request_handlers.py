"""What requests declare, and who answers them: nothing is left out, and nothing answered twice."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from robot_bridge.core.messages.base import DESK_REQUESTS, DeskRequest, Done, Priority, Role
from robot_bridge.core.messages.queues import GetQueue, PauseRobot
from robot_bridge.core.messages.roads import GetClosures
from robot_bridge.gateway.model.events import Encoded, RequestHandlers, handles


class Service:
    @handles(PauseRobot)
    async def pause(self, request, operator):
        assert (request.robot, operator) == ("r1", "Ada")
        return Done()

    @handles(GetQueue)
    async def queue(self, request):
        return Encoded({"queues": [request.robot]})

    @handles(GetClosures)
    async def closures(self):
        raise ZeroDivisionError


async def test_a_handler_has_the_request_and_the_operator_where_it_asks_for_them():
    handlers = RequestHandlers(object(), Service())
    assert await handlers.answer(PauseRobot("r1"), "Ada") == {}
    assert await handlers.answer(GetQueue("r2"), "Ada") == {"queues": ["r2"]}
    with pytest.raises(ZeroDivisionError):
        await handlers.answer(GetClosures(), "Ada")


def test_a_request_that_nobody_answers_or_two_do_is_named_at_the_start():
    handlers = RequestHandlers(Service())
    others = set(DESK_REQUESTS.values()) - {PauseRobot, GetQueue, GetClosures}
    handlers.check_complete(except_for=others)
    with pytest.raises(TypeError, match="nobody answers abort, abort_all, add_operator"):
        handlers.check_complete()
    with pytest.raises(TypeError, match=r"pause_robot is answered by .* and by"):
        RequestHandlers(Service(), Service())


def test_a_request_says_its_method_role_and_result():
    known = dict(DESK_REQUESTS)
    with pytest.raises(TypeError, match="Fly does not say its least_role"):

        @dataclass(frozen=True)
        class Fly(DeskRequest[Done]):
            method = "fly"

    with pytest.raises(TypeError, match="Fly2: method 'send' is Send's"):

        @dataclass(frozen=True)
        class Fly2(DeskRequest[Done]):
            method = "send"
            least_role = Role.VIEWER

    assert known == DESK_REQUESTS


def test_what_stops_robots_overtakes_and_what_moves_them_is_overtaken():
    """Written down here once more: who changes what a request declares has to mean it."""
    by = {
        priority: {m for m, one in DESK_REQUESTS.items() if one.priority is priority} for priority in Priority
    }
    assert by[Priority.STOP] == {"emergency_stop", "abort", "abort_all", "pause_robot"}
    assert by[Priority.MOVE_SEVERAL] == {"resolve_conflict", "take_over"}
    assert by[Priority.MOVE] == {
        *("send", "set_positions", "set_queue", "add_tasks", "make_current", "resume_queue"),
        *("submit_plan", "resume_plan", "confirm_replan", "discard_replan", "clear_emergency_stop"),
    }
    never_refused = {method for method, one in DESK_REQUESTS.items() if one.stops}
    assert never_refused == {*by[Priority.STOP], "pause_queue", "pause_plan"}
