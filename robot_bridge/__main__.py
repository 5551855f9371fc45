"""The command line: ``robot-bridge serve`` and ``robot-bridge robot``."""

from __future__ import annotations

import asyncio
import logging
import signal
import sys
from pathlib import Path
from typing import Annotated

import typer

from .errors import BridgeError
from .messages import MessageError
from .robotmap.errors import RobotMapError
from .sites.errors import SiteError

app = typer.Typer(
    help="The bridge between operators and robots.", no_args_is_help=True, pretty_exceptions_enable=False
)


@app.command()
def serve(
    site: Annotated[Path, typer.Option(help="Folder of a published site: site.toml and site.gpkg.")],
    database: Annotated[
        str, typer.Option(help="Where commands, requests and answers are kept.")
    ] = "sqlite:///robot-bridge.db",
    host: Annotated[str, typer.Option(help="Address to listen on; loopback only.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port to listen on; 0 takes any.", min=0, max=65535)] = 8765,
) -> None:
    """Serve one site to robots (/robot, and tables rr and sa) and to operators (/desk)."""
    from .gateway import GatewaySettings, run

    async def work() -> None:
        settings = GatewaySettings(site, database, host, port)
        await run(settings, _stop_event(), lambda address: print(f"listening on {address}", flush=True))

    asyncio.run(work())


@app.command()
def robot(
    name: Annotated[str, typer.Option(help="The robot's name.")],
    url: Annotated[str | None, typer.Option(help="Gateway, as ws://127.0.0.1:8765/robot.")] = None,
    database: Annotated[str | None, typer.Option(help="Database with rr and sa, instead of --url.")] = None,
    pose: Annotated[str, typer.Option(help="Where it starts: X,Y,THETA in metres and radians.")] = "0,0,0",
    speed: Annotated[float, typer.Option(help="Largest speed, m/s.", min=0.05, max=20)] = 1.5,
    turn_rate: Annotated[float, typer.Option(help="Largest turn rate, rad/s.", min=0.05, max=10)] = 1.2,
    rate: Annotated[float, typer.Option(help="Positions a second.", min=0.1, max=50)] = 5.0,
    noise: Annotated[float, typer.Option(help="Noise of the reported position, metres.", min=0)] = 0.01,
    seed: Annotated[int, typer.Option(help="Seed of the noise.")] = 1,
) -> None:
    """Run the reference robot: a simulated body that speaks the protocol."""
    from .robot.body import BodyLimits
    from .robot.runner import RobotSettings, run

    if (url is None) == (database is None):
        raise BridgeError("a robot has one link: give either --url or --database")
    settings = RobotSettings(
        name=name,
        url=url,
        database=database,
        pose=_pose(pose),
        limits=BodyLimits(speed=speed, turn_rate=turn_rate),
        rate=rate,
        noise=noise,
        seed=seed,
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


def _stop_event() -> asyncio.Event:
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop.set)
    return stop


def main() -> None:
    """Run the command line; what cannot be done is said in one line and ends with status 1."""
    logging.basicConfig(level=logging.WARNING, format="%(asctime)s %(levelname)s %(message)s")
    logging.getLogger("websockets").setLevel(logging.CRITICAL)
    try:
        app()
    except (BridgeError, SiteError, RobotMapError, MessageError) as error:
        sys.exit(f"robot-bridge: {error}")


if __name__ == "__main__":
    main()
