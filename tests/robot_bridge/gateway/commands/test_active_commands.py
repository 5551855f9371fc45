"""The open commands are found by id, by robot and by message, and forgotten when they have ended."""

from __future__ import annotations

import dataclasses

from robot_bridge.gateway.commands.validation import ActiveCommands
from tests.robot_bridge.gateway.commands.command_makers import ACKNOWLEDGED, DELIVERED, PATH, TARGET, command


def of_robot(made, robot):
    return dataclasses.replace(made, report=dataclasses.replace(made.report, robot=robot))


def test_a_command_is_found_by_its_id_its_robot_and_while_it_is_queued_by_its_message():
    open_commands = ActiveCommands()
    first, second, other = command(1), command(2), of_robot(command(3), "r2")
    for one in (first, second, other):
        open_commands.add(one)
    assert list(open_commands) == [first, second, other]
    assert (open_commands.get("c-1"), open_commands.get("c-9")) == (first, None)
    assert (open_commands.of("r1"), open_commands.of("r2"), open_commands.of("r3")) == (
        [first, second],
        [other],
        [],
    )
    assert open_commands.queued == {1: first, 2: second, 3: other}
    delivered = first.step(DELIVERED, 101.0, "gateway")
    open_commands.add(delivered)
    assert open_commands.queued == {2: second, 3: other}
    assert open_commands.of("r1") == [delivered, second]


def test_a_message_that_was_written_again_is_found_under_its_new_number_alone():
    open_commands = ActiveCommands()
    open_commands.add(command(1))
    again = dataclasses.replace(command(1), sa_id=7)
    open_commands.add(again)
    assert open_commands.queued == {7: again}


def test_what_has_ended_is_found_no_more():
    open_commands = ActiveCommands()
    first, second = command(1), command(2)
    open_commands.add(first)
    open_commands.add(second)
    open_commands.remove("c-1")
    open_commands.remove("c-9")
    assert (list(open_commands), open_commands.of("r1"), open_commands.queued) == (
        [second],
        [second],
        {2: second},
    )
    open_commands.remove("c-2")
    assert (list(open_commands), open_commands.of("r1"), open_commands.queued) == ([], [], {})
    open_commands.add(first)
    assert open_commands.of("r1") == [first]


def test_metres_are_to_be_stored_once_they_have_grown_by_a_step():
    open_commands = ActiveCommands()
    driving = command(1, PATH, DELIVERED, ACKNOWLEDGED).judged(0.2)
    for one in (driving, command(2, TARGET), command(3, PATH)):
        open_commands.add(one)
    assert open_commands.progress(0.5) == {}
    driving.arrival.driven = 0.5
    assert open_commands.progress(0.5) == {"c-1": 0.5}
    open_commands.note_progress({"c-1": 0.5, "c-3": 9.0, "gone": 1.0})
    assert open_commands.progress(0.5) == {}
    driving.arrival.driven = 0.99
    assert open_commands.progress(0.5) == {}
    driving.arrival.driven = 1.0
    assert open_commands.progress(0.5) == {"c-1": 1.0}
    # Sent once more it is not judged, and has driven nothing that is known.
    open_commands.add(driving.noted(110.0, "gateway", "sent once more"))
    assert open_commands.progress(0.0) == {}
    open_commands.add(driving)
    open_commands.remove("c-1")
    assert open_commands.progress(0.0) == {}
    open_commands.note_progress({"c-1": 2.0})
    assert open_commands.progress(0.0) == {}
