"""``robot-bridge robot``: the reference robot as a program, in real time on one of the links."""

from __future__ import annotations

import asyncio
import secrets
import signal
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from ..core.errors import BridgeError
from ..core.logs import set_up_server_log
from ..core.messages.base import check_robot_name
from ..core.messages.robots import SendPos, SetObject
from ..core.reconnection import ClientCredentials
from ..core.systemd import call_at_end_of_input
from ..reference_robot.agent import STEER_EVERY, Agent, AgentSettings, RequestSink, RobotMemory
from ..reference_robot.body import BodyLimits, ScriptedObject, SimulatedVehicle
from ..reference_robot.websocket_link import RobotWebSocketLink
from .options import PasswordFileOption, UntilStdinCloses, database_address

if TYPE_CHECKING:
    from sqlalchemy import URL

ALIVE_INTERVAL = 1.0


class Localisation(str, Enum):
    """How the simulated robot determines its position."""

    EXACT = "exact"
    FILTER = "filter"


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
    acceleration: Annotated[
        float, typer.Option(help="Largest acceleration, m/s²; it turns in proportion.", min=0.1, max=20)
    ] = 1.5,
    rate: Annotated[float, typer.Option(help="Positions a second.", min=0.1, max=50)] = 5.0,
    noise: Annotated[
        float, typer.Option(help="Noise of the reported position, metres.", min=0, max=100)
    ] = 0.01,
    seed: Annotated[int, typer.Option(help="Seed of the noise.")] = 1,
    see: Annotated[
        list[str] | None, typer.Option(help="X,Y,ID of a thing that it tells of once it is within 10 m.")
    ] = None,
    image: Annotated[Path | None, typer.Option(help="Image (JPEG, PNG, WebP) that it sends of each.")] = None,
    ask_path: Annotated[
        bool, typer.Option(help="Ask for the path to every target, and stand until it is known.")
    ] = True,
    path_cones: Annotated[
        bool, typer.Option(help="Declare that it places and collects cones at the ends of paths.")
    ] = True,
    ask_surface: Annotated[
        bool, typer.Option(help="Ask for the road surfaces of a task and say them as status.")
    ] = False,
    memory: Annotated[
        Path | None,
        typer.Option(help="File in which it remembers where it is, its task and what it has done."),
    ] = None,
    localisation: Annotated[
        Localisation,
        typer.Option(help="Whether it always knows its place, or finds it on its map by a particle filter."),
    ] = Localisation.EXACT,
    world: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the published site that its world is made of, with --localisation filter."
        ),
    ] = None,
    robot_settings: Annotated[
        Path | None, typer.Option(help="TOML file with what its sensors, filter and world are set to.")
    ] = None,
    knows_pose: Annotated[
        bool, typer.Option(help="Whether it knows at first where it stands, or looks for that on its map.")
    ] = True,
    gps: Annotated[bool, typer.Option("--gps", help="It has a GPS receiver, too.")] = False,
    until_stdin_closes: UntilStdinCloses = False,
) -> None:
    """Run the reference robot: a simulated body that speaks the protocol."""
    set_up_server_log()
    if (url is None) == (database is None):
        raise BridgeError("a robot has one link: give either --url or --database")
    where, limits = _pose(pose), BodyLimits.of(speed, turn_rate, acceleration)
    if (localisation is Localisation.FILTER) != (world is not None):
        raise BridgeError("--world is the site in which a robot with --localisation filter drives: give both")
    settings = AgentSettings(
        magic=secrets.randbelow(1 << 31),
        pose=where,
        limits=limits,
        rate=rate,
        noise=noise,
        seed=seed,
        things=tuple(_thing(text) for text in see or ()),
        image=None if image is None else _bytes(image),
        asks_path=ask_path,
        path_cones=path_cones,
        asks_surface=ask_surface,
        memory=None if memory is None else RobotMemory(memory),
    )

    address = None if database is None else database_address(database, database_password_file)

    async def work(settings: AgentSettings) -> None:
        link = _link(name, url, address, ClientCredentials(token_file, ca))
        await _run(name, link, settings, _stop_event(until_stdin_closes))

    if world is None:
        asyncio.run(work(settings))
        return
    from ..reference_robot.localisation.simulation import MAP_MARGIN

    with _localised(world, robot_settings, limits, where, knows_pose, gps, seed) as body:
        asyncio.run(work(replace(settings, body=body, map_margin=MAP_MARGIN)))


