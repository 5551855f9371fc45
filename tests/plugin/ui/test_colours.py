"""Letters are legible on what they stand on."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.ui.glyphs import COMMAND_COLOURS, STATE_COLOURS, for_letters
from qgis.PyQt.QtGui import QColor, QPalette
from qgis.PyQt.QtWidgets import QApplication

from tests.plugin.ui.test_icons import contrast, luminance

LEGIBLE = 4.5
"""The least contrast of text (WCAG 2.1, 1.4.3)."""


def luminance_of(colour: QColor) -> float:
    return luminance(np.array(colour.getRgb()[:3], dtype=float))


@pytest.fixture(params=["#FFFFFF", "#2D2D2D"])
def ground(request, qgis_app):
    """What lists stand on, in light themes and in dark ones."""
    before = QApplication.palette()
    palette = QPalette(before)
    palette.setColor(QPalette.ColorRole.Base, QColor(request.param))
    QApplication.setPalette(palette)
    yield QColor(request.param)
    QApplication.setPalette(before)


@pytest.mark.parametrize("state", [*STATE_COLOURS, *COMMAND_COLOURS])
def test_the_word_for_a_state_is_legible(ground, state):
    colour = {**STATE_COLOURS, **COMMAND_COLOURS}[state]
    assert contrast(luminance_of(for_letters(colour)), luminance_of(ground)) >= LEGIBLE
