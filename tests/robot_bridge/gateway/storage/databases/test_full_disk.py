"""A SQLite database on a disk that is full."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from sqlalchemy import insert, select

from robot_bridge.core.errors import StoreError
from robot_bridge.gateway.storage.database import Database, open_engine, read_address
from robot_bridge.gateway.storage.schema import rr
from tests.support.bridge.busy_database import done_together
from tests.support.errors import StageError
from tests.support.faults.disk import Disk, DiskWithPower


@pytest.fixture
def disk(tmp_path, request):
    with contextlib.ExitStack() as stack:
        try:
            yield stack.enter_context(request.param(tmp_path / "disk", 8))
        except StageError as error:
            pytest.skip(str(error))


@pytest.mark.parametrize("disk", [DiskWithPower], indirect=True)
def test_the_disk_holds_all_of_the_index_that_lies_in_memory(disk):
    """Where it does not, the process ends by SIGBUS when the index grows: blocks are smaller than pages."""
    assert disk.folder.stat().st_blksize == 1024
    engine, _ = open_engine(read_address(f"sqlite:///{disk.folder}/fleet.db"))
    with engine.connect():
        index = Path(f"{disk.folder}/fleet.db-shm").stat()
        assert index.st_size >= 32_768
        assert index.st_blocks * 512 >= index.st_size
    engine.dispose()


@pytest.mark.parametrize("disk", [DiskWithPower], indirect=True)
async def test_the_index_stays_when_the_disk_takes_no_commit(disk):
    """The connection is a new one then; a new index would have no room."""
    database = Database(f"sqlite:///{disk.folder}/fleet.db")
    await database.open()
    index = Path(f"{disk.folder}/fleet.db-shm")
    session = database.session
    disk.fill()
    for _ in range(3):
        with pytest.raises(StoreError, match="disk is full"):
            await database.run(add, "x" * 60, 9000)
    assert index.stat().st_blocks * 512 >= index.stat().st_size
    disk.free()
    await database.run(add, "second")
    assert database.session > session
    await database.close()
    assert not index.exists()


@pytest.mark.parametrize("disk", [Disk], indirect=True)
async def test_what_only_reads_succeeds_beside_what_cannot_be_written(disk):
    database = Database(f"sqlite:///{disk.folder}/fleet.db")
    await database.open()
    await database.run(add, "first")
    disk.fill()
    works = [database.run(add, "x" * 60, 900), database.read(names), database.run(add, "x" * 60, 900)]
    written, read, again = await done_together(database, *works)
    assert "disk is full" in str(written) and isinstance(again, StoreError)
    assert read == ["first"]
    disk.free()
    await database.run(add, "second")
    assert await database.read(names) == ["first", "second"]
    await database.close()


def add(connection, robot, times=1):
    connection.execute(insert(rr), [{"robot": robot, "op": "Alive"}] * times)


def names(connection):
    return list(connection.scalars(select(rr.c.robot).order_by(rr.c.id)))
