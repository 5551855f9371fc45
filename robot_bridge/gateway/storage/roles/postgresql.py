"""Accounts of PostgreSQL: row level security on RR and SA, and a view of SA for robots.

Robots insert into ``public.rr`` itself. They reach SA by the view ``for_robots.sa``, which comes first on
their search path: an account that may delete from a table may also lock it against everybody, including the
gateway, and the view's owner may not.
"""

from __future__ import annotations

from typing import Any

from sqlalchemy import text

from ..map_views import PostGisViews
from .role_manager import LIMITS, MOST_CONNECTIONS, STATEMENT_SECONDS, AccountError, RoleManager

_ALL = "using (true)"
_GATEWAYS_MAY = {
    "rr": {"select": _ALL, "delete": _ALL},
    "sa": {
        "select": _ALL,
        "insert": "with check (true)",
        "update": "using (true) with check (false)",
        "delete": _ALL,
    },
}
"""The tables whose rows a gateway may read, write and remove. In SA it locks rows for update, and changes
none."""
MOST_READERS, READING_SECONDS = 32, 60
"""Connections of an account that reads the views, and seconds that one of its statements may take."""
_VERSION = "robots' side of the fleet, version 2"
_SERVER_OWN = ("postgres", "public", "none")

# Functions open to everybody in any database, with the harm that a robot could do.
_TO_NOBODY = (
    "lo_creat",  # fill the disk
    "lo_create",
    "lo_from_bytea",
    "pg_logical_emit_message",
)
_OF_POSITIONS = "(make_trajectory_days|drop_trajectory_day|delete_old_positions)$"
"""Functions by which a gateway makes and drops the partitions of positions, which it does not own."""
_TO_GATEWAYS = "pg\\_(try\\_)?advisory\\_"  # hold a lock that a gateway wants


