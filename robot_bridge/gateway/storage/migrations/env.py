"""Runs the migrations on the connection, and in the transaction, that the program has opened.

MariaDB commits each change of a table by itself: where a migration was cut short, what it had done stays and
its revision is not written down. So it has to be possible to do each again from its beginning. PostgreSQL and
SQLite undo a migration that was cut short themselves.
"""

from __future__ import annotations

from typing import Any

from alembic import context
from alembic.ddl.base import AddColumn
from alembic.ddl.mysql import MariaDBImpl
from sqlalchemy.schema import CreateIndex, CreateTable, DropIndex


class RepeatableMariaDB(MariaDBImpl):
    """What Alembic does on MariaDB, each statement in its form for what may be there, or gone, already.

    Alembic takes the class that was defined last for a dialect.
    """

    __dialect__ = "mariadb"

    def _exec(self, construct: Any, *arguments: Any, **options: Any) -> Any:
        if isinstance(construct, (CreateTable, CreateIndex, AddColumn)):
            construct.if_not_exists = True
        elif isinstance(construct, DropIndex):
            construct.if_exists = True
        return super()._exec(construct, *arguments, **options)


context.configure(connection=context.config.attributes["connection"])
context.run_migrations()
