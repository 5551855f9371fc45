"""``qgis_process`` as a script starts it, with what each run costs."""

from __future__ import annotations

import os
import re
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tests.support.errors import StageError
from tests.support.qgis import Profile, program


class Run(NamedTuple):
    """What one run took in seconds and in MB at most, and everything that it said."""

    cpu: float
    wall: float
    megabytes: float
    said: str

    @property
    def warnings(self) -> list[str]:
        """What QGIS printed as warnings."""
        return re.findall(r"WARNING:\t(.*)", self.said)


class QgisProcess:
    """A QGIS profile with the plugin as it lies in the repository, and no display."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        profile = Profile(folder / "qgis", link=True)
        self._environment = {
            **{name: value for name, value in os.environ.items() if name not in ("DISPLAY", "PYTHONPATH")},
            **profile.environment(packages=True),
            "QT_QPA_PLATFORM": "offscreen",
        }

    def run(self, *words: str) -> Run:
        """Return what the command ``qgis_process`` with ``words`` took, once it has ended.

        :raises StageError: with what it said, when it failed.
        """
        said = self._folder / "said.txt"
        start = time.perf_counter()
        with said.open("wb") as file:
            process = subprocess.Popen(
                [program("qgis_process"), *words],
                stdout=file,
                stderr=subprocess.STDOUT,
                env=self._environment,
            )
            _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        text = said.read_text(encoding="utf-8", errors="replace")
        if process.returncode:
            raise StageError(f"qgis_process {' '.join(words)} failed ({process.returncode}):\n{text}")
        return Run(used.ru_utime + used.ru_stime, wall, used.ru_maxrss / 1000, text)


@contextmanager
def qgis_process() -> Iterator[QgisProcess]:
    """Give a ``qgis_process`` with a profile of its own, which is gone afterwards."""
    with TemporaryDirectory(prefix="fleet-qgis-process-") as folder:
        yield QgisProcess(Path(folder))
