"""Accounts, the audit log and sessions on a real database."""

from __future__ import annotations

import asyncio
import gc
import math

import pytest

from robot_bridge.core.errors import AccessError, StoreError
from robot_bridge.core.messages.administration import GetAudit, GetSessions
from robot_bridge.core.messages.base import MessageError, Role
from robot_bridge.gateway.auth import accounts, audit
from robot_bridge.gateway.auth import audit as session_rows
from robot_bridge.gateway.auth.accounts import AccountCache, TokenKind, digest
from robot_bridge.gateway.auth.administration import AccountAdministration
from robot_bridge.gateway.auth.audit import AuditEntry, AuditJournal, SessionRow
from robot_bridge.gateway.storage.schema import metadata


async def test_a_token_opens_until_it_is_revoked_or_expires(database):
    book = AccountCache(database)
    token = await database.run(accounts.add_operator, "Ada", Role.SUPERVISOR, 100.0, 200.0)
    assert await book.refresh()
    grant = book.find(token)
    assert (grant.owner, grant.role, grant.kind) == ("Ada", Role.SUPERVISOR, TokenKind.OPERATOR)
    assert grant.fault(199.0) is None
    assert "expired" in grant.fault(200.0)
    await database.run(accounts.revoke_operator, "Ada", 150.0)
    assert await book.refresh()
    assert "revoked" in book.find(token).fault(151.0)


async def test_only_a_tokens_hash_is_in_the_database(database):
    token = await database.run(accounts.add_operator, "Ada", Role.VIEWER, 100.0)
    robot = await database.run(accounts.issue_robot_token, "r1", 100.0)

    def everything(connection):
        return [
            str(tuple(row)) for table in metadata.sorted_tables for row in connection.execute(table.select())
        ]

    rows = await database.run(everything)
    assert any(digest(token) in row for row in rows)
    assert not any(secret in row for row in rows for secret in (token, robot))


async def test_a_new_token_takes_the_place_of_the_old(database):
    book = AccountCache(database)
    old = await database.run(accounts.add_operator, "Ada", Role.VIEWER, 100.0)
    new = await database.run(accounts.rotate_operator, "Ada", 101.0)
    robots = [await database.run(accounts.issue_robot_token, "r1", 100.0 + n) for n in range(2)]
    await book.refresh()
    assert [book.find(token).fault(102.0) is None for token in (old, new, *robots)] == [
        False,
        True,
        False,
        True,
    ]


async def test_what_changed_is_noticed_and_nothing_else(database):
    book = AccountCache(database)
    assert await book.refresh()
    assert not await book.refresh()
    changes = [
        (accounts.add_operator, "Ada", Role.VIEWER, 100.0),
        (accounts.set_role, "Ada", Role.OPERATOR),
        (accounts.rotate_operator, "Ada", 101.0),
        (accounts.issue_robot_token, "r1", 102.0),
        (accounts.revoke_robot_token, "r1", 103.0),
        (accounts.revoke_operator, "Ada", 103.0),
    ]
    for change in changes:
        await database.run(*change)
        assert await book.refresh(), change
        assert not await book.refresh()


async def test_doors_that_were_closed_once_stay_closed(database):
    book = AccountCache(database)
    await book.refresh()
    assert book.is_open(TokenKind.OPERATOR)
    await database.run(accounts.add_operator, "Ada", Role.SUPERVISOR, 100.0)
    await database.run(accounts.revoke_operator, "Ada", 101.0)
    await book.refresh()
    assert not book.is_open(TokenKind.OPERATOR)
    assert book.is_open(TokenKind.ROBOT)
    assert not book.has_operator(102.0)


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "x" * 129, "\x00"])
async def test_a_name_that_cannot_be_an_operators_is_refused(database, name):
    with pytest.raises(AccessError, match="cannot be used"):
        await database.run(accounts.add_operator, name, Role.VIEWER, 1.0)


async def test_names_differ_by_more_than_capitals(database):
    await database.run(accounts.add_operator, "Ada", Role.VIEWER, 1.0)
    with pytest.raises(AccessError, match=r"'Ada' is there already.*operators rotate"):
        await database.run(accounts.add_operator, "ADA", Role.VIEWER, 1.0)
    await database.run(accounts.add_operator, "'; drop table operators; --", Role.VIEWER, 1.0)
    assert len(await database.run(accounts.all_operators)) == 2


@pytest.mark.parametrize(
    "work",
    [
        lambda c: accounts.rotate_operator(c, "Bob", 1.0),
        lambda c: accounts.revoke_operator(c, "Bob", 1.0),
        lambda c: accounts.set_role(c, "Bob", Role.VIEWER),
    ],
)
async def test_an_operator_that_is_not_known_is_named_with_those_that_are(database, work):
    await database.run(accounts.add_operator, "Ada", Role.VIEWER, 1.0)
    with pytest.raises(AccessError, match="'Bob' is not known; known are: Ada"):
        await database.run(work)


