"""Links that speak for many robots, and the abilities that robots declared in Ready."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0009"
down_revision = "0008"

Number: Any = sa.Double().with_variant(mysql.DOUBLE(asdecimal=False), "mysql", "mariadb")
EXACT: dict[str, Any] = {
    "mysql_charset": "utf8mb4",
    "mysql_collate": "utf8mb4_bin",
    "mysql_engine": "InnoDB",
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Add the table of links, and the column of abilities."""
    op.create_table(
        "links",
        sa.Column("name", sa.String(16), primary_key=True),
        sa.Column("robots", sa.Text, nullable=False),
        sa.Column("created_at", Number, nullable=False),
        **EXACT,
    )
    op.add_column("robots", sa.Column("abilities", sa.String(128), nullable=True))
