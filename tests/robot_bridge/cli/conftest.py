"""Databases of all three kinds with the bridge's tables in them."""

import shutil

import pytest

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import read_address, run_once

KINDS = ("sqlite", "postgresql", "mariadb")


def empty_url(request, kind, folder) -> str:
    return f"sqlite:///{folder}/fleet.db" if kind == "sqlite" else request.getfixturevalue(f"{kind}_url")


@pytest.fixture(params=KINDS)
def kind(request) -> str:
    return request.param


@pytest.fixture
def url(request, kind, tmp_path) -> str:
    """A database of each kind with empty tables."""
    found = empty_url(request, kind, tmp_path)
    run_once(read_address(found), revisions.create)
    return found


@pytest.fixture
def site(sample_site, tmp_path):
    """A copy of the sample site that the test may change."""
    folder = tmp_path / "site"
    folder.mkdir()
    for name in ("site.toml", "site.gpkg"):
        shutil.copy(sample_site / name, folder)
    return folder
