"""Connections and preferences in the settings of QGIS."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_supervisor.plugin.settings.profile import (
    Connections,
    GatewayConnection,
    Preferences,
    export_path,
    write_preferences,
)
from qgis.core import QgsSettings


@pytest.fixture
def connections(qgis_app):
    QgsSettings().remove("fleet_supervisor")
    yield Connections()
    QgsSettings().remove("fleet_supervisor")


def connection(name, **more):
    return GatewayConnection(name, "ws://127.0.0.1:8765/desk", **more)


def test_what_is_kept_is_there_for_everybody(connections):
    kept = connection("Yard", operator="anna", ca_file="/ca.pem", auth="abc1234")
    connections.store(kept)
    assert Connections().get("Yard") == kept
    assert Connections().all() == [kept]


@pytest.mark.parametrize("name", ["a/b", "50 %", "Győr", "last", "ünnep\\x"])
def test_any_name_will_do(connections, name):
    connections.store(connection(name))
    assert connections.names() == [name]
    assert connections.get(name).name == name
    connections.remove(name)
    assert connections.names() == []


def test_a_new_name_takes_the_place_of_the_old_one_and_stays_the_last(connections):
    connections.store(connection("Yard"))
    connections.set_last("Yard")
    connections.store(connection("North yard"), "Yard")
    assert connections.names() == ["North yard"]
    assert connections.last == "North yard"


def test_one_that_is_removed_is_not_the_last_any_more(connections):
    connections.store(connection("Yard"))
    connections.set_last("Yard")
    connections.remove("Yard")
    assert connections.last == ""
    assert connections.get("Yard") is None


def test_they_come_by_name_whatever_the_letters(connections):
    for name in ("b", "C", "a"):
        connections.store(connection(name))
    assert connections.names() == ["a", "b", "C"]


def test_files_go_where_the_options_say(connections, tmp_path):
    assert export_path("a.csv").endswith("/a.csv")
    write_preferences(Preferences(folder=str(tmp_path)))
    assert export_path("a.csv") == str(tmp_path / "a.csv")


def test_a_folder_that_is_gone_is_not_proposed(connections, tmp_path):
    write_preferences(Preferences(folder=str(tmp_path / "gone")))
    folder = Path(export_path("a.csv")).parent
    assert folder.is_dir() and folder != tmp_path / "gone"
