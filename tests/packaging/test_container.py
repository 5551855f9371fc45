"""The container's recipe: what it copies is there, what it starts is what the guide and the service say."""

from __future__ import annotations

import json
import re
import shlex

import pytest
import tomllib
from typer.testing import CliRunner

from robot_bridge.__main__ import COMMANDS, command_line


@pytest.fixture(scope="module")
def steps(root) -> list[tuple[str, str]]:
    """The instructions with what follows them, a line each."""
    text = (root / "Containerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return [(line.split()[0], line.split(maxsplit=1)[1]) for line in lines]


def of(steps, instruction):
    return [rest for name, rest in steps if name == instruction]


def test_everything_that_is_copied_is_there_and_not_ignored(root, steps):
    copied = {
        name
        for rest in of(steps, "COPY")
        if not rest.startswith("--from=")
        for name in shlex.split(rest)[:-1]
    }
    assert copied >= {"pyproject.toml", "robot_bridge"}
    assert [name for name in copied if not (root / name).exists()] == []
    ignored = (root / ".containerignore").read_text(encoding="utf-8").splitlines()
    assert {line[1:] for line in ignored if line.startswith("!")} == copied


def test_the_extras_are_those_of_the_service(root, steps):
    (installed,) = (rest for rest in of(steps, "RUN") if "pip install" in rest)
    extras = re.search(r"\[(.+)\]", installed).group(1)
    assert f"[{extras}]" in (root / "tools" / "service.sh").read_text(encoding="utf-8")
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(extras.split(",")) <= set(project["optional-dependencies"])


def test_it_runs_as_somebody_else_than_root(steps):
    (user,) = of(steps, "USER")
    assert user == "robot-bridge"
    assert any("useradd --system --uid 990 " in rest and rest.endswith(user) for rest in of(steps, "RUN"))
    instructions = [name for name, _ in steps]
    assert instructions.index("USER") > max(
        at for at, name in enumerate(instructions) if name in ("RUN", "COPY")
    )


def test_what_it_starts_and_asks_is_there(steps):
    (entry,), (command,), (health,) = (of(steps, name) for name in ("ENTRYPOINT", "CMD", "HEALTHCHECK"))
    assert json.loads(entry) == ["robot-bridge"]
    assert json.loads(command) == ["serve"]
    (port,) = of(steps, "EXPOSE")
    shown = CliRunner().invoke(command_line(["serve"]), ["serve", "--help"], env={"COLUMNS": "200"}).stdout
    assert f"({port})" in shown
    assert health.count(f"127.0.0.1:{port}/healthz") == 2


def test_its_settings_are_those_of_the_service(root, steps):
    (text,) = of(steps, "ENV")
    settings = dict(word.split("=", 1) for word in shlex.split(text))
    lines = (root / "resources" / "service" / "robot-bridge.service").read_text(encoding="utf-8")
    for name in (
        "ROBOT_BRIDGE_DATABASE",
        "MALLOC_MMAP_THRESHOLD_",
        "MALLOC_TRIM_THRESHOLD_",
        "PYTHONUNBUFFERED",
    ):
        assert f"{name}={settings[name]}" in lines
    (volumes,) = of(steps, "VOLUME")
    assert {settings["ROBOT_BRIDGE_SITE"], settings["ROBOT_BRIDGE_STATE"]} == set(json.loads(volumes))


def test_the_guide_names_its_file_and_folders(root, steps):
    guide = (root / "docs" / "install.md").read_text(encoding="utf-8")
    commands = [shlex.split(line) for line in re.findall(r"^    (podman .+)$", guide, re.MULTILINE)]
    build, *runs = commands
    assert (root / build[build.index("--file") + 1]).is_file()
    (volumes,) = of(steps, "VOLUME")
    mounted = {word.partition(":")[2] for run in runs for word in run if re.match(r"[./\w-]+:/", word)}
    assert mounted == set(json.loads(volumes))
    image = build[build.index("--tag") + 1]
    asked = {run[run.index(image, run.index("--volume") + 2) + 1] for run in runs if run[-1] != image}
    assert asked <= set(COMMANDS)
