"""What a link remembers over the death of its process."""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
import threading

import pytest

from robot_bridge.core import files
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.base.memory import MOST_DONE, CompletedCall, LinkMemory, only_process
from tests.support.patience import until


@pytest.fixture
def file(tmp_path):
    return tmp_path / "agvs.state"


async def test_runs_and_what_came_of_messages_are_remembered(file):
    memory = LinkMemory(file)
    memory.use_database("db-1")
    magic = memory.magic("agv-1")
    assert await memory.begin("agv-1", 7) is False
    await memory.finish("agv-1", 7, CompletedCall())
    await memory.begin("agv-1", 8)
    await memory.finish("agv-1", 8, CompletedCall("no"))
    await memory.begin("agv-1", 9)

    again = LinkMemory(file)
    again.use_database("db-1")
    assert again.magic("agv-1") == magic
    assert (again.find("agv-1", 7), again.find("agv-1", 8)) == (CompletedCall(), CompletedCall("no"))
    assert again.find("agv-1", 9) is None
    assert await again.begin("agv-1", 9) is True
    assert again.renew("agv-1") != magic
    assert again.find("agv-1", 7) == CompletedCall(), "a robot that forgot is told anew under other ids"
    again.use_database("db-2")
    assert LinkMemory(file).find("agv-1", 7) is None


async def test_a_line_that_was_cut_off_is_left_out(file, caplog):
    memory = LinkMemory(file)
    magic = memory.magic("agv-1")
    file.write_text(file.read_text(encoding="utf-8") + '{"robot": "agv-2", "ma', encoding="utf-8")
    assert LinkMemory(file).magic("agv-1") == magic
    assert "line 2 is left out" in caplog.text


async def test_it_does_not_grow_for_ever(file):
    memory = LinkMemory(file)
    memory.magic("agv-1")
    lines = [json.dumps({"robot": "agv-1", "done": id}) for id in range(MOST_DONE + 5)]
    file.write_text(file.read_text(encoding="utf-8") + "\n".join(lines) + "\n", encoding="utf-8")
    again = LinkMemory(file)
    assert (again.find("agv-1", 4), again.find("agv-1", 5)) == (None, CompletedCall())
    assert len(file.read_text(encoding="utf-8").splitlines()) == MOST_DONE + 1


async def carry_on(memory, ids):
    for id in ids:
        await memory.begin("agv-1", id)
        await memory.finish("agv-1", id, CompletedCall())


@pytest.fixture
def soon_large(file, monkeypatch):
    """A memory that remembers 20 messages; its file is soon too large."""
    monkeypatch.setattr("robot_bridge.links.base.memory.MOST_DONE", 20)
    monkeypatch.setattr("robot_bridge.links.base.memory.SMALL_FILE", 2000)
    memory = LinkMemory(file)
    memory.use_database("db-1", "here")
    memory.magic("agv-1")
    memory.set_adrift("agv-2")
    return memory


async def test_a_file_much_larger_than_its_state_is_rewritten_with_it(soon_large, file):
    largest = 0
    for id in range(200):
        await carry_on(soon_large, [id])
        largest = max(largest, file.stat().st_size)
        if id % 50 == 0:
            magic = soon_large.renew("agv-1")
    assert 2000 < largest < 8000
    again = LinkMemory(file)
    assert again.magic("agv-1") == magic and again.is_adrift("agv-2")
    assert again.use_database("db-1", "here") is False
    assert again.taken_on("agv-1") == list(range(180, 200))


async def test_what_is_noted_while_the_file_is_rewritten_is_in_it(soon_large, file, monkeypatch):
    """From the loop, without a wait for the thread that rewrites the file."""
    noted = []

    def write_beside(target, content):
        magic = asyncio.run_coroutine_threadsafe(renew(), loop).result()
        noted.append(magic)
        return files.write_beside(target, content)

    async def renew():
        return soon_large.renew("agv-1")

    loop = asyncio.get_running_loop()
    monkeypatch.setattr("robot_bridge.links.base.memory.write_beside", write_beside)
    await carry_on(soon_large, range(100))
    assert noted and LinkMemory(file).magic("agv-1") == noted[-1]


async def test_a_message_that_is_given_up_leaves_the_rewriting_to_itself(soon_large, file, monkeypatch):
    """Two that write what replaces the file would mix it up."""
    writing, goes_on, at_once = threading.Event(), threading.Event(), []

    def write_beside(target, content):
        at_once.append(writing.is_set())
        writing.set()
        goes_on.wait(60)
        writing.clear()
        return files.write_beside(target, content)

    monkeypatch.setattr("robot_bridge.links.base.memory.write_beside", write_beside)
    message = asyncio.create_task(carry_on(soon_large, range(100)))
    await until(writing.is_set)
    message.cancel()
    await asyncio.gather(message, return_exceptions=True)
    more = asyncio.create_task(carry_on(soon_large, range(100, 200)))
    asyncio.get_running_loop().call_later(0.1, goes_on.set)
    await more
    assert len(at_once) > 1 and not any(at_once)
    assert LinkMemory(file).taken_on("agv-1") == list(range(180, 200))


