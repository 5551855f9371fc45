"""Two gateways of one fleet, or three, each a process of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tests.support.bridge.bridge_programs import Bridge
from tests.support.operators import Desk
from tests.support.robots.robot_wires import RobotWire


class GatewayPair:
    """Gateways a and b of one fleet, and c if there are to be ``three``; ``site`` is the folder of all, or
    that of each.
    """

    def __init__(
        self,
        start_bridge: Callable[..., Bridge],
        site: Path | Mapping[str, Path],
        url: str,
        folder: Path,
        *options: str,
        three: bool = False,
    ):
        self._folder = folder

        def start(name: str) -> Bridge:
            state = self.state(name)
            state.mkdir(exist_ok=True)
            served = site if isinstance(site, Path) else site[name]
            return start_bridge(served, url, ["--gateway-name", name, "--state", state, *options])

        self.a, self.b = start("a"), start("b")
        if three:
            self.c = start("c")

    def state(self, name: str) -> Path:
        """Return the folder in which a gateway notes what must outlive it."""
        return self._folder / name

    def robot(
        self, bridge: Bridge, name: str, magic: int = 1, at: tuple[float, float] = (20.0, 8.0)
    ) -> RobotWire:
        """Return a robot that stands at one of the two."""
        wire = bridge.robot(name)
        wire.plug_in(magic)
        wire.tell("SendPos", {"x": at[0], "y": at[1], "theta": 0.5, "v": 0.0})
        return wire


def desk_at(bridge: Bridge, **options: Any) -> Desk:
    """Return an operator who watches the positions."""
    desk = bridge.desk(**options)
    desk.ask("subscribe", {"rate": 20})
    return desk


def clear(desk: Desk, *elsewhere: Bridge) -> None:
    """Clear the stop at the gateway of a desk; wait until others have learnt of that."""
    stop = desk.ask("clear_emergency_stop", {"reason": "seen"})
    assert not stop["in_force"]
    for bridge in elsewhere:
        other = desk_at(bridge)
        other.until(lambda other=other: not other.emergency["in_force"])


def stop(desk: Desk, number: object) -> Any:
    """Begin an emergency stop; return its report."""
    return desk.ask("emergency_stop", {"command": f"stop-{number}", "reason": "a test"})


def announced_gateways(bridge: Bridge, name: str) -> Any:
    """Connect as a robot; return the gateways in its Start."""
    with bridge.robot(name) as robot:
        return robot.wait_for("Start")["params"].get("gateways", [])
