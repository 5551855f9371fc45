"""The files of stops and Aborts that are not stored: written first of all, read by every later gateway."""

from __future__ import annotations

import asyncio
import hashlib
import json
import os
import stat
import threading
import time
from concurrent.futures import Future
from pathlib import Path

import pytest
from sqlalchemy import make_url

from robot_bridge.core.errors import BridgeError
from robot_bridge.core.messages.commands import ABORT_VALID_S
from robot_bridge.core.messages.robots import Abort
from robot_bridge.gateway.commands.active_command import CommandOrder, KeptAbort, UnstoredAborts
from robot_bridge.gateway.fleet.emergency_persistence import AbortJournal, StopJournal, journal_files
from robot_bridge.gateway.storage.repositories.emergency_stops import StopRow
from tests.support.errors import StageError
from tests.support.faults.disk import Disk

FIRST = StopRow("stop-0001", 1000.5, "Ada", "child on the track")
SECOND = StopRow("stop-0002", 1001.0, "Ben", None)
TEXT = (
    '[{"id": "stop-0001", "at": 1000.5, "by": "Ada", "reason": "child on the track"}, '
    '{"id": "stop-0002", "at": 1001.0, "by": "Ben", "reason": null}]'
)


@pytest.fixture
def file(tmp_path):
    return tmp_path / "fleet.db.stop"


async def test_the_file_reads_as_gateways_before_and_after_this_one_write_it(file):
    StopJournal(file).write([FIRST, SECOND]).result()
    assert file.read_text(encoding="ascii") == TEXT
    assert StopJournal(file).read() == [FIRST, SECOND]


def test_the_file_of_a_server_s_database_is_found_again_by_later_gateways(tmp_path):
    url = make_url("postgresql://ada:secret@db.example.org:5432/fleet")
    number = hashlib.sha256(b"db.example.org:5432/fleet").hexdigest()[:12]
    names = [f"emergency-stop-{number}.json", f"aborts-{number}.json"]
    assert journal_files(url, tmp_path) == tuple(tmp_path / name for name in names)
    beside = Path("/tmp/a.db.stop"), Path("/tmp/a.db.aborts")
    assert journal_files(make_url("sqlite:////tmp/a.db"), tmp_path) == beside
    assert journal_files(make_url("sqlite://"), tmp_path) is None


@pytest.mark.parametrize("wrong", [{"id": 1}, {"at": 1000}, {"at": "noon"}, {"by": None}])
def test_a_stop_of_which_one_thing_cannot_be_understood_is_a_stop_by_the_gateway(file, wrong):
    stop = {"id": "stop-0001", "at": 1000.5, "by": "Ada", "reason": None}
    file.write_text(json.dumps([{**stop, **wrong}]), encoding="utf-8")
    before = time.time()
    (found,) = StopJournal(file).read()
    assert found.by == "gateway"
    assert found.id.startswith("damaged-") and found.id != StopJournal(file).read()[0].id
    assert before <= found.at <= time.time()
    assert found.reason == f"{file} could not be understood; look at every robot before this is cleared"


@pytest.mark.parametrize("text", ["", "[{", "3", "{}", "[" * 5000])
def test_a_file_that_is_no_list_of_stops_is_one_stop_and_in_the_log_where_it_is_no_json(file, text, caplog):
    file.write_text(text, encoding="utf-8")
    (found,) = StopJournal(file).read()
    assert found.reason == f"{file} could not be understood; look at every robot before this is cleared"
    told = [record.getMessage() for record in caplog.records]
    if text in ("3", "{}"):
        assert told == []
    else:
        (line,) = told
        assert line.startswith(f"{file} could not be understood: ") and not line.endswith(("None", "XX"))


def test_what_is_no_text_as_a_reason_keeps_no_stop_from_being_one(file):
    file.write_text('[{"id": "stop-0001", "at": 1000.5, "by": "Ada", "reason": 7}]', encoding="utf-8")
    assert StopJournal(file).read() == [FIRST._replace(reason=None)]


def test_a_file_of_which_a_byte_is_damaged_is_read_as_far_as_it_goes(file):
    file.write_bytes(TEXT.encode().replace(b"child", b"ch\xffld"))
    assert StopJournal(file).read() == [FIRST._replace(reason="ch\ufffdld on the track"), SECOND]


def test_a_file_that_cannot_be_read_is_a_stop_and_the_log_says_what_to_do(file, caplog):
    file.mkdir()
    (stop,) = StopJournal(file).read()
    assert stop.by == "gateway"
    assert stop.reason == (
        f"{file} could not be read (Is a directory); look at every robot before this is cleared"
    )
    assert (
        f"{file} cannot be read: Is a directory; emergency stops are noted there: "
        "give this account the right to read and write it"
    ) in caplog.text