async def test_a_robots_name_is_checked(database):
    with pytest.raises(MessageError, match="cannot be used"):
        await database.run(accounts.issue_robot_token, "r 1", 1.0)
    with pytest.raises(AccessError, match="has no token"):
        await database.run(accounts.revoke_robot_token, "r1", 1.0)


# --- the audit log --------------------------------------------------------------------------------------


async def written(database, **filters):
    return await database.run(lambda c: audit.newest_entries(c, 1000, **filters))


async def test_what_is_noted_is_written_in_order_and_found_again(database, clock):
    journal = AuditJournal(database, clock)
    for number in range(5):
        clock.advance(1)
        journal.note("Ada" if number % 2 else "Bob", f"step {number}", done=number != 3)
    await journal.flush()
    entries = await written(database)
    assert [entry.action for entry in entries] == [f"step {n}" for n in (4, 3, 2, 1, 0)]
    assert [entry.done for entry in entries] == [True, False, True, True, True]
    assert [e.action for e in await written(database, who="Ada")] == ["step 3", "step 1"]
    assert [e.action for e in await written(database, since=clock.wall - 1)] == ["step 4", "step 3"]
    assert [e.action for e in await written(database, before=entries[3].id)] == ["step 0"]


async def test_what_is_too_long_or_no_text_is_cut_and_not_lost(database):
    entry = AuditEntry(1.0, "x" * 500, "y" * 99, True, detail="z" * 10_000, subject="\ud800\0")
    await database.run(audit.add_entries, [entry])
    (found,) = await written(database)
    assert (len(found.who), len(found.action), len(found.detail)) == (128, 32, 2000)
    assert found.subject == "?�"


class Outage:
    """A database that can be away."""

    def __init__(self, database):
        self.database, self.away = database, False

    async def run(self, work, *arguments):
        if self.away:
            raise StoreError("away")
        return await self.database.run(work, *arguments)


async def test_what_is_noted_while_the_database_is_away_is_written_later(database, clock, monkeypatch):
    monkeypatch.setattr("robot_bridge.gateway.auth.audit.RETRY_AFTER", 0.01)
    outage = Outage(database)
    journal = AuditJournal(outage, clock)
    running = asyncio.create_task(journal.run())
    outage.away = True
    journal.note("Ada", "first")
    await asyncio.sleep(0.05)
    journal.note("Ada", "second")
    await asyncio.sleep(0.05)
    assert await written(database) == []
    outage.away = False
    await asyncio.sleep(0.2)
    running.cancel()
    assert [entry.action for entry in await written(database)] == ["second", "first"]


async def test_a_long_outage_costs_no_memory_and_the_oldest_are_counted_as_lost(
    database, monkeypatch, caplog
):
    monkeypatch.setattr("robot_bridge.gateway.auth.audit.LARGEST_BACKLOG", 10)
    journal = AuditJournal(database)
    for number in range(25):
        journal.note("Ada", str(number))
    await journal.flush()
    assert [int(entry.action) for entry in await written(database)] == list(range(24, 14, -1))
    assert "15 pieces of the audit log were lost" in caplog.text


async def test_one_piece_that_the_database_refuses_keeps_none_of_the_others_back(database, caplog):
    journal = AuditJournal(database)
    session = SessionRow("id", "Ada", None, "viewer", "here", 1.0)
    journal.note("Ada", "before")
    journal.began(session)
    journal.began(session)
    journal.note("Ada", "after")
    for _ in range(3):
        try:
            await journal.flush()
            break
        except StoreError:
            continue
    after, gap, before = await written(database)
    assert (after.action, before.action) == ("after", "before")
    assert (gap.who, gap.done) == ("gateway", False) and "an entry is missing here: database" in gap.detail
    assert "1 pieces of the audit log were lost" in caplog.text


async def test_on_a_full_disk_nothing_is_given_up(database, clock, caplog):
    """It can be read, and takes transactions that write nothing."""
    full = FullDisk(database)
    journal = AuditJournal(full, clock)
    for number in range(3):
        journal.note("Ada", str(number))
    for _ in range(5):
        with pytest.raises(StoreError):
            await journal.flush()
    full.has_room = True
    await journal.flush()
    assert [entry.action for entry in await written(database)] == ["2", "1", "0"]
    assert "lost" not in caplog.text


class FullDisk:
    """A database that takes no row until it has room."""

    def __init__(self, database):
        self.database, self.has_room = database, False
        self.refusals, self.has_room_after = 0, math.inf

    async def run(self, work, pieces):
        if pieces and not self.has_room and self.refusals < self.has_room_after:
            self.refusals += 1
            raise StoreError("database or disk is full")
        return await self.database.run(work, pieces)


async def test_what_a_full_disk_has_no_room_for_is_not_given_up_for_something_smaller(
    database, clock, caplog
):
    full = FullDisk(database)
    journal = AuditJournal(full, clock)
    journal.note("Ada", "sent")
    full.has_room_after = 2
    with pytest.raises(StoreError):
        await journal.flush()
    await journal.flush()
    assert [entry.action for entry in await written(database)] == ["sent"]
    assert "lost" not in caplog.text


