"""A walk through what the plugin adds to QGIS itself, by mouse and keyboard, in QGIS's dark theme."""

from __future__ import annotations

import pytest

STEPS = [
    "site",
    "options",
    "connection",
    "locator",
    "coordinates",
    "stopped",
    "identify",
    "table",
    "expression",
    "labels",
]


@pytest.mark.again(
    "tests/plugin: map/test_site_drop, test_options, test_locator, panel/test_emergency_stop, "
    "layers/test_live_layers, expressions; a desktop by mouse and keyboard: test_walkthrough"
)
def test_each_step_happens_on_the_screen_and_at_the_gateway_and_nothing_is_cut_off(take_pictures):
    take_pictures("qgis", STEPS, 30_000)
