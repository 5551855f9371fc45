"""An emergency stop that could not be stored before its gateway died is known to the next one."""

import json
import os
import sqlite3
import subprocess
from contextlib import closing

import pytest
from sqlalchemy import make_url

from robot_bridge.gateway.fleet.emergency_persistence import StopJournal, journal_files
from robot_bridge.gateway.storage.repositories.emergency_stops import StopRow
from tests.support.bridge.bridge_programs import wait_until
from tests.support.wire import RefusedError

FIRST = StopRow("stop-0001", 1000.5, "Ada", "child on the track")
SECOND = StopRow("stop-0002", 1001.0, "Ben", None)


@pytest.fixture
def file(tmp_path):
    return tmp_path / "fleet.db.stop"


async def test_what_is_written_last_is_what_the_next_gateway_reads(file):
    journal = StopJournal(file)
    assert journal.read() == []
    for stops in ([FIRST], [FIRST, SECOND], [SECOND]):
        journal.write(stops)
    journal.write([FIRST, SECOND]).result()
    assert StopJournal(file).read() == [FIRST, SECOND]
    assert file.stat().st_mode & 0o777 == 0o600
    journal.write([]).result()
    assert StopJournal(file).read() == []
    rooms = {f".{file.name}.{name}" for name in ("room", "spare")}
    assert {one.name for one in file.parent.iterdir()} == rooms


@pytest.mark.parametrize(
    "text", ["", "[{", "[3]", '[{"id": "x"}]', '[{"id": 1, "at": 1.0, "by": "A", "reason": ""}]']
)
def test_what_cannot_be_understood_is_a_stop_all_the_same(file, text):
    file.write_text(text, encoding="utf-8")
    (stop,) = StopJournal(file).read()
    assert stop.by == "gateway"
    assert stop.reason == f"{file} could not be understood; look at every robot before this is cleared"


async def test_a_disk_that_takes_nothing_is_told_to_the_log_and_keeps_no_stop_back(tmp_path, caplog):
    StopJournal(tmp_path / "missing" / "f.stop").write([FIRST]).result()
    assert "emergency stops cannot be noted in" in caplog.text
    assert "No such file or directory; they go out all the same" in caplog.text


def test_each_database_has_a_file_of_its_own(tmp_path):
    def of(url):
        return journal_files(make_url(url), tmp_path)

    assert of(f"sqlite:///{tmp_path}/a.db") == (tmp_path / "a.db.stop", tmp_path / "a.db.aborts")
    assert of("sqlite://") is None
    names = {of(f"{kind}://x:y@h/{name}") for kind in ("postgresql", "mariadb") for name in "ab"}
    assert len(names) == 2 and len({name for pair in names for name in pair}) == 4
    assert {name.parent for pair in names for name in pair} == {tmp_path}
    # Another account or password is the same database.
    assert of("postgresql://x:y@h/a") == of("postgresql://z@h/a")


def stopped(bridge):
    return bridge.sql('select id, "by", reason, cleared_by from emergency_stops')


