"""What the desk keeps of the commands that a gateway tells: small, and the same to all who read it."""

from __future__ import annotations

import json
import tracemalloc

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client import command_cache
from fleet_supervisor.plugin.gateway_client.command_cache import (
    CommandCache,
    PathPoints,
    command_in,
    command_in_words,
    commands_in,
    place_of,
)
from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.protocol import GatewayProtocol
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from fleet_supervisor.robot_bridge.core.reconnection import GatewayAddresses

WAY = [[0.5 * k, 20.0 + 0.25 * k] for k in range(600)]
"""Along 300 m of roads."""


def told(points=WAY, command="c1", op="SetPath"):
    """Return a command as it comes out of a gateway's message."""
    steps = [{"state": state, "at": 1.7e9, "by": None} for state in ("queued", "delivered", "acknowledged")]
    params = {"points": points, "theta": 1.5}
    values = {"command": command, "robot": "r1", "op": op, "params": params, "operator": "anna"}
    return json.loads(json.dumps({**values, "state": "acknowledged", "steps": steps}))


def test_a_path_along_roads_takes_a_fraction_of_its_points_as_json():
    texts = [json.dumps(told(command=f"c{number}")) for number in range(50)]
    tracemalloc.start()
    try:
        kept = [command_in(json.loads(text)) for text in texts]
        each = tracemalloc.get_traced_memory()[0] / len(kept)
    finally:
        tracemalloc.stop()
    assert each < 16_000


def test_whoever_reads_a_path_finds_its_points():
    report = command_in(told())
    points = report.params["points"]
    assert isinstance(points, PathPoints)
    assert list(points) == [tuple(point) for point in WAY]
    assert (len(points), points[0], points[-1][:2]) == (600, (0.0, 20.0), (299.5, 169.75))
    assert points[1:3] == [(0.5, 20.25), (1.0, 20.5)]
    assert np.array_equal(np.array(points, dtype=np.float64), WAY)
    assert command_in_words(report) == "route of 600 points"
    assert place_of(report) == (299.5, 169.75)
    assert report.params["theta"] == 1.5


def test_points_are_nobodys_to_change():
    points = command_in(told()).params["points"]
    np.asarray(points)[0] = 99.0
    assert points[0] == (0.0, 20.0)


def test_a_path_told_again_is_nothing_new_and_another_one_is():
    book = CommandCache()
    assert len(book.merge([command_in(told())])) == 1
    assert book.merge([command_in(told())]) == []
    assert len(book.merge([command_in(told(WAY[:-1]))])) == 1
    assert len(book.merge([command_in(told([*WAY[:-1], [1.0, 1.0]]))])) == 1


@pytest.mark.parametrize("points", [[], "here", None, [[1.0]], [[1.0, 2.0, 3.0]], [[1.0, None]], [[1.0, {}]]])
def test_what_is_no_path_is_shown_as_it_came(points):
    assert command_in(told(points)).params["points"] == points


def test_another_operation_is_shown_as_it_came():
    assert command_in(told(op="SetFuture")).params["points"] == WAY


def test_every_way_on_which_commands_come_packs_them():
    answer = {"commands": [told(command="c2"), told(command="c1")]}
    for reports in (commands_in(answer), commands_in(told())):
        assert all(isinstance(report.params["points"], PathPoints) for report in reports)
    assert [report.command for report in commands_in(answer)] == ["c1", "c2"]
    mailbox = UpdateBuffer()
    protocol = GatewayProtocol("anna", 10.0, GatewayAddresses("ws://here/desk"), mailbox, ManualClock())
    protocol.receive(json.dumps({"jsonrpc": "2.0", "method": "command", "params": told()}))
    assert isinstance(mailbox.collect().commands["c1"].params["points"], PathPoints)


def test_a_cone_that_was_put_down_is_known_beyond_the_newest_commands(monkeypatch):
    monkeypatch.setattr(command_cache, "MOST_COMMANDS", 3)
    monkeypatch.setattr(command_cache, "MOST_CONES", 2)
    cache = CommandCache()

    def reach(command, cone):
        steps = [CommandStep(CommandState.REACHED, float(command), "r1")]
        params = {"x": float(command), "y": 0.0, "cone": cone}
        cache.merge(
            [CommandReport(str(command), "r1", "SetPosEnd", params, "anna", CommandState.REACHED, steps)]
        )

    for number in range(12):
        reach(number, cone=number < 4)
    assert [report.command for report in cache.cones_put_down()] == ["2", "3"]
    assert "3" not in cache
    cache.clear()
    assert not list(cache.cones_put_down())
