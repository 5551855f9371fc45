"""Run the migrations on the program's open connection and transaction.

MariaDB commits each change of a table by itself: the changes of an interrupted migration stay, and its
revision is not stored. So each must be repeatable from its beginning. PostgreSQL and SQLite roll back an
interrupted migration themselves.
"""

from __future__ import annotations

from typing import Any

from alembic import context
from alembic.ddl.base import AddColumn
from alembic.ddl.mysql import MariaDBImpl
from sqlalchemy.schema import CreateIndex, CreateTable, DropIndex


class RepeatableMariaDB(MariaDBImpl):
    """Alembic on MariaDB with repeatable statements (``if exists``, ``if not exists``).

    Alembic uses the class defined last for a dialect.
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
