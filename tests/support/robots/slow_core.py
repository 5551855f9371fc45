"""A processor core that does only a part of its work: a control group of Linux with a quota of time."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.support.errors import StageError

QUOTA_US = 1000
"""The least that Linux allows; it comes so often that work is slow all the time, not held up now and then."""
_FIRST, _SECOND = Path("/sys/fs/cgroup/cpu"), Path("/sys/fs/cgroup")


@contextmanager
def slow_core(share: float) -> Iterator[Path]:
    """Give the file of a control group with a ``share`` of one core: a process that writes 0 there is in it.

    :raises StageError: where this process may not make control groups.
    """
    period = round(QUOTA_US / share)
    try:
        if (_FIRST / "cpu.cfs_quota_us").is_file():
            group = _FIRST / f"fleet-slow-core-{os.getpid()}"
            group.mkdir()
            (group / "cpu.cfs_period_us").write_text(str(period))
            (group / "cpu.cfs_quota_us").write_text(str(QUOTA_US))
        else:
            group = _SECOND / f"fleet-slow-core-{os.getpid()}"
            group.mkdir()
            (group / "cpu.max").write_text(f"{QUOTA_US} {period}")
    except OSError as error:
        raise StageError(f"no control group can be made ({error}); run as root") from error
    try:
        yield group / "cgroup.procs"
    finally:
        group.rmdir()
