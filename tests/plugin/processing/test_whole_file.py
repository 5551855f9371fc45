"""A file is there whole or not at all."""

from __future__ import annotations

import os
import resource
from contextlib import contextmanager

import pytest
from fleet_supervisor.plugin.processing.common.outputs import OutputError, check_target, write_whole


@contextmanager
def full_after(size: int):
    """Let no file grow beyond ``size`` bytes, as a full disk does."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_full_disk_leaves_the_older_file_and_says_what_to_do(tmp_path):
    target = tmp_path / "map.txt"
    target.write_text("an older map")
    with full_after(1000), pytest.raises(OutputError, match=r"map.txt: File too large\. Choose a file in a"):
        write_whole(target, b"x" * 5000)
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"map.txt": "an older map"}


def test_what_is_written_replaces_the_older_file_and_nothing_else_is_left(tmp_path):
    target = tmp_path / "map.txt"
    target.write_text("an older and longer map")
    write_whole(target, b"a map")
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"map.txt": "a map"}


def test_a_pipe_or_a_device_is_not_replaced_by_a_file(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(OutputError, match="it is there and is no file"):
        write_whole(pipe, b"a map")
    assert pipe.is_fifo() and list(tmp_path.iterdir()) == [pipe]


def test_of_a_link_the_file_behind_it_is_replaced(tmp_path):
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "v1.txt").write_text("an older map")
    link = tmp_path / "current.txt"
    link.symlink_to("maps/v1.txt")
    write_whole(link, b"a map")
    assert link.is_symlink() and (tmp_path / "maps" / "v1.txt").read_text() == "a map"


def test_a_folder_that_may_not_be_written_to_is_named(tmp_path, monkeypatch):
    """Root, who runs tests, may write everywhere: so the system's answer is given here."""
    monkeypatch.setattr(os, "access", lambda path, mode: (path, mode) != (tmp_path, os.W_OK))
    with pytest.raises(OutputError, match=f"the folder {tmp_path} may not be written to"):
        check_target(tmp_path / "map.txt", "The map")


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(OutputError, match=f"there is no folder {tmp_path / 'maps'}"):
        check_target(tmp_path / "maps" / "map.txt", "The map")


def test_a_name_may_be_as_long_as_names_may_be(tmp_path):
    target = tmp_path / ("ő" * 125 + ".txt")
    write_whole(target, b"a map")
    assert list(tmp_path.iterdir()) == [target]
