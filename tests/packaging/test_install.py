"""`make install` finds the profile on every platform and replaces nothing but the plugin."""

from __future__ import annotations

from pathlib import Path

import pytest

from tools.install_plugin import InstallError, install, profiles_folder
from tools.plugin_files import ROOT

PLACES = [
    ({"HOME": "/home/anna"}, "linux", "/home/anna/.local/share/QGIS/QGIS3/profiles"),
    ({"HOME": "/home/anna", "XDG_DATA_HOME": "/data"}, "linux", "/data/QGIS/QGIS3/profiles"),
    ({"HOME": "/Users/anna"}, "darwin", "/Users/anna/Library/Application Support/QGIS/QGIS3/profiles"),
    ({"APPDATA": "/c/anna/Roaming", "HOME": "/c/anna"}, "win32", "/c/anna/Roaming/QGIS/QGIS3/profiles"),
    ({"HOME": "/home/anna", "QGIS_CUSTOM_CONFIG_PATH": "/conf"}, "linux", "/conf/profiles"),
]


@pytest.mark.parametrize(("environment", "platform", "expected"), PLACES)
def test_the_profiles_are_where_qgis_keeps_them(environment, platform, expected):
    assert profiles_folder(environment, platform) == Path(expected)


def test_a_copy_is_complete_and_replaces_a_former_one(tmp_path):
    target = install(tmp_path, link=False)
    (target / "left_over.py").touch()
    assert install(tmp_path, link=False) == target
    assert not (target / "left_over.py").exists()
    assert (target / "metadata.txt").read_bytes() == (ROOT / "metadata.txt").read_bytes()
    assert (target / "plugin" / "vendor" / "websockets" / "asyncio" / "client.py").is_file()
    assert [path.name for path in target.parent.iterdir()] == ["fleet_supervisor"]


def test_a_link_shows_this_folder_and_gives_way_to_a_copy(tmp_path):
    target = install(tmp_path, link=True)
    assert target.is_symlink()
    assert target.resolve() == ROOT
    install(tmp_path, link=False)
    assert not target.is_symlink()
    assert (ROOT / "metadata.txt").is_file()


def test_something_else_of_that_name_stays(tmp_path):
    other = tmp_path / "python" / "plugins" / "fleet_supervisor"
    other.mkdir(parents=True)
    (other / "metadata.txt").write_text("[general]\nname=Another\n")
    with pytest.raises(InstallError, match="is not this plugin; move it away"):
        install(tmp_path, link=False)
    assert (other / "metadata.txt").is_file()
