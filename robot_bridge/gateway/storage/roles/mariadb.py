"""Accounts of MariaDB: robots see only a database of their own with the views ``rr`` and ``sa``.

The views belong to a locked account, and separate rows by ``user()``, the connected account;
``current_user()`` would be the locked account. A trigger writes the robot's name into its requests.

A robot's own condition may be tried on other robots' rows before the view's, and a warning such as *Truncated
incorrect INTEGER value: ...* would reveal their contents. So the view of SA shows only the id of another
robot's row. It is also forced to use the index on ``robot``, which MariaDB 11 ignores in a DELETE.

A trigger locks the rows that it reads, and waits for those locked by others. So the one that counts a robot's
requests is forced to use that index, too, which has only the robot's own rows: many deleted rows that are not
purged yet make MariaDB read the whole table, and every robot wait for all others that are writing.
"""

from __future__ import annotations

import hashlib

from sqlalchemy import text

from .role_manager import LIMITS, MOST_CONNECTIONS, STATEMENT_SECONDS, AccountError, RoleManager

_VERSION = "robots' side of the fleet, version 4"
_SERVER_OWN = (
    "root",
    "mysql",
    "mariadb.sys",
    "public",
    "none",
    "current_user",
    "current_role",
    "session_user",
)
_ROUTINES = (
    "procedure {}.end_stuck_robots",
    "function {}.forsaken",
    "procedure {}.blocking_robots",
    "procedure {}.suspend_robot",
)
"""Routines that a gateway may call."""
_NOT_GATEWAYS = {"rr": "select, delete", "sa": "select, insert, delete"}


class MariaDbRoles(RoleManager):
    """Robots may connect from any host; TLS and the firewall restrict that."""

    def robots_database(self) -> str:
        return f"{self._database()}_robots"

    def robots(self) -> list[str]:
        return self._names(
            f"select User from mysql.tables_priv where Db = {self._text(self.robots_database())} "
            "and Table_name = 'sa'"  # nosec B608 # quoted
        )

    def gateways(self) -> list[str]:
        # An account that owns only the database may run this too, and sees no other account.
        keeper = f"'{self._keeper()}'@'localhost'"
        return self._names(
            "select substring_index(trim(leading '\\'' from grantee), '\\'@', 1) "  # nosec B608 # quoted
            f"from information_schema.table_privileges where table_schema = {self._text(self._database())} "
            f"and table_name = 'rr' and privilege_type = 'DELETE' and grantee <> {self._text(keeper)}"
        )

    def prepare(self) -> None:
        if self._prepared() == [_VERSION]:
            return
        self._check_database(self._database())
        # Definitions are committed at once here: repeated after a failure they must succeed.
        self._all(
            _COMMON.format(
                base=self._quoted(self._database()),
                side=self._quoted(self.robots_database()),
                side_text=self._text(self.robots_database()),
                keeper=f"{self._text(self._keeper())}@'localhost'",
                me="substring_index(user(), '@', 1)",
                version=_VERSION.replace("'", "''"),
                before_waiting=LIMITS["waiting"] - 1,
                before_payloads=LIMITS["payloads"] - 1,
                **LIMITS,
            ).split("\n\n")
        )

    def renew_rights(self) -> None:
        if self._prepared():
            self.prepare()
        for name in self.gateways():
            self._grant_tables(self._account(name))
            if self._prepared():
                self._all(self._routine_grants(self._account(name)))

    def _prepared(self) -> list[str]:
        """Return the version of the robots' database, empty without one."""
        side = self._text(self.robots_database())
        return self._names(
            f"select schema_comment from information_schema.schemata where schema_name = {side}"  # nosec B608 # names of ours
        )

    def _exists(self, name: str) -> bool:
        found = self._connection.execute(text("select 1 from mysql.user where User = :name"), {"name": name})
        return found.first() is not None

    def _check_name(self, name: str) -> None:
        super()._check_name(name)
        if name.lower() in _SERVER_OWN:
            raise AccountError(f"name {name!r} is MariaDB's own; choose another one")
        for known in self.robots():
            if known != name and known.lower() == name.lower():
                raise AccountError(
                    f"robot {known!r} has an account already, and MariaDB takes {name!r} for the same robot; "
                    "choose a name that differs in more than capital letters"
                )

    def _make_robot(self, name: str, password: str) -> None:
        account, side = self._account(name), self._quoted(self.robots_database())
        self._make_user(
            account,
            password,
            f"with max_user_connections {MOST_CONNECTIONS} max_statement_time {STATEMENT_SECONDS}",
            f"grant insert (robot, op, params, payload) on {side}.rr to {account}",
            f"grant select, delete on {side}.sa to {account}",
        )

    def _drop_robot(self, name: str) -> None:
        self._do(f"alter user {self._account(name)} account lock")
        self._end_connections(name)
        self._delete_messages(name, self._quoted(self._database()))
        self._do(f"drop user {self._account(name)}")

    def _set_password(self, name: str, password: str) -> None:
        self._do(f"alter user {self._account(name)} {_identified(password)}")

    def _end_connections(self, name: str) -> None:
        self._do(f"kill soft user {self._account(name)}")

    def _make_gateway(self, name: str, password: str) -> None:
        account = self._account(name)
        self._make_user(account, password, "", *self._routine_grants(account))
        self._grant_tables(account)

    def _routine_grants(self, account: str) -> list[str]:
        base = self._quoted(self._database())
        return [f"grant execute on {routine.format(base)} to {account}" for routine in _ROUTINES]

    def _make_user(self, account: str, password: str, options: str, *grants: str) -> None:
        self._do(f"create user {account} {_identified(password)} {options}")
        try:
            self._all(grants)
        except BaseException:
            self._do(f"drop user {account}")
            raise

    def _grant_tables(self, account: str) -> None:
        base = self._quoted(self._database())
        tables = self._names(
            "select table_name from information_schema.tables where table_type = 'BASE TABLE' "
            f"and table_schema = {self._text(self._database())}"  # nosec B608 # quoted
        )
        for table in tables:
            rights = _NOT_GATEWAYS.get(table, "select, insert, update, delete")
            self._do(f"grant {rights} on {base}.{self._quoted(table)} to {account}")

    def _database(self) -> str:
        return str(self._connection.engine.url.database)

    def _keeper(self) -> str:
        return f"{self._database()}_keeper"

    def _account(self, name: str) -> str:
        return f"{self._text(name)}@'%'"

    def _quoted(self, name: str) -> str:
        return "`" + name.replace("`", "``") + "`"

    def _text(self, value: str) -> str:
        return "'" + value.replace("\\", "\\\\").replace("'", "''") + "'"