def test_a_stop_made_while_the_server_was_down_outlives_the_gateway(
    start_bridge, sample_site, postgresql_server, new_database, tmp_path
):
    url = new_database("postgresql")
    bridge = start_bridge(sample_site, url, ["--state", tmp_path])
    desk, robot = bridge.desk(), bridge.robot("ws")
    robot.plug_in(1)
    bridge.sql("insert into rr (robot, op, params) values ('sq', 'Ready', '{\"magic\": 1}')")
    wait_until(lambda: bridge.sql("select id from sa where robot = 'sq' and op = 'SetMap'"))
    postgresql_server.kill()
    try:
        report = desk.ask("emergency_stop", {"command": "stop-0001", "reason": "child on the track"})
        assert (report["in_force"], report["stored"]) == (True, False)
        assert robot.wait_for("Abort", 2.0)["params"] == {"emergency": True}
        # Robots wait a tenth of a second for it; a busy disk takes longer.
        (noted,) = wait_until(lambda: list(tmp_path.glob("emergency-stop-*")))
        assert [stop["id"] for stop in json.loads(noted.read_text())] == ["stop-0001"]
        bridge.kill_gateway()
    finally:
        postgresql_server.start()
    assert stopped(bridge) == []

    bridge.start_gateway()

    desk = bridge.desk("Eve")
    stop = desk.ask("hello", {"operator": "Eve"})["emergency"]
    assert (stop["in_force"], stop["by"], stop["reason"]) == (True, "Ada", "child on the track")
    with pytest.raises(RefusedError, match=r"emergency stop is in force .* by Ada"):
        desk.send("command-1", "ws", "SetPosEnd", x=9.0, y=9.0)
    assert bridge.robot("ws").wait_for("Abort")["id"] == "emergency-stop-0001"
    assert bridge.sql("select op from sa where robot = 'sq' and urgent > 0") == [("Abort",)]
    assert stopped(bridge) == [("stop-0001", "Ada", "child on the track", None)]
    assert list(tmp_path.glob("emergency-stop-*")) != []
    assert desk.ask("clear_emergency_stop", {"reason": "free"})["in_force"] is False
    wait_until(lambda: list(tmp_path.glob("emergency-stop-*")) == [])
    bridge.kill_gateway()
    bridge.start_gateway()
    assert bridge.desk().emergency["in_force"] is False
    bridge.end()


def test_a_stop_that_was_stored_and_cleared_does_not_come_back(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    desk = bridge.desk()
    assert desk.ask("emergency_stop", {"command": "stop-0001"})["stored"]
    desk.ask("clear_emergency_stop", {"reason": "free"})
    journal = bridge.file.with_name(f"{bridge.file.name}.stop")
    wait_until(lambda: not journal.exists())
    bridge.kill_gateway()
    # As after a power cut that undid only the file's end.
    journal.write_text('[{"id": "stop-0001", "at": 1.0, "by": "Ada", "reason": null}]', encoding="utf-8")
    bridge.start_gateway()
    assert bridge.desk().emergency["in_force"] is False
    wait_until(lambda: not journal.exists())
    bridge.end()


@pytest.mark.parametrize("end", ["-wal", "-shm"])
def test_a_stop_outlives_a_gateway_whose_log_was_deleted(start_bridge, sample_site, end):
    """Whoever deletes the files beside the database takes with them what is stored from then on."""
    bridge = start_bridge(sample_site)
    desk, robot = bridge.desk(), bridge.robot("ws")
    robot.plug_in(1)
    bridge.file.with_name(f"{bridge.file.name}{end}").unlink()
    report = desk.ask("emergency_stop", {"command": "stop-0001"})
    assert (report["in_force"], report["stored"]) == (True, False)
    assert robot.wait_for("Abort")
    with pytest.raises(RefusedError, match=f"{bridge.file.name}{end} was taken away or replaced"):
        desk.ask("clear_emergency_stop", {"reason": "free"})
    bridge.kill_gateway()
    bridge.start_gateway()
    with bridge.desk() as desk:
        assert (desk.emergency["in_force"], desk.emergency["stop"]) == (True, "stop-0001")
    bridge.end()


def test_a_disk_that_hangs_holds_no_stop_up(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    desk, robot = bridge.desk(), bridge.robot("ws")
    robot.plug_in(1)
    # Who opens a pipe for writing waits until somebody reads.
    os.mkfifo(bridge.file.with_name(f".{bridge.file.name}.stop.new"))
    with closing(sqlite3.connect(bridge.file, isolation_level=None)) as hog:
        hog.execute("begin immediate")
        desk.tell("emergency_stop", {"command": "stop-0001"})
        assert robot.wait_for("Abort", 1.0)
        hog.execute("rollback")
    bridge.kill_gateway()
    bridge.end()


def test_a_gateway_that_could_not_note_a_stop_does_not_start(
    sample_site, new_database, tmp_path, forking_command
):
    url = new_database("postgresql")
    missing = tmp_path / "missing"
    command = [forking_command, "serve", "--site", sample_site, "--port", "0"]
    command += ["--database", url, "--state", missing]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 1
    assert f"emergency stops cannot be noted in folder {missing}, which is missing" in done.stderr
    assert "--state or ROBOT_BRIDGE_STATE" in done.stderr