class RobotLink(RequestSink, Protocol):
    """Sends the agent's requests and delivers the server's answers."""

    async def run(self, agent: Agent) -> None:
        """Carry messages until cancelled."""


def _link(name: str, url: str | None, database: URL | None, credentials: ClientCredentials) -> RobotLink:
    check_robot_name(name)
    if url is not None:
        return RobotWebSocketLink(url, name, credentials)
    assert database is not None
    # SQLAlchemy takes as long to load as all the rest, and robots on WebSocket do not need it.
    from ..reference_robot.sql_link import RobotSqlLink

    return RobotSqlLink(database, name)


async def _run(name: str, link: RobotLink, settings: AgentSettings, stop: asyncio.Event) -> None:
    """Run a robot in real time until ``stop`` is set; it sends Stopped before it disconnects."""
    agent = Agent(settings, link)
    works = (link.run(agent), _live(name, agent), _send_alive(agent), stop.wait())
    tasks = [asyncio.create_task(work) for work in works]
    done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    agent.stop()
    await asyncio.sleep(2 * STEER_EVERY)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()


async def _live(name: str, agent: Agent) -> None:
    """Let the body move in real time, however late the event loop is; print when the gateway admits it."""
    loop = asyncio.get_running_loop()
    last, was_admitted = loop.time(), False
    while True:
        await asyncio.sleep(STEER_EVERY)
        now = loop.time()
        agent.step(min(now - last, 10 * STEER_EVERY))
        last = now
        if agent.is_admitted and not was_admitted:
            typer.echo(f"{name} is connected; Ctrl+C ends it")
        was_admitted = agent.is_admitted


async def _send_alive(agent: Agent) -> None:
    while True:
        await asyncio.sleep(ALIVE_INTERVAL)
        agent.alive()


@contextmanager
def _localised(
    world: Path,
    file: Path | None,
    limits: BodyLimits,
    pose: tuple[float, float, float],
    knows_pose: bool,
    gps: bool,
    seed: int,
) -> Iterator[SimulatedVehicle]:
    """Yield a body that localises itself, with a thread of its own for the filter."""
    from ..core.sites.site import read_site
    from ..reference_robot.localisation.settings import LocalisedRobotSettings as SensorSettings
    from ..reference_robot.localisation.simulation import localised_robot, read_robot_settings

    settings = SensorSettings() if file is None else read_robot_settings(file)
    robot_map = read_site(world).whole_map()
    with ThreadPoolExecutor(1, "localisation") as executor:
        yield localised_robot(
            robot_map, settings, limits, pose, executor, knows_pose=knows_pose, gps=gps, seed=seed
        )


def _pose(text: str) -> tuple[float, float, float]:
    try:
        x, y, theta = (float(part) for part in text.split(","))
        SendPos(x, y, theta, 0.0)
    except ValueError as error:
        raise BridgeError(
            f"pose {text!r} cannot be read ({error}); write X,Y,THETA such as 10,20,1.57"
        ) from None
    return x, y, theta


def _thing(text: str) -> ScriptedObject:
    x, y, id = (*text.split(",", 2), "", "")[:3]
    try:
        thing = ScriptedObject(float(x), float(y), id)
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


def _stop_event(until_stdin_closes: bool) -> asyncio.Event:
    stop = asyncio.Event()
    if until_stdin_closes:
        call_at_end_of_input(stop.set)
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop.set)
    return stop
