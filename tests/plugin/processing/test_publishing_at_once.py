"""Two publications into one folder: one after the other, whichever processes publish."""

from __future__ import annotations

import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
from fleet_supervisor.plugin.layers.publishing.publication import LOCK_FILE, exclusive_publication
from fleet_supervisor.plugin.ui.errors import PublicationError
from fleet_supervisor.robot_bridge.core.sites.site import read_site

HOLD = """
import sys
from qgis.PyQt.QtCore import QLockFile
lock = QLockFile(sys.argv[1])
lock.setStaleLockTime(0)
print(lock.tryLock(0), flush=True)
sys.stdin.read()
"""


@pytest.fixture
def holder(tmp_path):
    """A process that publishes into the folder, as far as others can see."""
    command = [sys.executable, "-c", HOLD, str(tmp_path / LOCK_FILE)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "True\n"
    yield process
    process.kill()
    process.communicate()


def test_a_publication_that_is_under_way_is_told_with_its_process(holder, tmp_path):
    (tmp_path / "site.toml").write_text("as it was")
    with (
        pytest.raises(PublicationError, match=f"is under way, by process {holder.pid} on .*: wait until"),
        exclusive_publication(tmp_path),
    ):
        pytest.fail("two at once")
    assert holder.poll() is None
    assert {file.name for file in tmp_path.iterdir()} == {"site.toml", LOCK_FILE}


def test_a_process_that_was_killed_holds_nobody_up(holder, tmp_path):
    holder.kill()
    holder.wait()
    assert (tmp_path / LOCK_FILE).exists()
    with exclusive_publication(tmp_path):
        assert (tmp_path / LOCK_FILE).exists()
    assert list(tmp_path.iterdir()) == []


def test_one_process_does_not_publish_twice_at_once_and_may_again_after_an_error(qgis_app, tmp_path):
    def publish_in_vain():
        with exclusive_publication(tmp_path):
            with pytest.raises(PublicationError, match="is under way"), exclusive_publication(tmp_path):
                pytest.fail("two at once")
            raise KeyError

    for _ in range(2):
        with pytest.raises(KeyError):
            publish_in_vain()


def test_a_folder_that_was_made_in_vain_is_taken_away(qgis_app, tmp_path):
    with exclusive_publication(tmp_path / "site"):
        assert (tmp_path / "site").is_dir()
    assert list(tmp_path.iterdir()) == []


def test_what_a_killed_publication_left_in_the_folder_goes_with_the_next(by_words, root, tmp_path):
    left = tmp_path / ".publishing-abc"
    left.mkdir()
    (left / "site.gpkg").write_text("half")
    project = root / "resources" / "sample_site" / "sample_site.qgz"
    done = by_words("run", "fleet:publishsite", f"--PROJECT_PATH={project}", "--", f"FOLDER={tmp_path}")
    assert done.status == 0, done.said
    assert {file.name for file in tmp_path.iterdir()} == {"site.cache", "site.gpkg", "site.toml"}


def test_processes_that_publish_at_once_use_no_version_twice(qgis_process, data, tmp_path):
    helsinki = data / "osm" / "helsinki_centre_utm35n.gpkg"
    words = [f"OBSTACLES={helsinki}|layername={name}" for name in ("barriers", "steps")]
    words += ["PROFILE=openstreetmap", "SITE_ID=city", "SITE_CRS=EPSG:32635", f"FOLDER={tmp_path}"]
    with ThreadPoolExecutor(2) as several:
        runs = [several.submit(qgis_process, "run", "fleet:publishsite", "--", *words) for _ in range(2)]
        ended = [run.result() for run in runs]
    versions = [
        int(re.search(r"^VERSION:\s*(\d+)", done.stdout, re.MULTILINE)[1])
        for done in ended
        if done.status == 0
    ]
    assert sorted(versions) == list(range(1, len(versions) + 1)) and versions
    assert all("is under way, by process" in done.said for done in ended if done.status)
    assert read_site(tmp_path).version == len(versions)
    assert {file.name for file in tmp_path.iterdir()} == {"site.cache", "site.gpkg", "site.toml"}
