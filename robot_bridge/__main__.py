"""The command line: ``robot-bridge serve``, ``robot-bridge robot`` and all that looks after the two.

A command is imported when it is asked for: none waits for what only others need.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated

import typer

from .core.errors import BridgeError, RobotMapError, SiteError
from .core.logs import set_up_log

COMMANDS = {
    "database": "Make, upgrade and check the database.",
    "robots": "Who may connect as a robot.",
    "trajectories": "Where robots have been.",
    "placements": "Where cones were put down.",
    "operators": "Accounts of operators: their roles and tokens.",
    "links": "Accounts of links, which speak for many robots.",
    "sessions": "Connections of operators to the desk.",
    "tls": "Certificates for wss://.",
    "serve": "Serve one site to robots (/robot, and tables rr and sa) and to operators (/desk).",
    "doctor": "Check what a gateway needs on this computer, and say what to do.",
    "audit": "Print who did what, oldest first: when, who, role, from where, what, to what, done or refused.",
    "schemas": "Write the JSON Schema of every message, and the AsyncAPI document of all endpoints.",
    "link": "Run an adapter: robots and trackers of another kind, over one connection.",
    "robot": "Run the reference robot: a simulated body that speaks the protocol.",
    "experiment": "Drive a simulated robot that finds itself on its map, and tell how far it is off.",
}
"""The commands with what each says of itself: a group or a function of its name in a module of ``cli``."""
_IN_ACCOUNTS = ("robots", "operators", "links", "sessions")
"""The commands that are in one module; every other one has a module of its name."""


def command_line(arguments: Sequence[str]) -> typer.Typer:
    """Return the command line: with the command that ``arguments`` ask for, and the names of the others."""
    app = typer.Typer(
        help="The bridge between operators and robots.", no_args_is_help=True, pretty_exceptions_enable=False
    )
    app.callback()(_shared)
    # A shell that completes words asks for every name that there is.
    completing = any(name.endswith("_COMPLETE") for name in os.environ)
    for name, does in COMMANDS.items():
        if completing or name in arguments[:1]:
            _add(app, name)
        else:
            app.command(name, help=does)(_only_named)
    return app


def main() -> None:
    """Run the command line; what cannot be done is said in one line and ends with status 1."""
    set_up_log()
    try:
        command_line(sys.argv[1:])()
    except Exception as error:
        if not isinstance(error, _foreseen()):
            raise
        sys.exit(f"robot-bridge: {error}")


def _add(app: typer.Typer, name: str) -> None:
    module = import_module(f"{__package__}.cli.{'accounts' if name in _IN_ACCOUNTS else name}")
    command = getattr(module, "app", None) or getattr(module, name)
    if isinstance(command, typer.Typer):
        app.add_typer(command, name=name)
    else:
        app.command(name)(command)


def _print_version(print_it: bool) -> None:
    if print_it:
        from importlib.metadata import version

        print(version("fleet-supervisor-robot-bridge"))
        raise typer.Exit


def _shared(
    of_program: Annotated[
        bool,
        typer.Option("--version", help="Print the version and exit.", callback=_print_version, is_eager=True),
    ] = False,
) -> None:
    """Stand for what all commands share, which is this option."""


def _only_named() -> None:
    """Stand for a command that was not asked for."""


def _foreseen() -> tuple[type[Exception], ...]:
    """Return the families of errors whose text is for people."""
    from .core.messages.base import MessageError
    from .reference_robot.localisation.settings import ReferenceRobotError

    return (BridgeError, SiteError, RobotMapError, MessageError, ReferenceRobotError)


if __name__ == "__main__":
    main()
