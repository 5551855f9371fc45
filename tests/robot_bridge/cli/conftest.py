"""Databases of all three kinds with the bridge's tables in them."""

import shutil

import pytest

from tests.support.databases.database_maker import KINDS


@pytest.fixture(params=KINDS)
def kind(request) -> str:
    return request.param


@pytest.fixture
def url(kind, new_database) -> str:
    """A database of each kind with empty tables."""
    return new_database(kind)


@pytest.fixture
def site(sample_site, tmp_path):
    """A copy of the sample site that the test may change."""
    folder = tmp_path / "site"
    folder.mkdir()
    for name in ("site.toml", "site.gpkg"):
        shutil.copy(sample_site / name, folder)
    return folder
