"""Algorithms in this QGIS, by Python or by a script's words, and ``qgis_process`` as a script starts it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sysconfig
from dataclasses import dataclass
from pathlib import Path

import pytest
from fleet_supervisor.robot_bridge.core.robotmap.binary import decode_text
from fleet_supervisor.robot_bridge.core.robotmap.model import RobotMap
from fleet_supervisor.robot_bridge.core.robotmap.text_format import read_text
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProject,
)

from tests.support.inside_qgis.processing_words import run_words

SEVERAL = Path(__file__).parents[2] / "support" / "inside_qgis" / "several_runs.py"
"""The script that has one ``qgis_process`` do several runs."""
INI = "[PythonPlugins]\nfleet_supervisor=true\nprocessing=true\n"


@dataclass(frozen=True)
class Export:
    """One finished export: its outputs, its file, and everything it said."""

    results: dict
    file: Path
    warnings: list[str]
    log: str

    @property
    def text(self) -> str:
        content = self.file.read_bytes()
        return decode_text(content) if content.startswith(b"RMAP") else content.decode()

    @property
    def map(self) -> RobotMap:
        return read_text(self.text)


class Listener(QgsProcessingFeedback):
    """Keeps what an algorithm says."""

    def __init__(self):
        super().__init__(False)
        self.warnings: list[str] = []
        self.infos: list[str] = []

    def pushWarning(self, warning):
        self.warnings.append(warning)

    def pushInfo(self, info):
        self.infos.append(info)


@pytest.fixture
def listener(qgis_app):
    """A feedback that keeps what is said."""
    return Listener()


@pytest.fixture
def fig_2(root) -> str:
    """The paper's Fig. 2, as the document for integrators prints it."""
    document = (root / "docs" / "robot-map.md").read_text(encoding="utf-8")
    return re.search(r"^```robotmap\n(.*?)^```$", document, re.MULTILINE | re.DOTALL)[1]


@pytest.fixture
def cancels_at(qgis_app):
    """Return a feedback that cancels when the progress reaches ``percent``."""

    def make(percent: float) -> Listener:
        listener = Listener()
        listener.progressChanged.connect(lambda value: listener.cancel() if value >= percent else None)
        return listener

    return make


@pytest.fixture(scope="module")
def provider(qgis_processing, registered_provider):
    """The provider, registered as the plugin registers it, and what runs its algorithms."""
    return registered_provider


@pytest.fixture
def export(provider, tmp_path):
    """Run the algorithm on ``layers`` by ``processing.run``, in an empty project unless given one."""
    import processing

    def run(*layers, feedback=None, project=None, **parameters) -> Export:
        listener = feedback or Listener()
        context = QgsProcessingContext()
        context.setProject(project or QgsProject())
        everything = {"OBSTACLES": list(layers), "OUTPUT": str(tmp_path / "map.txt"), **parameters}
        results = processing.run(
            "fleet:exportrobotmap", everything, context=context, feedback=listener, is_child_algorithm=True
        )
        return Export(results, Path(everything["OUTPUT"]), listener.warnings, "\n".join(listener.infos))

    return run


@dataclass(frozen=True)
class Finished:
    """A ``qgis_process`` that has ended."""

    status: int
    stdout: str
    stderr: str

    @property
    def said(self) -> str:
        return self.stdout + self.stderr

    @property
    def warnings(self) -> list[str]:
        return re.findall(r"WARNING:\s*(.*)", self.said)

    def result(self, name: str) -> float:
        return float(re.search(rf"^{name}:\s*(\S+)$", self.stdout, re.MULTILINE)[1])


@pytest.fixture
def run_for_cones(provider, listener):
    """Run an algorithm that makes cones, in a project in UTM 33 N, and return its outputs."""
    import processing

    project = QgsProject()

    def run(algorithm, **parameters):
        context = QgsProcessingContext()
        context.setProject(project)
        project.setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
        everything = {"CONES": "memory:", "FINDINGS": "memory:", **parameters}
        return processing.run(algorithm, everything, context=context, feedback=listener)

    return run


@pytest.fixture(scope="session")
def qgis_process_place(root, tmp_path_factory):
    """``qgis_process``, and the environment in which it has the plugin and no display."""
    program = shutil.which("qgis_process.bin") or shutil.which("qgis_process")
    assert program, "qgis_process is not on the path: run make setup"
    home = tmp_path_factory.mktemp("qgis_process")
    (home / "plugins").mkdir()
    (home / "plugins" / "fleet_supervisor").symlink_to(root)
    ini = home / "cfg" / "profiles" / "default" / "QGIS" / "QGIS3.ini"
    ini.parent.mkdir(parents=True)
    ini.write_text(INI, encoding="utf-8")
    scripts = ini.parents[1] / "processing" / "scripts"
    scripts.mkdir(parents=True)
    (scripts / SEVERAL.name).symlink_to(SEVERAL)
    (home / "run").mkdir(mode=0o700)
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "PYTHONPATH")}
    environment |= {
        "QT_QPA_PLATFORM": "offscreen",
        "XDG_RUNTIME_DIR": str(home / "run"),
        "QGIS_PLUGINPATH": str(home / "plugins"),
        "QGIS_CUSTOM_CONFIG_PATH": str(home / "cfg"),
    }
    return program, environment


@pytest.fixture(scope="session")
def qgis_process(qgis_process_place, root):
    """Run ``qgis_process`` with the plugin to its end."""
    program, environment = qgis_process_place

    def run(*words, packages=True) -> Finished:
        """``packages`` shows it the packages of this environment, such as zstandard."""
        paths = [str(root), *([sysconfig.get_path("purelib")] if packages else [])]
        done = subprocess.run(
            [program, *map(str, words)],
            env={**environment, "PYTHONPATH": os.pathsep.join(paths)},
            capture_output=True,
            text=True,
            timeout=240,
            check=False,
        )
        return Finished(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture(scope="module")
def by_words(provider):
    """Run what ``qgis_process`` is given as words inside this QGIS, where that shows the same."""

    def run(*words) -> Finished:
        done = run_words([str(word) for word in words])
        return Finished(done.status, done.results, done.said)

    return run


def _export_words(layers, parameters, file) -> list[str]:
    words = [f"OBSTACLES={layer}" for layer in layers]
    words += [f"{name}={value}" for name, value in parameters.items()]
    return ["run", "fleet:exportrobotmap", "--", *words, f"OUTPUT={file}"]


@pytest.fixture(scope="session")
def export_by_process(qgis_process, tmp_path_factory):
    """Run the algorithm by ``qgis_process``; ``layers`` are what QGIS calls sources."""

    def run(*layers, output="map.txt", **parameters) -> tuple[Finished, Path]:
        file = tmp_path_factory.mktemp("export") / output
        return qgis_process(*_export_words(layers, parameters, file)), file

    return run


@pytest.fixture(scope="module")
def export_by_words(by_words, tmp_path_factory):
    """Run the algorithm by the same words inside this QGIS."""

    def run(*layers, output="map.txt", **parameters) -> tuple[Finished, Path]:
        file = tmp_path_factory.mktemp("export") / output
        return by_words(*_export_words(layers, parameters, file)), file

    return run
