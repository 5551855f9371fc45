"""``robot-bridge experiment``: the first paper's drives, repeated on a published site."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import BridgeError
from .options import SiteOption, database_address, site_folder

if TYPE_CHECKING:
    from ..reference_robot.localisation.experiment import Record
    from .served_experiment import ServedDrives


def experiment(
    context: typer.Context,
    name: Annotated[
        str,
        typer.Argument(help="a5-loop, open-square, kidnapped, parking, from-nothing, or a file."),
    ],
    site: SiteOption,
    seeds: Annotated[int, typer.Option(help="How many drives, each in another world.", min=1, max=1000)] = 10,
    first_seed: Annotated[int, typer.Option(help="The seed of the first one.", min=0)] = 1,
    output: Annotated[
        Path | None, typer.Option(help="Folder for the table (CSV) and a plot (SVG) of each drive.")
    ] = None,
    gateway: Annotated[
        bool, typer.Option("--gateway", help="Drive at a real gateway, over WebSocket, sent by an operator.")
    ] = False,
    database: Annotated[
        str | None,
        typer.Option(help="With --gateway: where positions are stored. NAME.db in --output unless given."),
    ] = None,
    at_once: Annotated[
        bool, typer.Option("--at-once", help="With --gateway: all robots together, spread along the route.")
    ] = False,
    people: Annotated[
        int, typer.Option(help="With --gateway: how many people walk along the route.", min=0, max=1000)
    ] = 0,
    pace: Annotated[
        float, typer.Option(help="With --gateway: times as fast as the clock, at most.", min=0.1, max=1000)
    ] = 20.0,
    window: Annotated[
        float | None,
        typer.Option(help="With --gateway: its maps have so many metres a side.", min=40, max=10_000),
    ] = None,
    world: Annotated[
        Path | None,
        typer.Option(
            help="With --gateway: published site that the world is made of, where --site lacks things."
        ),
    ] = None,
    accept: Annotated[
        bool,
        typer.Option(
            "--accept",
            help="With --gateway: an operator accepts all that a robot reports, and it drives once more.",
        ),
    ] = False,
    reporter: Annotated[
        str | None,
        typer.Option(
            help="With --accept: NAME of what the robot is set to that reports; itself unless given."
        ),
    ] = None,
    numpy: Annotated[bool, typer.Option("--numpy", help="Cast rays by numpy even where numba is.")] = False,
) -> None:
    """Drive a simulated robot that finds itself on its map, and tell how far it is off."""
    from ..core.sites.site import read_site
    from ..reference_robot.localisation import experiment as drives
    from ..reference_robot.localisation.experiment_plot import svg_of
    from ..reference_robot.localisation.experiment_report import csv_text, figures, table_text
    from .served_experiment import drive_at_gateway

    file = _settings_file(name)
    settings = drives.read_settings(file)
    if (world is not None or accept) and not gateway:
        raise BridgeError("--world and --accept need a gateway that robots report to: add --gateway")
    if reporter is not None and not accept:
        raise BridgeError("--reporter is the robot whose observations are accepted: add --accept")
    folder = context.with_resource(site_folder(site))
    robot_map = read_site(world or folder).whole_map()
    chosen_seeds = range(first_seed, first_seed + seeds)
    compiled = False if numpy else None
    found: Iterable[Record] = (drives.run(robot_map, settings, seed, compiled) for seed in chosen_seeds)
    if gateway:
        served = _served(folder, file.stem, database, output)
        served = replace(served, at_once=at_once, people=people, pace=pace, compiled=compiled)
        other = None if reporter is None else drives.read_settings(_settings_file(reporter))
        served = replace(served, window=window, accept=accept, reporter=other)
        found = drive_at_gateway(served, robot_map, settings, chosen_seeds)
    title = settings.title or file.stem
    records: dict[bool, list[Record]] = {}
    for record in found:
        records.setdefault(record.accepted is not None, []).append(record)
        print(table_text(figures([record])).splitlines()[-1], flush=True)
        if output is not None:
            name = f"{file.stem}{'' if record.accepted is None else '-accepted'}-{record.seed}.svg"
            plot = svg_of(robot_map, record, f"{title}, seed {record.seed}", settings.laser.height)
            _write(output, name, plot)
    for reviewed, some in records.items():
        rows, name = figures(some), f"{file.stem}-accepted" if reviewed else file.stem
        head = f"{title}, what robots reported accepted" if reviewed else title
        print(f"\n{head}\n\n{table_text(rows)}")
        if output is not None:
            _write(output, f"{name}.csv", csv_text(rows))


def _settings_file(name: str) -> Path:
    """Return the settings of an experiment; raises BridgeError for an unknown name."""
    from ..reference_robot.localisation import experiment as drives

    file = Path(name) if name.endswith(".toml") else drives.EXPERIMENTS / f"{name}.toml"
    if not file.is_file():
        raise BridgeError(
            f"experiment {name!r} is not known; name one of {', '.join(drives.names())}, or a settings file "
            "that ends in .toml"
        )
    return file


def _served(site: Path, name: str, database: str | None, output: Path | None) -> ServedDrives:
    """Return how the drives of an experiment are made and stored."""
    from .served_experiment import ServedDrives

    if database is None and output is None:
        raise BridgeError("--gateway stores positions: give --output FOLDER, or --database")
    if database is None:
        assert output is not None
        output.mkdir(parents=True, exist_ok=True)
        database = f"sqlite:///{output / name}.db"
    return ServedDrives(site, database_address(database, None), name)


def _write(folder: Path, name: str, text: str) -> None:
    from ..core.files import replacement

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with replacement(folder / name) as made:
            made.write_text(text, encoding="utf-8")
    except OSError as error:
        raise BridgeError(
            f"{folder / name} cannot be written: {error.strerror or error}; choose another --output"
        ) from None
