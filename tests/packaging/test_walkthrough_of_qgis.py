"""A walk through what the plugin adds to QGIS itself, by mouse and keyboard, in QGIS's dark theme."""

from __future__ import annotations

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


def test_each_step_happens_on_the_screen_and_at_the_gateway_and_nothing_is_cut_off(take_pictures):
    take_pictures("qgis", STEPS, 30_000)
