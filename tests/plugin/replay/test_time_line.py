"""The line of the time that is replayed, with a mark for what was sent and what became of it."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.replay.history import sort_commands
from fleet_supervisor.plugin.replay.time_controls import COLOURS, TimeLine
from fleet_supervisor.plugin.ui.scheduling import run_to_end
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep

WIDTH, HEIGHT = 400, 40


def command(number, *steps):
    told = [CommandStep(CommandState(state), at, "anna") for state, at in steps]
    return CommandReport(f"c{number}", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0}, "anna", told[-1].state, told)


@pytest.fixture
def line(qgis_app):
    """An hour."""
    made = TimeLine()
    made.resize(WIDTH, HEIGHT)
    made.show_time(0.0, 3600.0)
    return made


def show(line, *commands):
    line.show_marks(run_to_end(sort_commands(commands)).marks(line.since, line.until))


def colour_at(line, x, down):
    return line.grab().toImage().pixelColor(round(x), HEIGHT // 2 + down).name()


def test_sending_is_marked_upwards_and_its_end_downwards(line):
    show(line, command(1, ("queued", 1000.0), ("reached", 2000.0)))
    sent, ended = line.pixel(1000.0), line.pixel(2000.0)
    assert colour_at(line, sent, -8) == COLOURS[CommandState.QUEUED].name()
    assert colour_at(line, ended, 8) == COLOURS[CommandState.REACHED].name()
    assert colour_at(line, sent, 8) == colour_at(line, ended, -8) == colour_at(line, ended + 20, 8)


def test_what_failed_lies_on_what_went_well_at_the_same_time(line):
    failed = command(1, ("queued", 10.0), ("failed", 1800.0))
    show(line, failed, *(command(2 + k, ("queued", 10.0), ("reached", 1800.0 + k)) for k in range(3)))
    assert colour_at(line, line.pixel(1800.0), 8) == COLOURS[CommandState.FAILED].name()


def test_thousands_of_commands_are_no_more_strokes_than_the_line_has_pixels(line):
    show(line, *(command(k, ("queued", float(k)), ("reached", k + 1.0)) for k in range(3000)))
    assert len(line.marks) == 6000
    for state in (CommandState.QUEUED, CommandState.REACHED):
        assert 200 < len(line.columns(state)) <= WIDTH


def test_the_mark_under_the_mouse_tells_its_command(line):
    show(line, command(1, ("queued", 1000.0), ("reached", 2000.0)))
    assert line.mark_at(line.pixel(2000.0) + 3).text == "r1: target at 1.00, 2.00 · reached by anna"
    assert line.mark_at(line.pixel(1500.0)) is None
