"""A file is there whole or not at all."""

from __future__ import annotations

import resource
from contextlib import contextmanager

import pytest
from fleet_supervisor.plugin.processing.whole_file import OutputError, write_whole


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
