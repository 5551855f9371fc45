"""Several gateways on one database: leases, owners of robots, relayed requests."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0012"
down_revision = "0011"

Number: Any = sa.Double().with_variant(mysql.DOUBLE(asdecimal=False), "mysql", "mariadb")
Id = sa.BigInteger().with_variant(sa.Integer, "sqlite")
LongText = sa.Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
EXACT: dict[str, Any] = {
    "mysql_charset": "utf8mb4",
    "mysql_collate": "utf8mb4_bin",
    "mysql_engine": "InnoDB",
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Add the tables of gateways, of the owners of robots, and of relayed requests."""
    op.create_table(
        "gateways",
        sa.Column("gw", sa.String(32), primary_key=True),
        sa.Column("run", sa.String(32), nullable=False),
        sa.Column("version", sa.String(32), nullable=False),
        sa.Column("host", sa.String(255), nullable=False),
        sa.Column("process", sa.BigInteger, nullable=False),
        sa.Column("since", Number, nullable=False),
        sa.Column("lease_until", Number, nullable=False),
        **EXACT,
    )
    op.create_table(
        "robot_owners",
        sa.Column("robot", sa.String(63), primary_key=True),
        sa.Column("gw", sa.String(32), nullable=False),
        sa.Column("run", sa.String(32), nullable=False),
        sa.Column("fence", sa.BigInteger, nullable=False),
        **EXACT,
    )
    op.create_table(
        "relayed_requests",
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("method", sa.String(32), nullable=False),
        sa.Column("params", LongText, nullable=False),
        sa.Column("operator", sa.String(128), nullable=False),
        sa.Column("asked_by", sa.String(32), nullable=False),
        sa.Column("asked_at", Number, nullable=False),
        sa.Column("begun_by", sa.String(32), nullable=True),
        sa.Column("answer", LongText, nullable=True),
        sqlite_autoincrement=True,
        **EXACT,
    )


def downgrade() -> None:
    """Drop the tables: a sole gateway needs none of them."""
    for name in ("relayed_requests", "robot_owners", "gateways"):
        op.drop_table(name)
