"""Notifications of new rows for a gateway on PostgreSQL only while it dozes."""

from alembic import op

revision = "0006"
down_revision = "0005"

GATEWAY_DOZES = 0x666C656574
"""As in ``engines/postgresql.py``; a migration stays as it is."""
LOCKING = (
    "pg_try_advisory_xact_lock_shared(bigint)",
    "pg_try_advisory_lock(bigint)",
    "pg_advisory_unlock(bigint)",
)


def upgrade() -> None:
    """Have writers check whether the gateway dozes before they notify.

    Transactions that notify are committed one after the other, each waiting for the disk by itself: twenty
    robots were answered as slowly as one disk can write twenty times. A gateway that is awake polls. It holds
    the lock while it dozes; writers hold it shared to the end of the transaction, so that a gateway never
    begins to doze over a row without a notification.
    """
    if op.get_bind().dialect.name != "postgresql":
        return
    _let_the_owner_lock()
    awake = f"pg_try_advisory_xact_lock_shared({GATEWAY_DOZES})"
    body = f"begin if not {awake} then perform pg_notify('rr', ''); end if; return null; end"
    how = "returns trigger language plpgsql security definer set search_path = pg_catalog, pg_temp"
    op.execute(f"create or replace function notify_rr() {how} as $$ {body} $$")


def _let_the_owner_lock() -> None:
    """With robots' accounts, locking needs a grant: robots must not have it."""
    connection = op.get_bind()
    owner = connection.exec_driver_sql(
        "select tableowner from pg_tables where schemaname = 'public' and tablename = 'rr'"
    ).scalar_one()
    quoted = connection.dialect.identifier_preparer.quote_identifier(owner)
    for function in LOCKING:
        may = "select has_function_privilege(%s::name, %s, 'execute')"
        if not connection.exec_driver_sql(may, (owner, f"pg_catalog.{function}")).scalar_one():
            op.execute(f"grant execute on function pg_catalog.{function} to {quoted}")