async def test_a_file_that_cannot_be_rewritten_is_appended_to(soon_large, file, caplog):
    new = file.with_name(f".{file.name}.new")
    new.symlink_to("/dev/full")
    await carry_on(soon_large, range(100))
    assert soon_large.fault is None
    assert "cannot be made smaller: No space left" in caplog.text
    assert not new.is_symlink()
    assert LinkMemory(file).taken_on("agv-1") == list(range(80, 100))


async def test_a_file_of_any_length_is_read_in_pieces_and_made_smaller(file):
    magic = LinkMemory(file).magic("agv-1")
    with file.open("ab") as out:
        out.write(b'{"robot": "agv-1", "done": 7}\n')
        # Longer than any line.
        out.truncate(16 << 20)
        out.seek(0, 2)
        out.write(b'\n{"robot": "agv-1", "done": 8}\n')
    again = LinkMemory(file)
    assert again.magic("agv-1") == magic and again.taken_on("agv-1") == [7, 8]
    assert file.stat().st_size < 1000


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    with pytest.raises(LinkError, match="state_folder"):
        LinkMemory(tmp_path / "none" / "agvs.state")


async def test_on_a_full_disk_nothing_is_begun_and_all_is_written_once_there_is_room(file, caplog):
    magic = LinkMemory(file).magic("agv-1")
    new = file.with_name(f".{file.name}.new")
    new.symlink_to("/dev/full")
    memory = LinkMemory(file)
    assert "No space left" in memory.fault
    assert memory.magic("agv-1") == magic
    other = memory.magic("agv-2")
    for _ in range(2):
        with pytest.raises(LinkError, match="can be stopped"):
            await memory.begin("agv-1", 7)
    await memory.finish("agv-1", 6, CompletedCall())
    await memory.recover()
    assert memory.fault is not None

    new.unlink()
    await memory.recover()
    assert memory.fault is None
    assert await memory.begin("agv-1", 7) is False
    again = LinkMemory(file)
    assert (again.magic("agv-2"), again.find("agv-1", 6)) == (other, CompletedCall())
    assert await again.begin("agv-1", 7) is True
    assert [r.levelname for r in caplog.records if "agvs.state" in r.message] == ["ERROR", "WARNING"]


async def test_a_disk_that_fills_up_under_way_is_noticed_by_the_next_message(file):
    memory = LinkMemory(file)
    magic = memory.magic("agv-1")
    kept = file.read_bytes()
    file.unlink()
    file.symlink_to("/dev/full")
    with pytest.raises(LinkError, match="No space left"):
        await memory.begin("agv-1", 7)
    file.unlink()
    file.write_bytes(kept + b'{"robot": "agv')
    assert await memory.begin("agv-1", 8) is False
    again = LinkMemory(file)
    assert again.magic("agv-1") == magic
    assert await again.begin("agv-1", 7) is False
    assert await again.begin("agv-1", 8) is True


def adrift(memory):
    return [name for name in ("agv-1", "agv-2") if memory.is_adrift(name)]


async def test_robots_are_adrift_with_another_database_or_in_another_frame(file):
    memory = LinkMemory(file)
    assert memory.use_database("one", "here") is False
    for robot in ("agv-1", "agv-2"):
        memory.magic(robot)
    await memory.begin("agv-1", 7)
    await memory.finish("agv-1", 7, CompletedCall())

    memory = LinkMemory(file)
    assert memory.use_database("one", "here") is False and not memory.is_adrift("agv-1")
    # Messages of the same database keep their ids: none is done once more.
    assert memory.use_database("one", "there") is True and adrift(memory) == ["agv-1"]
    assert memory.find("agv-1", 7) == CompletedCall()

    # Nobody has stopped it yet.
    memory = LinkMemory(file)
    assert adrift(memory) == ["agv-1"]
    memory.clear_adrift("agv-1")
    assert memory.use_database("two", "there") is True and adrift(memory) == ["agv-1"]
    assert memory.find("agv-1", 7) is None
    assert adrift(LinkMemory(file)) == adrift(LinkMemory(file)) == ["agv-1"]
    memory.clear_adrift("agv-1")
    memory = LinkMemory(file)
    assert memory.use_database("two", "there") is False and not memory.is_adrift("agv-1")


PROCESS = """
import asyncio, pathlib, sys
from robot_bridge.links.base.memory import only_process
async def run():
    async with only_process(pathlib.Path(sys.argv[1])):
        print("runs", flush=True)
        await asyncio.Event().wait()
asyncio.run(run())
"""


async def test_a_second_process_of_a_link_is_refused_until_the_first_has_ended(file):
    first = subprocess.Popen([sys.executable, "-c", PROCESS, file], stdout=subprocess.PIPE)
    try:
        assert first.stdout.readline() == b"runs\n"
        with pytest.raises(LinkError, match=f"link agvs runs already.*process {first.pid}"):
            async with only_process(file, 0.2):
                pass
        first.kill()
        async with only_process(file, 20.0):
            pass
    finally:
        first.kill()
        first.wait()
        first.stdout.close()


async def test_a_folder_without_locks_keeps_no_link_from_running(tmp_path, caplog):
    async with only_process(tmp_path / "none" / "agvs.state"):
        assert "would not be noticed" in caplog.text
