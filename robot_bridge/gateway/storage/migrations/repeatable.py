"""Migrations that can be done again from their beginning, for MariaDB.

It commits each change of a table by itself: where a migration was cut short, what it had done stays and its
revision is not written down. So each change is made only where it is not there yet. PostgreSQL and SQLite
undo a migration that was cut short themselves.
"""

from __future__ import annotations

from typing import Any

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
