"""``robot-bridge`` in this process: one of its own takes half a second to import what is here already."""

from __future__ import annotations

import contextlib
import io
import logging
import os
import subprocess
import sys
from collections.abc import Iterator
from unittest import mock

from robot_bridge.__main__ import main


def run_command(*words: object, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command line to its end; return its status and what it said, as a process would.

    ``env`` is added to the environment. For commands that do their work and end: what listens to signals or
    is to be killed needs a process.
    """
    arguments = ["robot-bridge", *map(str, words)]
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2))
    with (
        mock.patch.object(sys, "argv", arguments),
        mock.patch.dict(os.environ, env or {}),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        _log_as_it_was(),
    ):
        status = _status_of(main, err)
    texts = (stream.buffer.getvalue().decode("utf-8") for stream in (out, err))
    return subprocess.CompletedProcess(arguments, status, *texts)


def _status_of(program, err) -> int:
    try:
        program()
    except SystemExit as leaving:
        if leaving.code is None or isinstance(leaving.code, int):
            return leaving.code or 0
        print(leaving.code, file=err)
        return 1
    return 0


@contextlib.contextmanager
def _log_as_it_was() -> Iterator[None]:
    root, others = logging.getLogger(), [logging.getLogger(name) for name in ("websockets", "alembic")]
    handlers, levels = list(root.handlers), {one: one.level for one in (root, *others)}
    root.handlers.clear()
    try:
        yield
    finally:
        root.handlers[:] = handlers
        for one, level in levels.items():
            one.setLevel(level)
