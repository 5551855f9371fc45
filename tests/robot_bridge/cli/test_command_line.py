"""The command line names every command without importing it, and imports the one that is asked for."""

import importlib
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest
import tomllib
import typer

from robot_bridge import cli
from robot_bridge.__main__ import COMMANDS, command_line
from robot_bridge.core.errors import BridgeError

HEAVY = {"sqlalchemy", "websockets", "numpy", "robot_bridge.gateway.app", "robot_bridge.core.messages"}

RUN = """
import sys
from robot_bridge.__main__ import main
try:
    main()
finally:
    print(*sys.modules, file=sys.stderr)
"""


def imported_by(*words):
    """Return what a run of the program imports, and what it prints."""
    command = [sys.executable, "-c", RUN, *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    return set(done.stderr.split()), done.stdout


def test_the_help_of_all_imports_none_of_them():
    modules, text = imported_by("--help")
    assert modules & HEAVY == set()
    assert [name for name in COMMANDS if f" {name} " not in text] == []


def test_the_help_of_serve_waits_for_no_gateway():
    modules, text = imported_by("serve", "--help")
    assert modules & HEAVY == set()
    assert "--database" in text


@pytest.mark.parametrize("name", COMMANDS)
def test_what_a_command_says_of_itself_is_what_the_list_says(name):
    app = command_line([name])
    one = {group.name: group for group in app.registered_groups}.get(name)
    if one is None:
        (function,) = [command.callback for command in app.registered_commands if command.name == name]
        said = function.__doc__.strip().splitlines()[0]
    else:
        said = one.typer_instance.info.help
    assert said == COMMANDS[name]


def test_a_shell_that_completes_is_given_every_command_whole(monkeypatch):
    monkeypatch.setenv("_ROBOT_BRIDGE_COMPLETE", "complete_bash")
    app = command_line([])
    assert {"database", "robots"} <= {group.name for group in app.registered_groups}


def test_every_module_that_has_a_command_is_named():
    for module in pkgutil.iter_modules(cli.__path__):
        found = __import__(f"robot_bridge.cli.{module.name}", fromlist=["app"])
        if isinstance(getattr(found, "app", None), typer.Typer):
            assert module.name in COMMANDS


def test_what_there_is_not_is_said_with_a_status_of_2():
    command = [sys.executable, "-m", "robot_bridge", "databse"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 2
    assert "No such command 'databse'" in done.stderr


def test_the_version_is_that_of_the_project():
    project = tomllib.loads((Path(cli.__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
    modules, text = imported_by("--version")
    assert text.strip() == project["project"]["version"]
    assert modules & HEAVY == set()


@pytest.mark.parametrize("name", COMMANDS)
def test_no_help_has_lost_a_word_to_markup(name):
    """What stands in brackets is taken for a style, and dropped."""
    for text in help_texts(typer.main.get_command(command_line([name])).commands[name]):
        assert not re.search(r"\[[a-z]", text), text


def help_texts(command):
    yield command.help or ""
    yield from (parameter.help or "" for parameter in command.params)
    for inner in getattr(command, "commands", {}).values():
        yield from help_texts(inner)


@pytest.mark.parametrize(
    ("pose", "words"),
    [
        ("nan,0,0", "x is nan; give a number from"),
        ("0,-inf,0", "y is -inf"),
        ("0,0,inf", "theta is inf"),
        ("1e9,0,0", "x is 1000000000.0"),
        ("1,2", "not enough values"),
        ("1,2,east", "could not convert string to float: 'east'"),
    ],
)
def test_a_pose_that_is_none_starts_no_robot(pose, words):
    robot_commands = importlib.import_module("robot_bridge.cli.robot")
    with pytest.raises(BridgeError, match=re.escape(f"pose {pose!r} cannot be read (")) as caught:
        robot_commands._pose(pose)
    assert words in str(caught.value) and "write X,Y,THETA such as 10,20,1.57" in str(caught.value)
