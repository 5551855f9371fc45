"""What is in the zip works in a QGIS that has nothing but itself."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from tests.support.fleet import start_gateway
from tests.support.processes import Processes
from tests.support.qgis import SETTINGS, program

ALONE = Path(__file__).with_name("alone_in_qgis.py")


@pytest.fixture
def bare_environment(unpacked, tmp_path) -> dict[str, str]:
    """An environment with the unpacked zip as the only plugin, a fresh profile, and no Python path."""
    ini = tmp_path / "profiles" / "default" / "QGIS" / "QGIS3.ini"
    ini.parent.mkdir(parents=True)
    ini.write_text(SETTINGS, encoding="utf-8")
    (tmp_path / "run").mkdir(mode=0o700)
    mine = {
        "QGIS_PLUGINPATH": str(unpacked),
        "QGIS_CUSTOM_CONFIG_PATH": str(tmp_path),
        "XDG_RUNTIME_DIR": str(tmp_path / "run"),
        "QT_QPA_PLATFORM": "offscreen",
    }
    kept = {name: os.environ[name] for name in ("HOME", "LANG") if name in os.environ}
    return {"PATH": "/usr/local/bin:/usr/bin:/bin", **kept, **mine}


def test_qgis_process_knows_the_algorithm_and_describes_it(bare_environment):
    described = subprocess.run(
        [program("qgis_process"), "help", "fleet:exportrobotmap"],
        env=bare_environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert described.returncode == 0, described.stdout[-2000:] + described.stderr[-2000:]
    assert "OBSTACLES" in described.stdout


def test_the_desk_connects_to_a_gateway_with_its_own_websockets(
    bare_environment, unpacked, stock_python, tmp_path
):
    with Processes(tmp_path / "logs") as processes:
        address = start_gateway(processes, tmp_path / "fleet.db")
        done = subprocess.run(
            [stock_python, "-I", ALONE, unpacked, f"{address}/desk"],
            env=bare_environment,
            capture_output=True,
            text=True,
            timeout=240,
            check=False,
        )
    assert done.returncode == 0, done.stdout + done.stderr
    told = json.loads(done.stdout.splitlines()[-1])
    assert told["library"] == "fleet_supervisor.plugin.vendor.websockets"
    assert told["library_file"].startswith(str(unpacked))
    assert told["phase"] == "CONNECTED"
    assert told["site"] == "sample"
    assert told["modules"] > 20


def test_every_module_is_there_that_the_plugin_imports(unpacked):
    """Imports inside functions, too: a module left out of the zip would fail only when it is used."""
    import grimp

    names = {
        ".".join(path.relative_to(unpacked).with_suffix("").parts).removesuffix(".__init__")
        for path in unpacked.rglob("*.py")
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(unpacked))
        patch.delitem(__import__("sys").modules, "fleet_supervisor", raising=False)
        graph = grimp.build_graph("fleet_supervisor", cache_dir=None)
    used = {
        imported
        for module in graph.modules
        if module.startswith("fleet_supervisor.plugin") and ".vendor" not in module
        for imported in graph.find_modules_directly_imported_by(module)
    }
    assert used <= names
    assert "fleet_supervisor.robot_bridge.core.messages.robots" in used