@pytest.mark.parametrize("bad", ["[" * 2000, "null", '{"id": "stop-0001"}', "[1e400]", '"' + "x" * 100])
def test_whatever_stands_there_is_a_stop_and_ends_no_gateway(file, bad):
    file.write_text(bad, encoding="utf-8")
    assert [stop.by for stop in StopJournal(file).read()] == ["gateway"]


@pytest.mark.parametrize(
    "bad", ["7", '{"id": "x", "at": 1.0, "by": "A"}', '{"id": "%s"}' % ("x" * 65), "[[]]"]
)
def test_one_stop_that_cannot_be_understood_hides_no_other(file, bad):
    file.write_text(f"{TEXT[:-1]}, {bad}]", encoding="utf-8")
    first, second, third = StopJournal(file).read()
    assert (first, second, third.by) == (FIRST, SECOND, "gateway")


async def test_what_a_gateway_left_that_died_while_it_wrote_is_written_over(file):
    partial = file.with_name(".fleet.db.stop.new")
    partial.write_text("x" * 10_000, encoding="utf-8")
    StopJournal(file).write([FIRST, SECOND]).result()
    assert file.read_text(encoding="ascii") == TEXT
    assert not partial.exists()


async def test_nobody_else_on_this_computer_may_read_or_change_it(file):
    umask = os.umask(0)
    try:
        StopJournal(file).write([FIRST]).result()
    finally:
        os.umask(umask)
    assert stat.S_IMODE(file.stat().st_mode) == 0o600


async def test_what_is_written_later_waits_for_what_is_on_its_way(file):
    order = []
    # Who opens a pipe for writing waits until somebody reads.
    pipe = file.with_name(".fleet.db.stop.new")
    os.mkfifo(pipe)
    journal = StopJournal(file)
    writes = [journal.write([FIRST]), journal.write([])]
    for number, write in enumerate(writes):
        write.add_done_callback(lambda _, number=number: order.append(number))
    await asyncio.sleep(0.05)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        for write in writes:
            await asyncio.wrap_future(write)
    finally:
        os.close(reader)
    assert order == [0, 1]
    assert "emergency stops_0" in {thread.name for thread in threading.enumerate()}


async def test_to_write_nothing_where_nothing_is_is_no_trouble(file, caplog):
    StopJournal(file).write([]).result()
    assert caplog.records == []


async def test_a_disk_that_takes_nothing_is_in_the_log_by_its_name(file, caplog, monkeypatch):
    file.with_name(".fleet.db.stop.new").mkdir()
    StopJournal(file).write([FIRST]).result()
    file.with_name(".fleet.db.stop.new").rmdir()

    def fail(_descriptor):
        raise OSError("the disk is gone")

    monkeypatch.setattr(os, "fsync", fail)
    StopJournal(file).write([FIRST]).result()
    assert [record.getMessage() for record in caplog.records] == [
        f"emergency stops cannot be noted in {file}: {why}; they go out all the same"
        for why in ("Is a directory", "the disk is gone")
    ]
    assert not file.exists()


async def test_a_file_system_that_cannot_write_down_a_folder_keeps_no_stop_from_being_noted(
    file, caplog, monkeypatch
):
    fsync, written = os.fsync, []

    def fsync_of_files(descriptor):
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            written.append(Path(f"/proc/self/fd/{descriptor}").readlink())
            raise OSError("not of folders")
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", fsync_of_files)
    StopJournal(file).write([FIRST]).result()
    assert StopJournal(file).read() == [FIRST]
    assert (written, caplog.records) == ([file.parent], [])


def open_descriptors():
    return {path.name for path in Path("/proc/self/fd").iterdir()}


async def test_no_descriptor_is_left_open(file):
    journal = StopJournal(file)
    journal.write([FIRST]).result()
    before = open_descriptors()
    for _ in range(3):
        journal.write([FIRST, SECOND]).result()
    assert open_descriptors() <= before


@pytest.mark.parametrize("which", ["missing", "file", "shut"])
def test_a_folder_in_which_nothing_can_be_noted_is_found_before_it_is_needed(tmp_path, monkeypatch, which):
    folder = tmp_path / which
    if which == "file":
        folder.write_text("", encoding="utf-8")
        folder.chmod(0o700)
    if which == "shut":
        folder.mkdir()
        # Root may write everywhere: what the tests run as often is.
        monkeypatch.setattr(os, "access", lambda path, mode: path != folder or mode != os.W_OK | os.X_OK)
    with pytest.raises(BridgeError) as caught:
        StopJournal(folder / "fleet.db.stop").check()
    assert str(caught.value) == (
        f"emergency stops cannot be noted in folder {folder}, which is missing or not to be written: one "
        "that is made while the database is away would be forgotten with this gateway; make the folder, or "
        "give another one with --state or ROBOT_BRIDGE_STATE"
    )


