"""A drawing that is mirrored to all sides looks as if it had been drawn turned to each."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import STATES
from fleet_supervisor.plugin.map.overlay.robots_painter import drawn, in_a_column, turned
from fleet_supervisor.plugin.ui.glyphs import SELECTED, draw_arrow, draw_robot
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtGui import QImage

TURNS = 16


def apart(first: np.ndarray, second: np.ndarray) -> float:
    """Return how much two pictures differ on average, of 255; smooth edges are rounded either way."""
    pair = [np.ascontiguousarray(cell).view(np.uint8).astype(int) for cell in (first, second)]
    return float(np.abs(pair[0] - pair[1]).mean())


def check(draw, side: int) -> None:
    cells = turned(draw, side, 1.0, TURNS)
    as_drawn = [drawn(draw, side, 1.0, k * 360.0 / TURNS) for k in range(TURNS)]
    for k, cell in enumerate(cells):
        others = [apart(cell, other) for j, other in enumerate(as_drawn) if j != k]
        assert apart(cell, as_drawn[k]) < min(others) / 8


@pytest.mark.parametrize("side", [32, 33])
@pytest.mark.parametrize("state", STATES)
def test_a_robot_points_where_it_would_if_it_were_drawn_so(qgis_app, state, side):
    check(lambda painter: draw_robot(painter, state, True), side)


def test_an_arrow_points_where_it_would_if_it_were_drawn_so(qgis_app):
    check(lambda painter: draw_arrow(painter, RobotState.FRESH, SELECTED), 30)


def test_cells_stand_in_a_column_from_the_top_down(qgis_app):
    cells = np.zeros((3, 4, 4), dtype=np.uint32)
    cells[1, 2, 3] = 0xFF336699
    image = (
        in_a_column([cells[0], cells[1], cells[2, :, :2]])
        .toImage()
        .convertToFormat(QImage.Format.Format_ARGB32)
    )
    assert (image.width(), image.height()) == (4, 12)
    found = [(x, y) for x in range(4) for y in range(12) if image.pixel(x, y)]
    assert found == [(3, 6)]
    assert image.pixel(3, 6) == 0xFF336699
