"""A SQLite database on a disk whose blocks are smaller than the memory's pages."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest

from robot_bridge.gateway.storage.database import open_engine, read_address
from tests.support.errors import StageError
from tests.support.faults.disk import DiskWithPower


def test_the_disk_holds_all_of_the_index_that_lies_in_memory(tmp_path):
    """Where it does not, the process ends by SIGBUS when the index grows on a full disk."""
    with contextlib.ExitStack() as stack:
        try:
            disk = stack.enter_context(DiskWithPower(tmp_path / "disk", 8))
        except StageError as error:
            pytest.skip(str(error))
        assert disk.folder.stat().st_blksize == 1024
        engine, _ = open_engine(read_address(f"sqlite:///{disk.folder}/fleet.db"))
        with engine.connect():
            index = Path(f"{disk.folder}/fleet.db-shm").stat()
            assert index.st_size >= 32_768
            assert index.st_blocks * 512 >= index.st_size
        engine.dispose()