def test_a_folder_in_which_stops_can_be_noted_is_right(file):
    StopJournal(file).check()


async def test_a_full_disk_takes_a_stop_and_has_room_for_the_next_one_afterwards(tmp_path):
    try:
        with Disk(tmp_path / "disk", megabytes=1) as disk:
            file = disk.folder / "fleet.db.stop"
            journal = StopJournal(file)
            journal.check()
            disk.fill()
            journal.write([FIRST, SECOND]).result()
            assert StopJournal(file).read() == [FIRST, SECOND]
            disk.free()
            journal.write([]).result()
            disk.fill()
            journal.write([SECOND]).result()
            assert StopJournal(file).read() == [SECOND]
    except StageError as error:
        pytest.skip(str(error))


async def test_a_full_disk_takes_one_stop_after_the_other(tmp_path):
    """Whatever else waits for room has it before the next stop."""
    try:
        with Disk(tmp_path / "disk", megabytes=1) as disk:
            file = disk.folder / "fleet.db.stop"
            journal = StopJournal(file)
            journal.check()
            noted = []
            for number in range(5):
                disk.fill()
                noted.append(
                    FIRST._replace(id=f"stop-000{number}", reason="x" * 900 if number == 2 else None)
                )
                journal.write(noted[-3:]).result()
                assert StopJournal(file).read() == noted[-3:]
    except StageError as error:
        pytest.skip(str(error))


ABORTS = [
    CommandOrder("abort-0001", "r1", Abort(), "Ada", "smoke"),
    CommandOrder("abort-0002", "r1", Abort(), "Ada", expires_in=60.0, aborts="target-0001"),
    CommandOrder("abort-0003", "r2", Abort(emergency=True), "gateway"),
]


@pytest.fixture
def aborts_file(tmp_path):
    return tmp_path / "fleet.db.aborts"


def kept_since(at, orders=ABORTS):
    return [KeptAbort(order, at) for order in orders]


def left(kept):
    return [one._replace(is_left=True) for one in kept]


async def test_aborts_are_read_as_they_were_written_and_gone_once_none_is_left(aborts_file):
    journal, kept = AbortJournal(aborts_file, "db-1"), kept_since(time.time())
    assert journal.write(kept).result()
    assert AbortJournal(aborts_file, "db-1").read() == left(kept)
    assert stat.S_IMODE(aborts_file.stat().st_mode) == 0o600
    assert journal.write([]).result()
    assert not aborts_file.exists() and AbortJournal(aborts_file, "db-1").read() == []


async def test_aborts_of_another_database_or_of_long_ago_stop_no_robot(aborts_file):
    now = time.time()
    young, old = (
        kept_since(now - ABORT_VALID_S + 60, ABORTS[:1]),
        kept_since(now - ABORT_VALID_S - 1, ABORTS[1:]),
    )
    AbortJournal(aborts_file, "db-1").write([*young, *old]).result()
    assert AbortJournal(aborts_file, "db-1").read() == left(young)
    assert AbortJournal(aborts_file, "db-2").read() == []


def read_to_the_end(journal):
    """Return what the journal has read, once it has written what follows from that."""
    found = journal.read()
    journal._thread.shutdown()
    return found


async def test_an_abort_noted_before_the_clock_was_set_back_is_as_if_of_this_moment(aborts_file):
    """Else what its robot was sent on with meanwhile would never be later than it."""
    AbortJournal(aborts_file, "db-1").write(kept_since(1000.0)).result()
    assert AbortJournal(aborts_file, "db-1").read(900.0) == left(kept_since(900.0))


def test_what_is_dropped_is_in_the_file_no_more(aborts_file, caplog):
    young, old = kept_since(time.time(), ABORTS[:1]), kept_since(1.0, ABORTS[1:])
    AbortJournal(aborts_file, "db-1").write([*young, *old]).result()
    assert read_to_the_end(AbortJournal(aborts_file, "db-1")) == left(young)
    assert len(caplog.records) == 2
    assert read_to_the_end(AbortJournal(aborts_file, "db-1")) == left(young)
    assert len(caplog.records) == 2
    assert read_to_the_end(AbortJournal(aborts_file, "db-2")) == []
    assert not aborts_file.exists()


def test_what_can_be_understood_stays_in_the_file_beside_what_cannot(aborts_file):
    kept = kept_since(time.time(), ABORTS[:1])
    AbortJournal(aborts_file, "db-1").write(kept).result()
    aborts_file.write_text(aborts_file.read_text(encoding="utf-8")[:-1] + ", 7]", encoding="utf-8")
    for _ in range(2):
        assert read_to_the_end(AbortJournal(aborts_file, "db-1")) == left(kept)