class PostgreSqlRoles(RoleManager):
    """Rights are granted on the tables; rows are separated by ``current_user``."""

    def robots_database(self) -> str:
        return self._scalar("select current_database()")

    def robots(self) -> list[str]:
        return self._names(_ROBOTS)

    def gateways(self) -> list[str]:
        return self._names(
            "select r.rolname from pg_class c, aclexplode(c.relacl) a join pg_roles r on r.oid = a.grantee "
            "where c.oid = 'public.rr'::regclass and a.privilege_type = 'DELETE' and a.grantee <> c.relowner"
        )

    def prepare(self) -> None:
        found = self._names(
            "select obj_description(oid, 'pg_namespace') from pg_namespace where nspname = 'for_robots'"
        )
        if found == [_VERSION]:
            return
        database = self.robots_database()
        self._check_database(database)
        if not found:
            self._all(
                _COMMON.format(
                    database=self._quoted(database),
                    reader=self._quoted(f"{database}_sa_reader"),
                    owner=self._quoted(self._owner()),
                    robots=_ROBOTS,
                    **LIMITS,
                ).split("\n\n")
            )
        version = _VERSION.replace("'", "''")
        self._all(_SUSPENSION.format(robots=_ROBOTS, version=version).split("\n\n"))
        if not found and self._is_superuser():
            self._close_what_everybody_may()

    def add_map_reader(self, name: str, password: str) -> None:
        """Create an account that may only read the views of the fleet.

        :raises AccountError: when the name is taken.
        :raises MapViewError: when there are no views.
        """
        self._check_name(name)
        self._refuse_taken(name)
        views = PostGisViews(self._connection)
        views.require()
        role, database = self._quoted(name), self._quoted(self.robots_database())
        self._make_role(name, password, f"connection limit {MOST_READERS}")
        self._all(
            [
                f"alter role {role} in database {database} set statement_timeout = '{READING_SECONDS}s'",
                f"grant connect on database {database} to {role}",
            ]
        )
        views.let_read(role)

    def renew_rights(self) -> None:
        if self._scalar("select count(*) from pg_namespace where nspname = 'for_robots'") != "0":
            self.prepare()
        for name in self.gateways():
            self._grant_tables(self._quoted(name))
            self._grant_routines(self._quoted(name))
            self._make_policies(name)

    def _exists(self, name: str) -> bool:
        found = self._connection.execute(text("select 1 from pg_roles where rolname = :name"), {"name": name})
        return found.first() is not None

    def _check_name(self, name: str) -> None:
        super()._check_name(name)
        if name in _SERVER_OWN or name.startswith("pg_"):
            raise AccountError(f"name {name!r} is PostgreSQL's own; choose another one")

    def _make_robot(self, name: str, password: str) -> None:
        role, database = self._quoted(name), self._quoted(self.robots_database())
        limits = {
            "search_path": "for_robots, public",
            "statement_timeout": f"'{STATEMENT_SECONDS}s'",
            "lock_timeout": f"'{STATEMENT_SECONDS}s'",
            "idle_in_transaction_session_timeout": f"'{STATEMENT_SECONDS}s'",
        }
        self._make_role(name, password, f"connection limit {MOST_CONNECTIONS}")
        self._all(
            [
                *(
                    f"alter role {role} in database {database} set {key} = {value}"
                    for key, value in limits.items()
                ),
                f"grant connect on database {database} to {role}",
                f"grant usage on schema public, for_robots to {role}",
                f"grant insert (robot, op, params, payload) on public.rr to {role}",
                f"grant select, delete on for_robots.sa to {role}",
            ]
        )

    def _drop_robot(self, name: str) -> None:
        role, database = self._quoted(name), self._quoted(self.robots_database())
        self._do(f"alter role {role} nologin")
        self._end_connections(name)
        self._delete_messages(name, "public")
        self._all(
            [
                f"revoke all on for_robots.sa from {role}",
                f"revoke all (robot, op, params, payload) on public.rr from {role}",
                f"revoke all on schema public, for_robots from {role}",
                f"revoke all on database {database} from {role}",
                f"drop role {role}",
            ]
        )

    def _set_password(self, name: str, password: str) -> None:
        self._do(f"alter role {self._quoted(name)} password '{self._scrambled(name, password)}'")

    def _end_connections(self, name: str) -> None:
        self._connection.execute(
            text("select pg_terminate_backend(pid, 5000) from pg_stat_activity where usename = :name"),
            {"name": name},
        )

    def _make_gateway(self, name: str, password: str) -> None:
        role, database = self._quoted(name), self._quoted(self.robots_database())
        self._make_role(name, password)
        self._do(f"grant connect, temporary on database {database} to {role}")
        self._do(f"grant usage on schema public, for_robots to {role}")
        self._grant_tables(role)
        self._grant_routines(role)
        for function in self._functions(_TO_GATEWAYS):
            if self._is_superuser():
                self._do(f"grant execute on function {function} to {role}")
        self._make_policies(name)

    def _make_policies(self, name: str) -> None:
        for table, kinds in _GATEWAYS_MAY.items():
            for kind, check in kinds.items():
                policy = self._quoted(f"gateway {kind} {name}"[:63])
                self._do(f"drop policy if exists {policy} on public.{table}")
                self._do(
                    f"create policy {policy} on public.{table} for {kind} to {self._quoted(name)} {check}"
                )

    def _grant_tables(self, role: str) -> None:
        self._all(
            [
                f"grant select, insert, update, delete on all tables in schema public to {role}",
                # pg_dump reads them, and the gateway's account may make backups.
                f"grant select on all sequences in schema public to {role}",
                f"revoke insert, update on public.rr from {role}",
                f"revoke update on public.sa from {role}",
                # The policy still prevents changes of rows; without the right none can be locked.
                f"grant update (urgent) on public.sa to {role}",
            ]
        )

    def _grant_routines(self, role: str) -> None:
        for routine in ("end_stuck(integer)", "blocking_robots(integer)", "suspend_robot(text, boolean)"):
            self._do(f"grant execute on function for_robots.{routine} to {role}")
        # Tables of an older version have none of these; its upgrade renews the rights.
        for function in self._functions(_OF_POSITIONS, "public"):
            self._do(f"grant execute on function {function} to {role}")

    def _make_role(self, name: str, password: str, *options: str) -> None:
        self._do(
            f"create role {self._quoted(name)} login nosuperuser nocreatedb nocreaterole noreplication "
            f"noinherit password '{self._scrambled(name, password)}' {' '.join(options)}"
        )

    def _close_what_everybody_may(self) -> None:
        names = "|".join(_TO_NOBODY)
        for function in [*self._functions(f"({names})$"), *self._functions(_TO_GATEWAYS)]:
            self._do(f"revoke execute on function {function} from public")
        # Triggers on robots' rows run as the owner of the tables.
        for function in self._functions(_TO_GATEWAYS):
            self._do(f"grant execute on function {function} to {self._quoted(self._owner())}")

    def _functions(self, pattern: str, schema: str = "pg_catalog") -> list[str]:
        return self._names(
            f"select oid::regprocedure::text from pg_proc where pronamespace = '{schema}'::regnamespace "  # nosec B608 # names of ours
            f"and proname ~ '^{pattern}'"
        )

    def _is_superuser(self) -> bool:
        return self._scalar("select rolsuper::text from pg_roles where rolname = current_user") == "true"

    def _owner(self) -> str:
        return self._scalar(
            "select tableowner from pg_tables where schemaname = 'public' and tablename = 'rr'"
        )

    def _scalar(self, query: str) -> str:
        return str(self._connection.exec_driver_sql(query).scalar_one())

    def _quoted(self, name: str) -> str:
        return self._connection.dialect.identifier_preparer.quote_identifier(name)

    def _scrambled(self, name: str, password: str) -> str:
        """Return the server's hash of the password: the password itself never gets into its log."""
        driver: Any = self._connection.connection.driver_connection
        scrambled: bytes = driver.pgconn.encrypt_password(password.encode(), name.encode(), b"scram-sha-256")
        return scrambled.decode()