async def test_a_disk_that_stays_full_is_told_to_the_log_once_a_minute(database, clock, caplog, monkeypatch):
    monkeypatch.setattr("robot_bridge.gateway.auth.audit.RETRY_AFTER", 0.0)
    full = FullDisk(database)
    journal = AuditJournal(full, clock)
    journal.note("Ada", "sent")
    running = asyncio.create_task(journal.run())
    while full.refusals < 9:
        await asyncio.sleep(0.001)
    running.cancel()
    assert caplog.text.count("the audit log is written later") == 1


async def test_a_piece_that_failed_while_the_database_came_back_is_written(database, clock, caplog):
    outage = Outage(database)
    journal = AuditJournal(outage, clock)
    journal.note("Ada", "sent")
    real, outage.run = outage.run, _failing_once(outage)
    await journal.flush()
    assert outage.run == real
    assert [entry.action for entry in await written(database)] == ["sent"]
    assert "lost" not in caplog.text


def _failing_once(outage):
    async def fail(_work, *_arguments):
        del outage.run
        raise StoreError("away")

    return fail


# --- sessions -------------------------------------------------------------------------------------------


async def test_an_ended_session_is_found_beside_one_that_is_only_taken_for_open(database):
    for id in ("aa11", "bb22"):
        await database.run(session_rows.begin_session, SessionRow(id, "Ada", None, "viewer", "here", 1.0))
    await database.run(session_rows.end_session, "aa", 2.0, "why")
    # The gateway does not hold bb22 open any more, whose end could not be written.
    assert await database.run(session_rows.ended_sessions, ["aa11"]) == {"aa11": "why"}
    assert await database.run(session_rows.ended_sessions, []) == {}


async def test_asking_for_ended_sessions_leaves_nothing_for_the_search_for_garbage(database):
    await database.run(session_rows.ended_sessions, ["aa11"])
    gc.collect()
    gc.disable()
    try:
        for _ in range(50):
            await database.run(session_rows.ended_sessions, ["aa11"])
        assert gc.collect() < 50
    finally:
        gc.enable()


async def test_a_session_can_be_ended_by_how_its_id_begins(database):
    for id in ("aa11", "aa22", "bb33"):
        await database.run(session_rows.begin_session, SessionRow(id, "Ada", None, "viewer", "here", 1.0))
    for id in ("aa", "", "cc", "%"):
        with pytest.raises(AccessError, match="sessions list"):
            await database.run(session_rows.end_session, id, 2.0, "why")
    await database.run(session_rows.end_session, "bb", 2.0, "why")
    assert await database.run(session_rows.ended_sessions, ["aa11", "aa22", "bb33"]) == {"bb33": "why"}
    with pytest.raises(AccessError):
        await database.run(session_rows.end_session, "bb33", 3.0, "again")
    left = await database.run(lambda c: session_rows.list_sessions(c, everything=False, limit=9))
    assert [session.id for session in left] == ["aa11", "aa22"]


async def test_what_an_earlier_gateway_left_open_is_ended_and_old_ones_are_forgotten(database):
    await database.run(session_rows.begin_session, SessionRow("aa", "Ada", None, "viewer", "here", 1.0))
    await database.run(session_rows.end_all_sessions, 5.0)
    (session,) = await database.run(lambda c: session_rows.list_sessions(c, everything=True, limit=9))
    assert (session.ended_at, session.reason) == (5.0, "the gateway ended")
    await database.run(session_rows.forget_ended_sessions, 6.0, 9)
    assert await database.run(lambda c: session_rows.list_sessions(c, everything=True, limit=9)) == []


async def test_a_gateway_that_starts_ends_no_session_of_another(database):
    """It takes all that are open for those that it left itself; the other gateway knows better."""
    for id in ("aa11", "bb22", "cc33"):
        await database.run(session_rows.begin_session, SessionRow(id, "Ada", None, "viewer", "here", 1.0))
    await database.run(session_rows.end_session, "bb22", 2.0, "the gateway ended")
    await database.run(session_rows.end_all_sessions, 5.0)
    # By hand a session is ended with whatever reason.
    ended = await database.run(session_rows.ended_sessions, ["aa11", "bb22"])
    assert ended == {"aa11": "the gateway ended", "bb22": "the gateway ended (by hand)"}
    await database.run(session_rows.reopen_sessions, ["aa11", "bb22"])
    left = await database.run(lambda c: session_rows.list_sessions(c, everything=False, limit=9))
    assert [(session.id, session.reason) for session in left] == [("aa11", None)]


async def test_who_reads_the_log_reads_what_has_just_happened(database):
    journal = AuditJournal(database)
    administration = AccountAdministration(database, journal)
    journal.began(SessionRow("0" * 32, "Ada", None, "operator", "127.0.0.1", 100.0))
    journal.note("Ada", "clear_emergency_stop", done=False)
    assert [session.operator for session in (await administration.sessions(GetSessions())).sessions] == [
        "Ada"
    ]
    journal.note("Ada", "abort_all")
    entries = (await administration.audit_log(GetAudit())).entries
    assert [entry.action for entry in entries] == ["abort_all", "clear_emergency_stop"]