@pytest.mark.parametrize("known", [(), ("r1",)])
def test_one_of_a_robot_that_is_gone_is_in_the_file_no_more(aborts_file, known):
    kept = kept_since(time.time())
    AbortJournal(aborts_file, "db-1").write(kept).result()
    journal = AbortJournal(aborts_file, "db-1")
    unstored = UnstoredAborts(journal)
    unstored.restore(known.__contains__)
    journal._thread.shutdown()
    theirs = [one for one in kept if one.order.robot in known]
    assert unstored.of(unstored.robots()) == left(theirs)
    assert AbortJournal(aborts_file, "db-1").read() == left(theirs)


GOOD = '{"command": "abort-0001", "robot": "r1", "by": "Ada", "at": 1e12, "database": "db-1"}'


@pytest.mark.parametrize(
    "bad",
    [
        "7",
        GOOD.replace("abort-0001", "short"),
        GOOD.replace("abort-0001", "x" * 65),
        GOOD.replace("r1", "no robot's name"),
        GOOD.replace('"Ada"', "7"),
        GOOD.replace("1e12", '"now"'),
        GOOD.replace("}", ', "aborts": 7}'),
        GOOD.replace("}", ', "aborts": "short"}'),
        GOOD.replace("}", ', "expires_in": "soon"}'),
        GOOD.replace("}", ', "expires_in": -1}'),
    ],
)
def test_an_abort_that_cannot_be_understood_hides_no_other_and_is_in_the_log(aborts_file, caplog, bad):
    aborts_file.write_text(f"[{bad}, {GOOD}]", encoding="utf-8")
    order = CommandOrder("abort-0001", "r1", Abort(), "Ada")
    assert AbortJournal(aborts_file, "db-1").read(1e12) == left([KeptAbort(order, 1e12)])
    assert "could not be understood" in caplog.text
    assert "look whether robots stand that were sent an Abort" in caplog.text


@pytest.mark.parametrize("bad", ["[" * 2000, "null", '{"robot": "r1"}', "x"])
def test_a_damaged_file_of_aborts_ends_no_gateway_and_is_kept_for_whoever_looks_into_it(aborts_file, bad):
    aborts_file.write_text(bad, encoding="utf-8")
    assert AbortJournal(aborts_file, "db-1").read() == []
    assert aborts_file.with_name("fleet.db.aborts.unread").read_text(encoding="utf-8") == bad
    assert not aborts_file.exists()


async def test_a_disk_that_takes_no_abort_is_in_the_log_once_and_the_result_says_so(aborts_file, caplog):
    (blocked := aborts_file.with_name(".fleet.db.aborts.new")).mkdir()
    journal = AbortJournal(aborts_file, "db-1")
    assert [journal.write(kept_since(1.0)).result() for _ in range(2)] == [False, False]
    assert caplog.text.count("Aborts cannot be noted in") == 1
    blocked.rmdir()
    assert journal.write(kept_since(1.0)).result()


async def test_a_full_disk_takes_the_aborts_of_a_fleet_and_says_so_where_it_does_not(tmp_path, caplog):
    many = kept_since(time.time(), [ABORTS[0]] * 1300)
    try:
        with Disk(tmp_path / "disk", megabytes=2) as disk:
            journal = AbortJournal(disk.folder / "fleet.db.aborts", "db-1")
            journal.check()
            disk.fill()
            for kept in (many[:1], many):
                assert journal.write(kept).result()
                assert journal.read() == left(kept)
            assert not journal.write(many * 2).result()
            assert "Aborts cannot be noted in" in caplog.text and "No space left" in caplog.text
            assert journal.read() == left(many)
    except StageError as error:
        pytest.skip(str(error))


class Notes:
    """Notes in memory, of which the first ``fails`` are not written."""

    def __init__(self, fails=0):
        self.written, self._fails = [], fails

    def write(self, kept, _settled):
        done = Future()
        done.set_result(len(self.written) >= self._fails)
        self.written.append([one.order for one in kept])
        return done


def test_what_is_kept_is_noted_at_once_and_what_is_stored_at_the_next_notes():
    notes = Notes()
    kept = UnstoredAborts(notes)
    kept.keep(ABORTS[1:])
    assert notes.written == [ABORTS[1:]]
    kept.discard(ABORTS[1])
    kept.write_notes()
    kept.write_notes()
    assert notes.written[1:] == [ABORTS[2:]]


def test_notes_that_could_not_be_written_are_written_again():
    notes = Notes(fails=2)
    kept = UnstoredAborts(notes)
    kept.keep(ABORTS[:1])
    for _ in range(4):
        kept.write_notes()
    assert notes.written == [ABORTS[:1]] * 3
