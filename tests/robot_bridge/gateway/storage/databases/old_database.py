"""What `robot-bridge serve` of version 0.1.0 made, with a robot and its command in it."""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path

VERSION_0_1_0 = """
CREATE TABLE rr (id INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT, robot VARCHAR(63) NOT NULL,
    op VARCHAR(32) NOT NULL, params TEXT, payload BLOB,
    created_at DATETIME DEFAULT (CURRENT_TIMESTAMP) NOT NULL);
CREATE INDEX ix_rr_robot ON rr (robot);
CREATE TABLE sa (id INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT, robot VARCHAR(63) NOT NULL,
    op VARCHAR(32) NOT NULL, params TEXT, payload BLOB,
    created_at DATETIME DEFAULT (CURRENT_TIMESTAMP) NOT NULL);
CREATE INDEX ix_sa_robot ON sa (robot);
CREATE TABLE robots (name VARCHAR(63) NOT NULL, magic INTEGER NOT NULL, link VARCHAR(16) NOT NULL,
    received_at FLOAT NOT NULL, ended_in_order INTEGER NOT NULL, pose TEXT, pose_at FLOAT,
    PRIMARY KEY (name));
CREATE TABLE commands (id VARCHAR(64) NOT NULL, robot VARCHAR(63) NOT NULL, op VARCHAR(32) NOT NULL,
    params TEXT NOT NULL, operator VARCHAR(128) NOT NULL, state VARCHAR(16) NOT NULL, deviation FLOAT,
    sa_id INTEGER NOT NULL, created_at FLOAT NOT NULL, PRIMARY KEY (id));
CREATE INDEX ix_commands_created_at ON commands (created_at);
CREATE INDEX ix_commands_robot ON commands (robot);
CREATE INDEX ix_commands_state ON commands (state);
CREATE TABLE command_steps (id INTEGER NOT NULL PRIMARY KEY AUTOINCREMENT, command VARCHAR(64) NOT NULL,
    state VARCHAR(16) NOT NULL, at FLOAT NOT NULL, "by" VARCHAR(128) NOT NULL, reason TEXT);
CREATE INDEX ix_command_steps_command ON command_steps (command);
CREATE TABLE trajectories (id INTEGER NOT NULL, robot VARCHAR(63) NOT NULL, received_at FLOAT NOT NULL,
    x FLOAT NOT NULL, y FLOAT NOT NULL, theta FLOAT NOT NULL, v FLOAT NOT NULL, device_time FLOAT,
    PRIMARY KEY (id));
CREATE INDEX ix_trajectories_received_at ON trajectories (received_at);
CREATE INDEX ix_trajectories_robot ON trajectories (robot);
INSERT INTO robots VALUES ('r1', 7, 'websocket', 1000.0, 0, '{"x": 1, "y": 2, "theta": 0, "v": 0}', 1000.0);
INSERT INTO sa (id, robot, op, params) VALUES (41, 'r1', 'SetPosEnd', '{"x": 5, "y": 6, "cone": true}');
INSERT INTO sa (id, robot, op, params) VALUES (900, 'r1', 'Start', '{}');
DELETE FROM sa WHERE id = 900;
INSERT INTO commands VALUES ('command-1', 'r1', 'SetPosEnd', '{"x": 5, "y": 6, "cone": true}', 'Ada',
    'queued', NULL, 41, 1000.0);
INSERT INTO command_steps (command, state, at, "by") VALUES ('command-1', 'queued', 1000.0, 'Ada');
INSERT INTO trajectories VALUES (1, 'r1', 1000.0, 1.0, 2.0, 0.0, 0.0, NULL);
"""


def make_old(file: Path) -> None:
    """Make a database of version 0.1.0."""
    with contextlib.closing(sqlite3.connect(file)) as connection:
        connection.executescript(VERSION_0_1_0)
    # As whoever runs a gateway keeps it.
    file.chmod(0o600)
