"""Programs of others that tests and benchmarks use: made once in a cache folder, and kept."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

from tests.support.errors import StageError


def cached(name: str, make: Callable[[Path], None]) -> Path:
    """Return a folder of the cache; ``make`` fills it when it is not there, for all processes once."""
    caches = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = caches / "fleet-supervisor" / name
    folder.parent.mkdir(parents=True, exist_ok=True)
    with folder.with_name(f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "ready").exists():
            shutil.rmtree(folder, ignore_errors=True)
            try:
                make(folder)
            except BaseException:
                shutil.rmtree(folder, ignore_errors=True)
                raise
            (folder / "ready").touch()
    return folder


def run_peer(*command: str | Path) -> None:
    """Run a command that makes a peer, or is one; raises StageError with its last words where it fails."""
    words = [str(part) for part in command]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=900)
    if done.returncode != 0:
        said = "\n".join((done.stdout + done.stderr).splitlines()[-8:])
        raise StageError(f"a peer for tests and benchmarks: {' '.join(words)[:300]} failed:\n{said}")