def _identified(password: str) -> str:
    """Return the clause with the server's hash of the password, which itself never gets into a log."""
    once = hashlib.sha1(password.encode()).digest()  # nosec B324 # the server's own form
    return f"identified via mysql_native_password using '*{hashlib.sha1(once).hexdigest().upper()}'"  # nosec B324 # as MariaDB has it


_COMMON = """\
create or replace user {keeper} identified via mysql_native_password using 'invalid' account lock

grant select, insert, update, trigger on {base}.rr to {keeper}

grant select, delete on {base}.sa to {keeper}

grant process, connection admin, create user on *.* to {keeper}

grant select on mysql.tables_priv to {keeper}

alter table {base}.rr
    add constraint if not exists rr_params_size check (params is null or octet_length(params) <= {params}),
    add constraint if not exists rr_payload_size check (payload is null or octet_length(payload) <= {payload})

create or replace definer = {keeper} trigger {base}.rr_of_whom before insert on {base}.rr for each row
begin
    if new.robot is not null and binary new.robot <> binary {me} then
        signal sqlstate '42000' set mysql_errno = 1142,
            message_text = 'a robot writes under its own name only';
    end if;
    set new.robot = {me};
    if exists (
        select 1 from {base}.rr force index (ix_rr_robot) where robot = {me} limit {before_waiting}, 1
    ) then
        signal sqlstate '45000' set
            message_text = '{waiting} requests wait already; write again when the gateway has read some';
    end if;
    if new.payload is not null and exists (
        select 1 from {base}.rr force index (ix_rr_robot) where robot = {me} and payload is not null
        limit {before_payloads}, 1
    ) then
        signal sqlstate '45000' set
            message_text = '{payloads} images wait already; write again when the gateway has read some';
    end if;
end

create database if not exists {side}

create or replace definer = {keeper} sql security definer view {side}.rr as
    select robot, op, params, payload from {base}.rr where robot = {me} and binary robot = binary {me}

create or replace definer = {keeper} sql security definer view {side}.sa as
    select id,
        if(binary robot = binary {me}, robot, null) as robot,
        if(binary robot = binary {me}, op, null) as op,
        if(binary robot = binary {me}, params, null) as params,
        if(binary robot = binary {me}, payload, null) as payload,
        if(binary robot = binary {me}, created_at, null) as created_at,
        if(binary robot = binary {me}, urgent, null) as urgent
    from {base}.sa force index (ix_sa_robot) where robot = {me} and binary robot = binary {me}

create or replace definer = {keeper} procedure {base}.end_stuck_robots(seconds int) sql security definer
begin
    declare continue handler for 1094 begin end;
    for stuck in (
        select p.id from information_schema.processlist p
        left join information_schema.innodb_trx t on t.trx_mysql_thread_id = p.id
        join mysql.tables_priv g on g.User = p.user and g.Db = {side_text} and g.Table_name = 'sa'
        where t.trx_started <= now() - interval seconds second
            or (p.command in ('Query', 'Execute') and p.time >= seconds)
    ) do
        kill connection stuck.id;
    end for;
end

grant execute on procedure {base}.end_stuck_robots to {keeper}

create or replace definer = {keeper} function {base}.forsaken(seconds int) returns int
    reads sql data sql security definer
    return (
        select count(*) from information_schema.innodb_trx
        where trx_mysql_thread_id = 0 and trx_started <= now() - interval seconds second
    )

grant execute on function {base}.forsaken to {keeper}

create or replace definer = {keeper} procedure {base}.blocking_robots(seconds int) sql security definer
    select distinct p.user from information_schema.processlist p
    join information_schema.innodb_trx t on t.trx_mysql_thread_id = p.id and t.trx_rows_locked > 0
    join mysql.tables_priv g on g.User = p.user and g.Db = {side_text} and g.Table_name = 'sa'
    where t.trx_started <= now() - interval seconds second

grant execute on procedure {base}.blocking_robots to {keeper}

create or replace definer = {keeper} procedure {base}.suspend_robot(robot varchar(128), suspended bool)
    sql security definer
begin
    declare continue handler for 1094 begin end;
    if exists (
        select 1 from mysql.tables_priv g where g.User = robot and g.Db = {side_text} and g.Table_name = 'sa'
    ) then
        execute immediate
            concat('alter user ', quote(robot), '@''%'' account ', if(suspended, 'lock', 'unlock'));
        if suspended then
            for own in (select p.id from information_schema.processlist p where p.user = robot) do
                kill connection own.id;
            end for;
        end if;
    end if;
end

grant execute on procedure {base}.suspend_robot to {keeper}

alter database {side} comment '{version}'"""
