"""Files are there whole or not at all, alone and several together."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from robot_bridge.core import files
from robot_bridge.core.files import StagedFiles, replacement, write_state


def texts(folder):
    return {file.name: file.read_text() for file in folder.iterdir() if file.is_file()}


@pytest.fixture
def synced(monkeypatch):
    """Return the names of what was on its way to the disk, in order."""
    names = []
    sync = os.fsync

    def note(descriptor):
        names.append(Path(f"/proc/self/fd/{descriptor}").readlink().name)
        sync(descriptor)

    monkeypatch.setattr(files.os, "fsync", note)
    return names


def test_a_state_is_on_the_disk_before_it_is_in_its_place_and_the_name_after_it(tmp_path, synced):
    write_state(tmp_path / "state", b"one", mode=0o600)
    assert synced == [".state.new", tmp_path.name]
    assert stat.S_IMODE((tmp_path / "state").stat().st_mode) == 0o600
    write_state(tmp_path / "state", b"two")
    assert texts(tmp_path) == {"state": "two"}


def test_what_replaces_a_file_is_on_the_disk_first_and_in_a_folder_of_nobody_else(tmp_path, synced):
    (tmp_path / "map").write_text("old")
    with replacement(tmp_path / "map") as made:
        made.write_text("new")
        assert stat.S_IMODE(made.parent.stat().st_mode) == 0o700
        assert texts(tmp_path) == {"map": "old"}
    assert synced == ["map", tmp_path.name]
    assert texts(tmp_path) == {"map": "new"} and len(list(tmp_path.iterdir())) == 1


def test_after_an_error_the_file_is_as_it_was_and_nothing_is_left(tmp_path):
    (tmp_path / "map").write_text("old")
    with pytest.raises(KeyError), replacement(tmp_path / "map") as made:
        made.write_text("half")
        raise KeyError
    assert texts(tmp_path) == {"map": "old"} and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("links", [True, False])
def test_files_that_are_taken_back_are_as_they_were(tmp_path, monkeypatch, links):
    def refuse(*_):
        raise OSError(errno.EPERM, "Operation not permitted")

    if not links:
        monkeypatch.setattr(files.os, "link", refuse)
    before = {"a": "old", "gone": "old", "mine": "old"}
    for name, text in before.items():
        (tmp_path / name).write_text(text)
    with pytest.raises(KeyError), StagedFiles(tmp_path) as staged:
        for name in ("a", "b"):
            (staged.folder / name).write_text("new")
        staged.publish(removed=["gone", "never there"])
        assert texts(tmp_path) == {"a": "new", "b": "new", "mine": "old"}
        raise KeyError
    assert texts(tmp_path) == before and len(list(tmp_path.iterdir())) == 3


def test_a_file_that_cannot_be_put_into_its_place_takes_those_before_it_back(tmp_path):
    (tmp_path / "a").write_text("old")
    (tmp_path / "b").mkdir()
    with pytest.raises(OSError), StagedFiles(tmp_path) as staged:
        for name in ("a", "b"):
            (staged.folder / name).write_text("new")
        staged.publish()
    assert texts(tmp_path) == {"a": "old"} and (tmp_path / "b").is_dir()


def test_a_folder_that_was_made_in_vain_is_taken_away(tmp_path):
    with pytest.raises(KeyError), StagedFiles(tmp_path / "maps" / "tiles"):
        raise KeyError
    assert list(tmp_path.iterdir()) == []
    with StagedFiles(tmp_path / "maps" / "tiles") as staged:
        (staged.folder / "a").write_text("new")
        staged.publish()
    assert texts(tmp_path / "maps" / "tiles") == {"a": "new"}


@pytest.mark.parametrize("fails", [False, True])
def test_what_writes_into_the_folder_is_left_before_that_is_removed(tmp_path, fails):
    left = []

    @contextmanager
    def writer(folder):
        yield folder / "half"
        left.append(folder.is_dir())

    with suppress(KeyError), StagedFiles(tmp_path) as staged:
        staged.enter(writer(staged.folder)).write_text("a", encoding="utf-8")
        if fails:
            raise KeyError
    assert left == [True] and list(tmp_path.iterdir()) == []
