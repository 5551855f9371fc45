"""``robot-bridge robot``: the reference robot as a program."""

from __future__ import annotations

import asyncio
import signal
from pathlib import Path
from typing import Annotated

import typer

from ..errors import BridgeError
from ..messages import SetObject
from ..robot.sightings import Thing
from .database_option import PasswordFileOption, database_address


def robot(
    name: Annotated[str, typer.Option(help="The robot's name.")],
    url: Annotated[str | None, typer.Option(help="Gateway, as ws://127.0.0.1:8765/robot.")] = None,
    database: Annotated[str | None, typer.Option(help="Database with rr and sa, instead of --url.")] = None,
    database_password_file: PasswordFileOption = None,
    token_file: Annotated[Path | None, typer.Option(help="File that holds the robot's token.")] = None,
    ca: Annotated[Path | None, typer.Option(help="The site's ca.pem, for wss://.")] = None,
    pose: Annotated[str, typer.Option(help="Where it starts: X,Y,THETA in metres and radians.")] = "0,0,0",
    speed: Annotated[float, typer.Option(help="Largest speed, m/s.", min=0.05, max=20)] = 1.5,
    turn_rate: Annotated[float, typer.Option(help="Largest turn rate, rad/s.", min=0.05, max=10)] = 1.2,
    rate: Annotated[float, typer.Option(help="Positions a second.", min=0.1, max=50)] = 5.0,
    noise: Annotated[float, typer.Option(help="Noise of the reported position, metres.", min=0)] = 0.01,
    seed: Annotated[int, typer.Option(help="Seed of the noise.")] = 1,
    see: Annotated[
        list[str] | None, typer.Option(help="X,Y,ID of a thing that it tells of once it is within 10 m.")
    ] = None,
    image: Annotated[Path | None, typer.Option(help="Image (JPEG, PNG, WebP) that it sends of each.")] = None,
    ask_path: Annotated[bool, typer.Option(help="Ask for a path to every target.")] = False,
    ask_surface: Annotated[
        bool, typer.Option(help="Ask for the road surfaces of a task and say them as status.")
    ] = False,
    memory: Annotated[
        Path | None,
        typer.Option(help="File in which it remembers where it is, its task and what it has done."),
    ] = None,
) -> None:
    """Run the reference robot: a simulated body that speaks the protocol."""
    from ..access.credentials import Credentials
    from ..robot.body import BodyLimits
    from ..robot.runner import RobotSettings, run

    if (url is None) == (database is None):
        raise BridgeError("a robot has one link: give either --url or --database")
    settings = RobotSettings(
        name=name,
        url=url,
        database=None if database is None else database_address(database, database_password_file),
        pose=_pose(pose),
        limits=BodyLimits(speed=speed, turn_rate=turn_rate),
        rate=rate,
        noise=noise,
        seed=seed,
        credentials=Credentials(token_file, ca),
        things=tuple(_thing(text) for text in see or ()),
        image=None if image is None else _bytes(image),
        asks_path=ask_path,
        asks_surface=ask_surface,
        memory=memory,
    )

    async def work() -> None:
        await run(settings, _stop_event())

    asyncio.run(work())


def _pose(text: str) -> tuple[float, float, float]:
    try:
        x, y, theta = (float(part) for part in text.split(","))
    except ValueError:
        raise BridgeError(f"pose {text!r} cannot be read; write X,Y,THETA such as 10,20,1.57") from None
    return x, y, theta


def _thing(text: str) -> Thing:
    x, y, id = (*text.split(",", 2), "", "")[:3]
    try:
        thing = Thing(float(x), float(y), id)
        SetObject(thing.x, thing.y, thing.id)
    except ValueError as error:
        raise BridgeError(
            f"thing {text!r} cannot be read ({error}); write X,Y,ID such as 10,20,cone-7"
        ) from None
    return thing


def _bytes(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise BridgeError(f"image {file} cannot be read: {error.strerror or error}") from None


def _stop_event() -> asyncio.Event:
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop.set)
    return stop