_ROBOTS = """\
select r.rolname from pg_attribute t, aclexplode(t.attacl) a join pg_roles r on r.oid = a.grantee
where t.attrelid = 'public.rr'::regclass and t.attname = 'op' and a.privilege_type = 'INSERT'"""

_COMMON = """\
create role {reader} nologin

revoke all on database {database} from public

revoke all on schema public from public

create schema for_robots

revoke all on schema for_robots from public

alter table public.rr alter robot set default current_user

alter table public.rr
    add constraint rr_params_size check (octet_length(params) <= {params}),
    add constraint rr_payload_size check (octet_length(payload) <= {payload})

alter table public.rr enable row level security

alter table public.rr force row level security

alter table public.sa enable row level security

alter table public.sa force row level security

create policy robots_write on public.rr for insert with check (robot = current_user::text)

create policy owner_reads on public.rr for select to {owner} using (true)

create policy owner_deletes on public.rr for delete to {owner} using (true)

create policy owner_reads on public.sa for select to {owner} using (true)

create policy owner_writes on public.sa for insert to {owner} with check (true)

create policy owner_deletes on public.sa for delete to {owner} using (true)

create policy robots_read on public.sa for select to {reader} using (robot = current_user::text)

grant usage on schema public to {reader}

grant select on public.sa to {reader}

create view for_robots.sa with (security_barrier) as
    select id, robot, op, params, payload, created_at, urgent from public.sa where robot = current_user::text

grant usage, create on schema for_robots to {reader}

grant {reader} to current_user

alter view for_robots.sa owner to {reader}

revoke create on schema for_robots from {reader}

create function for_robots.delete_own_answer() returns trigger
    language plpgsql security definer set search_path = pg_catalog, pg_temp as $$
begin
    delete from public.sa where id = old.id and robot = session_user::text;
    if not found then
        return null;
    end if;
    return old;
end
$$

create trigger delete_own_answer instead of delete on for_robots.sa
    for each row execute function for_robots.delete_own_answer()

create function for_robots.refuse_too_much() returns trigger
    language plpgsql security definer
    set search_path = pg_catalog, pg_temp set enable_seqscan = off set jit = off as $$
begin
    if {waiting} <= (
        select count(*) from (select from public.rr where robot = session_user::text limit {waiting}) as w
    ) then
        raise exception '{waiting} requests wait already; write again when the gateway has read some'
            using errcode = 'configuration_limit_exceeded';
    end if;
    if new.payload is not null and {payloads} <= (
        select count(*) from public.rr where robot = session_user::text and payload is not null
    ) then
        raise exception '{payloads} images wait already; write again when the gateway has read some'
            using errcode = 'configuration_limit_exceeded';
    end if;
    return new;
end
$$

create trigger refuse_too_much before insert on public.rr
    for each row execute function for_robots.refuse_too_much()

create function for_robots.end_stuck(seconds integer) returns bigint
    language sql security definer set search_path = pg_catalog, pg_temp as $$
    select count(pg_terminate_backend(a.pid))
    from pg_stat_activity a
    where a.datname = current_database() and a.xact_start < clock_timestamp() - make_interval(secs => seconds)
        and a.usename in ({robots})
$$"""

_SUSPENSION = """\
create or replace function for_robots.blocking_robots(seconds integer) returns setof text
    language sql security definer set search_path = pg_catalog, pg_temp as $$
    select distinct a.usename::text
    from pg_stat_activity a join pg_locks l on l.pid = a.pid and l.locktype = 'transactionid' and l.granted
    where a.datname = current_database() and a.xact_start < clock_timestamp() - make_interval(secs => seconds)
        and a.usename in ({robots})
$$

create or replace function for_robots.suspend_robot(robot text, suspended boolean) returns void
    language plpgsql security definer set search_path = pg_catalog, pg_temp as $$
begin
    if robot in ({robots}) then
        execute format('alter role %I %s', robot, case when suspended then 'nologin' else 'login' end);
        if suspended then
            perform pg_terminate_backend(pid) from pg_stat_activity where usename = robot;
        end if;
    end if;
end
$$

revoke all on all functions in schema for_robots from public

comment on schema for_robots is '{version}'"""
