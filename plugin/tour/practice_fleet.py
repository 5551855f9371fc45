"""A gateway and three simulated robots as processes on this computer, for practice."""

from __future__ import annotations

import re
import time
from pathlib import Path

from qgis.PyQt.QtCore import (
    QObject,
    QProcess,
    QProcessEnvironment,
    QStandardPaths,
    QTemporaryDir,
    QTimer,
    pyqtSignal,
)

from ..ui.language import tr

ROOT = Path(__file__).parents[2]
SITE = ROOT / "resources" / "sample_site"
PROGRAM = "robot-bridge"
POSES = {"r1": "20,8,0", "r2": "48,84,0", "r3": "92,22,3.1416"}
"""Start position of each robot: x, y (metres) and theta (radians) in the sample site's frame."""
LISTENING = re.compile(r"listening on (ws://127\.0\.0\.1:\d+)")
PATIENCE_MS = 3000
"""Time that programs are given to end by themselves."""
KILLED_WITHIN_MS = 3000
"""Time that a busy system is given to end a program that was killed."""
WITH_QGIS = "--until-stdin-closes"
"""Makes a program end with its QGIS, even when that crashes."""


def find_program() -> str:
    """Return the path of robot-bridge: on PATH, or in the environment beside the plugin; empty for none."""
    beside = [str(ROOT / ".venv" / folder) for folder in ("bin", "Scripts")]
    return QStandardPaths.findExecutable(PROGRAM) or QStandardPaths.findExecutable(PROGRAM, beside)


def how_to_install() -> str:
    """Return the remedy where there is no robot-bridge."""
    return tr(
        "The practice fleet needs robot-bridge, which is not on this computer. In a terminal, in the "
        "project's folder: python3 -m venv gateway, then gateway/bin/pip install . and put gateway/bin on "
        "PATH; or make setup. Then restart QGIS. The tour can be read without it."
    )


class PracticeFleet(QObject):
    """Starts on loopback only, on a free port, with its database in a folder that is deleted with it."""

    ready = pyqtSignal(str)
    """The fleet is running; the URL of its desk."""
    failed = pyqtSignal(str)
    """It did not start, or one of its robots does not run: the reason, and the remedy."""

    def __init__(self, program: str | None = None, parent: QObject | None = None):
        super().__init__(parent)
        self.program = find_program() if program is None else program
        self.url = ""
        self._folder: QTemporaryDir | None = None
        self._processes: list[QProcess] = []
        self._gateway: QProcess | None = None
        self._output = ""

    @property
    def running(self) -> bool:
        """Whether it was started and has not been stopped."""
        return bool(self._processes)

    def start(self) -> None:
        """Start the gateway, then the robots; :attr:`ready` or :attr:`failed` signals the result.

        Where the gateway is running already, :attr:`ready` is emitted at once.
        """
        if self.running:
            if self.url:
                self.ready.emit(self.url)
            return
        if not self.program:
            self.failed.emit(how_to_install())
            return
        self._folder, self._output = QTemporaryDir(), ""
        database = f"sqlite:///{self._folder.filePath('fleet.db')}"
        gateway = self._gateway = self._process()
        gateway.readyReadStandardOutput.connect(self._read)
        gateway.finished.connect(self._ended)
        gateway.errorOccurred.connect(self._ended)
        words = ["serve", "--site", str(SITE), "--port", "0", "--database", database, WITH_QGIS]
        gateway.start(self.program, words)

    def stop(self) -> None:
        """End every process, in good order if it does so soon; does not wait for it."""
        if self._processes:
            _EndingProcesses(self._processes, self._folder, self)
        self._processes, self._folder, self._gateway, self.url = [], None, None, ""

    def remove(self) -> None:
        """End every process, and wait until all have ended."""
        self.stop()
        for ending in self.findChildren(_EndingProcesses):
            ending.wait()

    def _process(self) -> QProcess:
        process = QProcess(self)
        process.setProcessChannelMode(QProcess.ProcessChannelMode.MergedChannels)
        # QGIS's own Python may get its paths from these variables, which are wrong for another one.
        environment = QProcessEnvironment.systemEnvironment()
        for name in ("PYTHONHOME", "PYTHONPATH"):
            environment.remove(name)
        process.setProcessEnvironment(environment)
        self._processes.append(process)
        return process

    def _read(self) -> None:
        output = bytes(self._gateway.readAllStandardOutput()).decode("utf-8", "replace")
        if self.url:
            return
        self._output += output
        found = LISTENING.search(self._output)
        if found:
            self.url = f"{found.group(1)}/desk"
            # Before the robots: where one does not run, that is the last message.
            self.ready.emit(self.url)
            if self.running:
                self._start_robots(f"{found.group(1)}/robot")

    def _start_robots(self, url: str) -> None:
        for name, pose in POSES.items():
            robot = self._process()
            robot.setStandardOutputFile(QProcess.nullDevice())
            robot.setObjectName(name)
            robot.errorOccurred.connect(self._robot_not_started)
            robot.finished.connect(self._robot_failed)
            robot.start(self.program, ["robot", "--url", url, "--name", name, f"--pose={pose}", WITH_QGIS])

    def _robot_not_started(self, error: QProcess.ProcessError) -> None:
        # A program that crashes has finished as well, which reports it.
        if error == QProcess.ProcessError.FailedToStart:
            self._robot_failed()

    def _robot_failed(self, *_: object) -> None:
        robot = self.sender()
        assert isinstance(robot, QProcess)
        failed = robot.error() != QProcess.ProcessError.UnknownError
        why = robot.errorString() if failed else tr("it ended with code {code}", code=robot.exitCode())
        self.failed.emit(
            tr(
                "The practice robot {robot} does not run: {why}. Close the tour and start the practice fleet "
                "again; if that fails, see what {program} says by hand.",
                robot=robot.objectName(),
                why=why.rstrip("."),
                program=self.program,
            )
        )

    def _ended(self, *_: object) -> None:
        if self._gateway is None:
            return
        lines = self._output.strip().splitlines()
        why = lines[-1] if lines else self._gateway.errorString()
        self.stop()
        self.failed.emit(
            tr(
                "The practice fleet ended: {why}. Start it again; if that fails, see what {program} says "
                "by hand.",
                why=why.rstrip("."),
                program=self.program,
            )
        )


class _EndingProcesses(QObject):
    """Ends ``processes``: their standard input is closed, and after a while they are killed.

    The ``folder`` that they use is deleted when the last one has ended.
    """

    def __init__(self, processes: list[QProcess], folder: QTemporaryDir | None, parent: QObject):
        super().__init__(parent)
        self._processes, self._folder = processes, folder
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.timeout.connect(self._kill)
        self._patience.start(PATIENCE_MS)
        for process in processes:
            process.disconnect()
            process.setParent(self)
            process.stateChanged.connect(self._forget_ended)
            process.closeWriteChannel()
        self._forget_ended()

    def wait(self) -> None:
        """Wait until all have ended; those that have not soon are killed."""
        until = time.monotonic() + PATIENCE_MS / 1000
        for process in self._processes:
            process.waitForFinished(max(0, round(1000 * (until - time.monotonic()))))
        self._kill()
        for process in self._processes:
            process.waitForFinished(KILLED_WITHIN_MS)
        self._forget_ended()

    def _kill(self) -> None:
        for process in self._processes:
            process.kill()

    def _forget_ended(self, *_: object) -> None:
        if all(process.state() == QProcess.ProcessState.NotRunning for process in self._processes):
            self._patience.stop()
            self._folder = None
            self.deleteLater()
