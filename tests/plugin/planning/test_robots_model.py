"""The robots that may take part, as rows: what is told anew while they come and go, and what is written."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.planning.forms import RobotsModel
from fleet_supervisor.plugin.planning.plan_settings import PlanRobotSettings, PlanSettings
from qgis.PyQt.QtCore import Qt

USED, CARRIES, SPEED = 0, 1, 3
USUAL = PlanSettings()


class Told:
    """What a view is told by the model."""

    def __init__(self, model: RobotsModel):
        self.cells: list[tuple[int, int, int, int]] = []
        self.inserted: list[tuple[int, int]] = []
        self.resets = 0
        model.dataChanged.connect(self._changed)
        model.rowsInserted.connect(lambda _parent, first, last: self.inserted.append((first, last)))
        model.modelReset.connect(self._reset)

    def _changed(self, first, last, _roles=()):
        self.cells.append((first.row(), first.column(), last.row(), last.column()))

    def _reset(self):
        self.resets += 1


@pytest.fixture
def model(qgis_app):
    model = RobotsModel()
    model.show_robots(["r2", "r4", "r6"], [True, True, True], USUAL)
    return model


@pytest.fixture
def told(model):
    return Told(model)


@pytest.fixture
def edits(model):
    """The robots that were edited, with their settings, and the texts of refusals."""
    found: tuple[list, list] = ([], [])
    model.edited.connect(lambda name, one: found[0].append((name, one)))
    model.refused.connect(found[1].append)
    return found


def names(model):
    return [model.index(row, USED).data() for row in range(model.rowCount())]


def write(model, row, column, value):
    return model.setData(model.index(row, column), value, Qt.ItemDataRole.EditRole)


def tick(model, row, state):
    return model.setData(model.index(row, USED), state, Qt.ItemDataRole.CheckStateRole)


def test_robots_that_are_as_they_were_are_not_told_again(model, told):
    model.show_robots(["r2", "r4", "r6"], [True, True, True], USUAL)
    assert told.cells == [] and told.inserted == [] and told.resets == 0


def test_of_a_robot_that_goes_away_its_name_alone_is_told(model, told):
    model.show_robots(["r2", "r4", "r6"], [True, False, True], USUAL)
    assert told.cells == [(1, USED, 1, USED)]
    away = model.index(1, USED)
    assert away.data(Qt.ItemDataRole.ToolTipRole) == "r4 is away: it takes no part"
    assert away.data(Qt.ItemDataRole.ForegroundRole) is not None
    here = model.index(0, USED)
    assert here.data(Qt.ItemDataRole.ToolTipRole) is None
    assert here.data(Qt.ItemDataRole.ForegroundRole) is None


def test_newcomers_are_put_between_the_others_whose_rows_stay(model, told):
    everybody = ["r1", "r2", "r3", "r4", "r6", "r7", "r8"]
    model.show_robots(everybody, [True, True, False, True, True, True, True], USUAL)
    assert names(model) == everybody
    assert told.inserted == [(0, 0), (2, 2), (5, 6)] and told.resets == 0
    assert told.cells == []
    assert model.index(2, USED).data(Qt.ItemDataRole.ToolTipRole) == "r3 is away: it takes no part"


def test_other_robots_take_the_place_of_those_that_there_were(model, told):
    model.show_robots(["r2", "s1"], [True, True], USUAL)
    assert names(model) == ["r2", "s1"] and told.resets == 1


def test_other_settings_are_shown(model, told):
    settings = USUAL.with_robot("r4", PlanRobotSettings(used=False, capacity=3))
    model.show_robots(["r2", "r4", "r6"], [True, True, True], settings)
    assert told.cells == [(0, 0, 2, 4)]
    assert model.index(1, CARRIES).data() == "3"
    assert model.index(1, USED).data(Qt.ItemDataRole.CheckStateRole) == 0
    assert model.index(0, USED).data(Qt.ItemDataRole.CheckStateRole) == 2


def test_a_number_that_is_written_is_the_robots_from_then_on(model, edits):
    assert write(model, 1, SPEED, " 1,5 ")
    assert edits == ([("r4", PlanRobotSettings(speed=1.5))], [])
    assert model.index(1, SPEED).data() == "1.5" == model.index(1, SPEED).data(Qt.ItemDataRole.EditRole)


@pytest.mark.parametrize("unticked", [0, Qt.CheckState.Unchecked])
def test_a_robot_is_unticked_by_whoever_gives_a_number_or_a_state(model, edits, unticked):
    assert tick(model, 2, unticked)
    assert edits[0] == [("r6", PlanRobotSettings(used=False))]
    assert tick(model, 2, Qt.CheckState.Checked)
    assert edits[0][1:] == [("r6", PlanRobotSettings())]


@pytest.mark.parametrize("text", ["many", "", "0", "1.5", "10000000"])
def test_what_is_no_number_for_the_column_is_refused_and_named(model, edits, text):
    assert not write(model, 0, CARRIES, text)
    assert edits == ([], [f"Carries of r2 is {text!r}: give 1 or more."])
    assert model.index(0, CARRIES).data() == "8"


def test_names_are_not_written_and_numbers_are_not_ticked(model, edits):
    assert not write(model, 0, USED, "somebody")
    index = model.index(0, CARRIES)
    assert not model.setData(index, 0, Qt.ItemDataRole.CheckStateRole)
    assert not model.flags(model.index(0, USED)) & Qt.ItemFlag.ItemIsEditable
    assert not model.flags(index) & Qt.ItemFlag.ItemIsUserCheckable
    assert edits == ([], [])
