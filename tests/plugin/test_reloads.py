"""QGIS Desktop loads and unloads the plugin again and again: no version of it may stay in memory."""

from __future__ import annotations

import shutil

import pytest

from tests.support.processes import Processes
from tests.support.qgis import Profile, virtual_screen
from tests.support.session import follow, start_qgis

TIMES = 4


@pytest.fixture(scope="module")
def entries(tmp_path_factory):
    """What the session inside QGIS wrote down."""
    if shutil.which("Xvfb") is None:
        pytest.skip("there is no Xvfb; run: make setup")
    folder = tmp_path_factory.mktemp("reloads")
    plan = {"journal": str(folder / "journal.jsonl"), "times": TIMES}
    with Processes(folder / "logs") as processes:
        display = virtual_screen(processes, 1280, 800)
        qgis = start_qgis(processes, Profile(folder / "profile", link=False), "reloads.py", plan, display)
        return list(follow(processes, qgis, folder / "journal.jsonl", 900))


def test_each_version_was_another_one(entries):
    loaded = [entry["figures"]["classes"] for entry in entries if entry["step"] == "unloaded"]
    assert len(loaded) == TIMES
    assert min(loaded) > 100
    assert len(set(loaded)) == 1


def test_no_class_of_an_older_version_lives(entries):
    """Nor an object or a function of it, since these hold their classes.

    Of the last version some may: Python keeps overloaded functions until the same ones are loaded again.
    """
    assert entries[-1]["figures"]["living"][:-1] == [[]] * (TIMES - 1)
