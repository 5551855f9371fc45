"""Pictures of docs/field-page.md: ``python -m tools.field_pictures``; a gateway with robots, few and many."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from tests.support.bridge.bridge_programs import Bridge
from tests.support.bridge.link_crowd import Crowd
from tests.support.phone import PHONE, chromium
from tests.support.processes import Processes
from tools.plugin_files import ROOT

IMAGES = ROOT / "docs" / "images"
POSES = {"r1": (20.0, 8.0, 0.0), "r2": (100.0, 60.0, 1.5), "r3": (150.0, 120.0, 3.0)}

MANY = 1100


def main() -> None:
    """Write the pictures beside those of the other guides."""
    with tempfile.TemporaryDirectory() as folder, Processes(Path(folder) / "logs") as processes:
        bridge = Bridge(processes, ROOT / "resources" / "sample_site", f"sqlite:///{folder}/fleet.db")
        bridge.start_gateway()
        for name, pose in POSES.items():
            bridge.start_robot(name, pose)
        desk = bridge.desk()
        desk.ask("subscribe", {"rate": 5})
        desk.wait_for_robots(*POSES)
        with chromium() as browser:
            for scheme in ("light", "dark"):
                page = browser.new_context(**PHONE, color_scheme=scheme).new_page()
                page.goto(f"http://127.0.0.1:{bridge.port}/field")
                page.locator("#connection.up").wait_for()
                page.wait_for_timeout(1500)
                _walk(page, "" if scheme == "light" else "-dark")
                desk.ask("clear_emergency_stop", {"reason": "the picture is drawn"})
            _count_many(bridge, browser)
        bridge.end()


def _count_many(bridge: Bridge, browser: Any) -> None:
    crowd = Crowd(bridge.address, MANY)
    try:
        page = browser.new_context(**PHONE).new_page()
        page.goto(f"http://127.0.0.1:{bridge.port}/field")
        page.locator("#count", has_text="Zoom in").wait_for()
        page.wait_for_timeout(3000)
        page.screenshot(path=IMAGES / "field-many.png")
    finally:
        crowd.end()


def _walk(page: Any, kind: str) -> None:
    page.screenshot(path=IMAGES / f"field-map{kind}.png")
    page.locator("#menu-button").tap()
    page.locator("#robots button", has_text="r1:").tap()
    page.locator("#target").tap()
    above, below = page.locator("#map").bounding_box(), page.locator("#target-panel").bounding_box()
    page.touchscreen.tap(above["x"] + above["width"] / 2 + 60, (above["y"] + below["y"]) / 2)
    page.wait_for_timeout(300)
    page.screenshot(path=IMAGES / f"field-target{kind}.png")
    page.locator("#cancel").tap()
    page.locator("#robot-close").tap()
    page.locator("#stop").tap()
    page.locator("#stop-state", has_text="3 of 3").wait_for()
    page.screenshot(path=IMAGES / f"field-stopped{kind}.png")


if __name__ == "__main__":
    main()
