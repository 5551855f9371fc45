"""What all tests share: the plugin's package name and where the real data lies."""

from __future__ import annotations

import importlib.util
import sys
from collections import deque
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data"


def register_plugin_package():
    """Make the repository's root importable under the name that QGIS gives it."""
    if "fleet_supervisor" in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        "fleet_supervisor", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["fleet_supervisor"] = module
    spec.loader.exec_module(module)


register_plugin_package()

# How long something takes on a busy machine says nothing of whether it is right.
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")


def pytest_collection_modifyitems(items):
    """Deal out the files with many tests and those with few by turns.

    Those with many reckon, those with few wait for real windows, databases and robots: workers that run one
    kind all at once would first fight for the processors and then leave them idle.
    """
    files = {}
    for item in items:
        files.setdefault(item.path, []).append(item)
    waiting = deque(sorted(files.values(), key=len, reverse=True))
    items.clear()
    while waiting:
        items += waiting.popleft() if len(waiting) % 2 else waiting.pop()


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository's root, which is the plugin's folder."""
    return ROOT


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of real data beside the project (see its README)."""
    if not DATA.is_dir():
        pytest.skip(f"the real data is not on this machine: {DATA} does not exist")
    return DATA
