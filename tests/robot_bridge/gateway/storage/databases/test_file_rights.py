"""A SQLite database holds who may command and what was done: its file is its owner's, whatever the umask."""

from __future__ import annotations

import asyncio
import os
import stat

import pytest

from robot_bridge.gateway.storage.backup import back_up, restore
from robot_bridge.gateway.storage.database import Database, read_address
from robot_bridge.gateway.storage.repositories.metadata import newest_time


def rights(file):
    return stat.S_IMODE(file.stat().st_mode)


@pytest.fixture
def file(tmp_path):
    return tmp_path / "fleet.db"


async def use(file):
    database = Database(read_address(f"sqlite:///{file}"))
    await database.open()
    await database.run(newest_time)
    await database.close()


@pytest.mark.parametrize("umask", [0o000, 0o022, 0o077])
async def test_a_new_one_is_its_owners_alone(file, umask):
    before = os.umask(umask)
    try:
        await use(file)
    finally:
        os.umask(before)
    assert rights(file) == 0o600


def test_so_is_one_that_a_backup_is_restored_into(file, tmp_path):
    asyncio.run(use(file))
    backup, other = tmp_path / "backup", tmp_path / "other.db"
    before = os.umask(0o022)
    try:
        back_up(read_address(f"sqlite:///{file}"), backup)
        asyncio.run(restore(read_address(f"sqlite:///{other}"), backup))
    finally:
        os.umask(before)
    assert (rights(backup), rights(other)) == (0o600, 0o600)


async def test_one_that_everybody_could_read_is_closed_to_them_and_the_log_says_so(file, caplog):
    await use(file)
    file.chmod(0o664)
    await use(file)
    assert rights(file) == 0o660
    assert f"every account of this computer could open {file}; now its owner and group may" in caplog.text


async def test_what_its_group_was_given_stays(file, caplog):
    await use(file)
    file.chmod(0o640)
    await use(file)
    assert rights(file) == 0o640
    assert caplog.text == ""
