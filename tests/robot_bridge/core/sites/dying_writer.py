"""Publishes version 2 of a town until it is at a place, and stays there to be killed: ``FOLDER PLACE``."""

from __future__ import annotations

import signal
import sys
from dataclasses import replace
from pathlib import Path

from robot_bridge.core.sites import column_file, column_writers, site_cache
from robot_bridge.core.sites.site import write_site
from tests.robot_bridge.core.sites.test_site_cache import SETTINGS, town

PLACES = {
    "reading": (site_cache.OutlineColumns, "add"),
    "sorting": (column_writers._Runs, "merged"),
    "writing": (site_cache, "geopackage_digest"),
}


def stay(*_: object, **__: object) -> None:
    """Say that it is there."""
    print("here", flush=True)
    while True:
        signal.pause()


def main() -> None:
    """Write until then."""
    folder, place = sys.argv[1:]
    column_file.AT_ONCE = 1000
    setattr(*PLACES[place], stay)
    write_site(Path(folder), replace(SETTINGS, version=2), town(300, height=9.0))
