"""Every state of the protocol has a word for the operator."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.gateway_client.state_words import (
    COMMAND_STATES,
    ROBOT_STATES,
    TASK_STATES,
    longest_word,
)
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from fleet_supervisor.robot_bridge.core.messages.queues import TaskState
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState


@pytest.mark.parametrize(
    ("words", "states"),
    [(ROBOT_STATES, RobotState), (COMMAND_STATES, CommandState), (TASK_STATES, TaskState)],
)
def test_no_state_is_without_a_word(words, states):
    assert set(words) == set(states)
    assert all(words.values())


def test_the_longest_word_makes_the_column(qgis_app):
    assert longest_word(COMMAND_STATES) == "acknowledged"
