"""Runs the reference robot in real time on one of the links."""

from __future__ import annotations

import asyncio
import secrets
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from ..core.messages.validation import check_robot_name
from ..protocol.credentials import ClientCredentials
from .agent import STEER_EVERY, Agent, AgentSettings, RequestSink
from .body import BodyLimits, Pose, ScriptedObject, SimulatedVehicle
from .memory import RobotMemory
from .websocket_link import RobotWebSocketLink

if TYPE_CHECKING:
    from sqlalchemy import URL

ALIVE_INTERVAL = 1.0


@dataclass(frozen=True)
class ReferenceRobotSettings:
    """What a robot is started with; one of ``url`` and ``database`` is its link."""

    name: str
    url: str | None
    database: str | URL | None
    pose: Pose = (0.0, 0.0, 0.0)
    limits: BodyLimits = field(default_factory=BodyLimits)
    rate: float = 5.0
    noise: float = 0.01
    seed: int = 1
    credentials: ClientCredentials = field(default_factory=ClientCredentials)
    things: tuple[ScriptedObject, ...] = ()
    image: bytes | None = None
    asks_path: bool = True
    path_cones: bool = True
    asks_surface: bool = False
    memory: Path | None = None
    map_margin: float = 0.0
    body: SimulatedVehicle | None = None


class RobotLink(RequestSink, Protocol):
    """Carries the agent's requests out and the server's answers in."""

    async def run(self, agent: Agent) -> None:
        """Carry messages until cancelled."""


async def run(settings: ReferenceRobotSettings, stop: asyncio.Event) -> None:
    """Run a robot until ``stop`` is set; it says Stopped before it leaves."""
    link = _link(settings)
    agent = Agent(
        AgentSettings(
            magic=secrets.randbelow(1 << 31),
            pose=settings.pose,
            limits=settings.limits,
            rate=settings.rate,
            noise=settings.noise,
            seed=settings.seed,
            things=settings.things,
            image=settings.image,
            asks_path=settings.asks_path,
            path_cones=settings.path_cones,
            asks_surface=settings.asks_surface,
            memory=None if settings.memory is None else RobotMemory(settings.memory),
            map_margin=settings.map_margin,
            body=settings.body,
        ),
        link,
    )
    tasks = [
        asyncio.create_task(work) for work in (link.run(agent), _live(agent), _say_alive(agent), stop.wait())
    ]
    done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    agent.stop()
    await asyncio.sleep(2 * STEER_EVERY)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()


def _link(settings: ReferenceRobotSettings) -> RobotLink:
    name = check_robot_name(settings.name)
    if settings.url is not None:
        return RobotWebSocketLink(settings.url, name, settings.credentials)
    assert settings.database is not None
    # SQLAlchemy takes as long to load as all the rest, and robots on WebSocket need none.
    from .sql_link import RobotSqlLink

    return RobotSqlLink(settings.database, name)


async def _live(agent: Agent) -> None:
    """Let the body move in real time, however late the event loop is."""
    loop = asyncio.get_running_loop()
    last = loop.time()
    while True:
        await asyncio.sleep(STEER_EVERY)
        now = loop.time()
        agent.step(min(now - last, 10 * STEER_EVERY))
        last = now


async def _say_alive(agent: Agent) -> None:
    while True:
        await asyncio.sleep(ALIVE_INTERVAL)
        agent.alive()
