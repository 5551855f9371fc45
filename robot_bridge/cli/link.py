"""``robot-bridge link KIND``: an adapter as a program."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from ..core.logs import LogFormat, LogLevel, set_up_server_log
from ..links.base.settings import kind_in
from ..links.kinds import KINDS, load
from .options import UntilStdinCloses

app = typer.Typer(
    help="Run an adapter: robots and trackers of another kind, over one connection.", no_args_is_help=True
)

Config = Annotated[Path, typer.Option(help="The link's settings, as links/NAME.toml.")]
Format = Annotated[
    LogFormat, typer.Option(help="Lines for people, or JSON.", envvar="ROBOT_BRIDGE_LOG_FORMAT")
]
Level = Annotated[LogLevel, typer.Option(help="The least that is logged.", envvar="ROBOT_BRIDGE_LOG_LEVEL")]
Check = Annotated[bool, typer.Option("--check", help="Only say whether the settings can be used.")]


def _running(kind: str | None) -> Callable[..., None]:
    def command(
        config: Config,
        check: Check = False,
        until_stdin_closes: UntilStdinCloses = False,
        log_format: Format = "text",
        log_level: Level = "warning",
    ) -> None:
        from ..links.base.process import run

        set_up_server_log(log_format, log_level)
        found = kind or kind_in(config)
        if check:
            settings, _ = load(found, config)
            typer.echo(f"{config}: link {settings.name} of kind {found} can be run")
            return
        run(partial(load, found, config), until_stdin_closes=until_stdin_closes)

    return command


app.command("run", help="Run the adapter of the kind that the settings name.")(_running(None))
for _kind, _found in KINDS.items():
    app.command(_kind, help=_found.help)(_running(_kind))
