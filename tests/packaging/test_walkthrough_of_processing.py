"""A walk through algorithms, styles, expressions and a print layout, by mouse and keyboard."""

from __future__ import annotations

import pytest

STEPS = [
    "cone-layout",
    "export",
    "route",
    "categories",
    "rules",
    "road-surface",
    "atlas",
    "atlas-page",
    "placed",
    "report-dialog",
    "report",
    "trajectories",
]
PAGES = ("atlas-page", "report")
"""Pictures of no screen, but of a PDF."""


@pytest.mark.again(
    "tests/plugin/processing: test_import_cone_layout, test_export_robot_map, test_road_surfaces, "
    "test_as_placed_report, test_trajectories; tests/plugin/layers/test_live_layers; "
    "a desktop by mouse and keyboard: test_walkthrough"
)
def test_each_step_happens_on_the_screen_and_in_the_files_that_are_written(take_pictures):
    take_pictures("processing", STEPS, 8_000, pages=PAGES)
