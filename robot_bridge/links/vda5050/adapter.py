"""The adapter: vehicles at a broker on one side, the gateway on the other."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
import time
from collections.abc import Mapping
from pathlib import Path
from typing import ClassVar

import msgspec

from ...core.logs import RepeatedLines
from ...core.messages.robots import Alive, SendPos, SetPath, SetPosEnd, SetPosIni, Stopped
from ...core.messages.safety import Ability
from ...core.sites.frame import SiteFrame
from ..base.adapter import Adapter, Command, Link, summary
from ..base.errors import CommandRefusedError
from ..base.frames import LinkFrame
from ..base.settings import LinkSettings, read_settings
from . import messages
from .broker import Broker
from .ledger import Effect, Halted, Keep, Publish, Settled, VehicleReport
from .messages import MessageWriter, Order, Topics, Vda5050Error, VdaHeader, VehicleId, VehicleMessageError
from .presence import MapFrame
from .settings import (
    AnyMap,
    Vda5050Settings,
    VehicleNames,
    broker_address,
    check,
    placed_maps,
    topics,
    vehicle_settings,
)
from .tasks import Memory, Remembered
from .vehicle import VehicleController

log = logging.getLogger(__name__)

TICK = 0.25
"""seconds between checks of due work."""
REPORT_EVERY = 1.0
"""seconds between reports on the vehicles' faults."""
FACTSHEET_WITHIN = 2.0
"""seconds to wait for a vehicle's factsheet before its abilities are reported to the gateway."""


class Vehicle:
    """One vehicle with its waiting commands and stop."""

    def __init__(self, robot: str, controller: VehicleController, now: float) -> None:
        self.robot = robot
        self.controller = controller
        self.writer = MessageWriter(controller.vehicle)
        self.received_at = now
        self.is_introduced = False
        self.unsent: list[Settled] = []
        """Outcomes of commands before the gateway knew the vehicle: orders that ended without a running
        link."""
        self._commands: dict[int, asyncio.Future[str | None]] = {}
        self._halts: list[asyncio.Future[None]] = []

    def await_settled(self, command: int) -> asyncio.Future[str | None]:
        """Return a future of a command's outcome: None, or why it is refused."""
        future: asyncio.Future[str | None] = asyncio.get_running_loop().create_future()
        self._commands[command] = future
        return future

    def settle(self, settled: Settled) -> bool:
        """Set the outcome of a command; return whether it was awaited."""
        future = self._commands.pop(settled.command_id, None)
        if future is None or future.done():
            return False
        future.set_result(settled.reason)
        return True

    def await_halt(self) -> asyncio.Future[None]:
        """Return a future that is done once the vehicle shows that it stands."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._halts.append(future)
        return future

    def halted(self) -> None:
        """Record that the vehicle stands."""
        waiting, self._halts = self._halts, []
        for future in waiting:
            if not future.done():
                future.set_result(None)


class RandomNames:
    """Names of orders and actions, random, so that none repeats."""

    def draw(self) -> str:
        """Return the next one."""
        return secrets.token_hex(6)


class Vda5050Adapter(Adapter):
    """Controls the vehicles of one interface."""

    kind: ClassVar[str] = "vda5050"

    def __init__(self, settings: LinkSettings, own: Vda5050Settings) -> None:
        check(settings, own)
        self._settings = settings
        self._own = own
        self._topics: Topics = topics(own)
        self._names = VehicleNames(own)
        self._led = vehicle_settings(settings, own)
        self._memory = Memory(settings.state_folder / f"{settings.name}.vehicles")
        self._vehicles: dict[VehicleId, Vehicle] = {}
        self._robots: dict[str, Vehicle] = {}
        self._refused: set[VehicleId] = set()
        self._maps: Mapping[str, MapFrame] = {}
        self._repeated = RepeatedLines()
        self._faults = 0
        self._trouble: str | None = None
        self._link: Link | None = None
        self._broker = Broker(broker_address(settings, own), self._topics.subscriptions(), self)

    # --- the gateway ----------------------------------------------------------------------------------

    async def run(self, link: Link) -> None:
        """Carry messages between the broker and the gateway until cancelled."""
        self._link = link
        self._maps = self._placed(link)
        ticking = asyncio.create_task(self._tick())
        carrying = asyncio.create_task(self._broker.run())
        try:
            done, _ = await asyncio.wait({ticking, carrying}, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in (ticking, carrying):
                task.cancel()
            await asyncio.gather(ticking, carrying, return_exceptions=True)

    async def command(self, command: Command) -> None:
        """Have the vehicle accept a command; return when it shows that."""
        vehicle, message = self._vehicle(command.robot), command.message
        if not isinstance(message, SetPosEnd | SetPath | SetPosIni):
            return  # maps are the vehicles' own
        settled = vehicle.await_settled(command.id)
        try:
            vehicle.controller.command(message, command.id, time.monotonic(), again=command.again)
            self._carry_out(vehicle)
            reason = await settled
        except asyncio.CancelledError:
            vehicle.controller.withdraw(command.id)
            self._carry_out(vehicle)
            raise
        if reason is not None:
            raise CommandRefusedError(reason)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Stop a vehicle; return when it shows that it stands."""
        vehicle = self._vehicle(robot)
        vehicle.controller.halt(time.monotonic(), emergency=emergency)
        halted = vehicle.await_halt()
        self._carry_out(vehicle)
        try:
            async with asyncio.timeout(0.8 * self._settings.answer_within_s):
                await halted
        except TimeoutError:
            status = vehicle.controller.status(time.monotonic())
            raise CommandRefusedError(status or "the vehicle does not show that it stands") from None

    def stop_unannounced(self) -> None:
        """Stop the vehicles that have said that they are connected, and no state yet."""
        for vehicle in self._vehicles.values():
            if not vehicle.is_introduced:
                try:
                    vehicle.controller.halt(time.monotonic(), emergency=True)
                    self._carry_out(vehicle)
                except Exception:
                    self._log_unforeseen(vehicle.controller.vehicle)

    def admitted(self, robot: str) -> None:
        """Report the vehicle's position."""
        if (vehicle := self._robots.get(robot)) is not None:
            vehicle.controller.set_admitted(True, time.monotonic())
            self._carry_out(vehicle)

    def refused(self, robot: str, reason: str) -> None:
        """Release nothing for a vehicle that no desk could stop."""
        if (vehicle := self._robots.get(robot)) is not None:
            vehicle.controller.set_admitted(False, time.monotonic())

    def _vehicle(self, robot: str) -> Vehicle:
        vehicle = self._robots.get(robot)
        if vehicle is None:
            raise CommandRefusedError(f"no vehicle is called {robot!r}")
        return vehicle

    def _placed(self, link: Link) -> Mapping[str, MapFrame]:
        if not self._own.maps:
            return AnyMap(link.frame)
        site = SiteFrame(link.site.crs, link.site.origin, link.site.rotation)
        frames = {}
        for map_id, frame in self._own.maps.items():
            frames[map_id] = LinkFrame(frame, site, f"{self._settings.file}: vda5050.maps.{map_id}")
        return placed_maps(frames)

    # --- the vehicles ---------------------------------------------------------------------------------

    @property
    def vehicles(self) -> list[str]:
        """The names of the heard vehicles."""
        return list(self._robots)

    def receive(self, topic: str, payload: bytes, *, retained: bool = False) -> None:
        """Process one message of the broker; an error in it affects its vehicle alone."""
        parsed = self._topics.parse(topic)
        if parsed is None:
            return
        identity, kind = parsed
        try:
            message = messages.decode_message(kind, payload, self._topics.major)
            if isinstance(message, VdaHeader) and identity != VehicleId(
                message.manufacturer, message.serial_number
            ):
                raise VehicleMessageError(
                    f"{kind}: it says to be of {message.manufacturer[:40]!r}/{message.serial_number[:40]!r}"
                )
            vehicle = self._known(identity)
            if vehicle is None:
                return
            vehicle.controller.receive_message(message, time.monotonic(), retained=retained)
            self._carry_out(vehicle)
        except Vda5050Error as error:
            self._warn(identity, str(error))
        except Exception:
            self._log_unforeseen(identity)

    def _known(self, identity: VehicleId) -> Vehicle | None:
        vehicle = self._vehicles.get(identity)
        if vehicle is not None or identity in self._refused:
            return vehicle
        if len(self._vehicles) + len(self._refused) >= 2 * self._own.most_vehicles:
            return None
        try:
            robot = self._names.name(identity)
            if len(self._vehicles) >= self._own.most_vehicles:
                raise Vda5050Error(f"vda5050.most_vehicles = {self._own.most_vehicles} are there already")
            if robot in self._robots:
                raise Vda5050Error(f"robot {robot!r} is {self._robots[robot].controller.vehicle} already")
        except Vda5050Error:
            self._refused.add(identity)
            raise
        if robot is None:
            self._refused.add(identity)
            return None
        now = time.monotonic()
        vehicle = self._vehicles[identity] = self._robots[robot] = self._recalled(identity, robot, now)
        return vehicle

    def _recalled(self, identity: VehicleId, robot: str, now: float) -> Vehicle:
        """Return a vehicle with its stored state; adrift if the settings have changed since."""

        def made(remembered: Remembered | None) -> Vehicle:
            names = RandomNames()
            controller = VehicleController(identity, self._led, self._maps, remembered, names, now)
            return Vehicle(robot, controller, now)

        try:
            kept = self._memory.recall(str(identity))
            if kept is None or kept.basis in ("", self._basis(robot, kept)):
                return made(kept)
            log.warning("vehicle %s: what it was to do is given up: its settings have changed", identity)
            # Before anything is stored under the present settings. Commands to a former name are not
            # executed.
            if self._link is not None:
                for name in {kept.basis.partition(" ")[0], robot}:
                    self._link.adrift(name)
            return made(kept.without_task())
        except Vda5050Error as error:
            log.error("vehicle %s begins without what was kept: %s", identity, error)
            return made(None)

    def _basis(self, robot: str, kept: Remembered) -> str:
        """Return the settings on which a vehicle's task depends: its name, and the frame of its map."""
        plan = None if kept.task is None else kept.task.plan
        placed = None if plan is None else self._own.maps.get(plan.map_id)
        return robot if placed is None else f"{robot} {placed}"

    def broker_changed(self, reason: str | None) -> None:
        """Record that the broker is connected (None), or why it is not."""
        if reason is not None:
            for vehicle in self._vehicles.values():
                vehicle.controller.lose_broker()
        self._trouble = reason
        self._report(time.monotonic())

    async def _tick(self) -> None:
        report_at = 0.0
        while True:
            await asyncio.sleep(TICK)
            now = time.monotonic()
            connected = self._link is not None and self._link.is_connected
            for vehicle in list(self._vehicles.values()):
                if not connected:
                    vehicle.controller.set_admitted(False, now)
                try:
                    vehicle.controller.advance(now)
                    self._announce(vehicle, now)
                    self._carry_out(vehicle)
                except Exception:
                    self._log_unforeseen(vehicle.controller.vehicle)
            self._repeated.summarise()
            if now >= report_at:
                report_at = now + REPORT_EVERY
                self._report(now)

    def _announce(self, vehicle: Vehicle, now: float) -> None:
        """Announce a vehicle to the gateway once its abilities are known."""
        controller, link = vehicle.controller, self._link
        if vehicle.is_introduced or link is None or not controller.is_known:
            return
        if controller.factsheet is None and now - vehicle.received_at < FACTSHEET_WITHIN:
            return
        vehicle.is_introduced = True
        abilities: list[Ability] = ["targets", "paths"]
        if controller.factsheet is None or controller.factsheet.supports("initPosition"):
            abilities.append("start")
        link.add(vehicle.robot, abilities)
        for settled in vehicle.unsent:
            self._report_effect(vehicle, settled)
        vehicle.unsent.clear()

    # --- effects --------------------------------------------------------------------------------------

    def _carry_out(self, vehicle: Vehicle) -> None:
        """Carry out the effects of a call; an order that could not be stored is not published."""
        is_kept = True
        for effect in vehicle.controller.drain():
            if isinstance(effect, Keep):
                is_kept = self._keep(vehicle, effect)
            elif isinstance(effect, Publish):
                self._publish(vehicle, effect, is_kept=is_kept)
            else:
                self._report_effect(vehicle, effect)

    def _keep(self, vehicle: Vehicle, effect: Keep) -> bool:
        kept = msgspec.structs.replace(effect.remembered, basis=self._basis(vehicle.robot, effect.remembered))
        try:
            self._memory.keep(str(vehicle.controller.vehicle), kept)
        except Vda5050Error as error:
            self._warn(vehicle.controller.vehicle, str(error))
            return False
        return True

    def _publish(self, vehicle: Vehicle, effect: Publish, *, is_kept: bool) -> None:
        controller, message = vehicle.controller, effect.message
        is_order = isinstance(message, Order)
        if is_order and not is_kept:
            return
        orders = self._topics.outbound(controller.vehicle, "order")
        if not isinstance(message, Order) and any(a.action_type == "cancelOrder" for a in message.actions):
            self._broker.withdraw(orders)
        topic = orders if is_order else self._topics.outbound(controller.vehicle, "instantActions")
        payload = vehicle.writer.encode(message, controller.version, time.time())
        self._broker.publish(topic, payload, urgent=not is_order)

    def _report_effect(self, vehicle: Vehicle, effect: Effect) -> None:
        link = self._link
        if isinstance(effect, Settled):
            if vehicle.settle(effect) or effect.reason is None or link is None:
                return
            if vehicle.is_introduced:
                link.give_up(vehicle.robot, effect.command_id, effect.reason)
            else:
                vehicle.unsent.append(effect)
        elif isinstance(effect, Halted):
            vehicle.halted()
        elif isinstance(effect, VehicleReport) and link is not None and vehicle.is_introduced:
            if isinstance(effect.request, SendPos):
                link.position(vehicle.robot, effect.request)
            elif isinstance(effect.request, Alive):
                link.alive(vehicle.robot)
            elif isinstance(effect.request, Stopped):
                link.stopped(vehicle.robot)

    def _warn(self, identity: VehicleId, text: str) -> None:
        self._faults += 1
        self._repeated.warn(log, ("vda5050:", str(identity)), f"vehicle {identity}: {text}")

    def _log_unforeseen(self, identity: VehicleId) -> None:
        """Log an unforeseen error, in an except block; it affects that vehicle alone."""
        self._faults += 1
        self._repeated.note_unforeseen(log, ("vda5050:", str(identity)), f"vehicle {identity}")

    def _report(self, now: float) -> None:
        """Report that the broker is away, else the faults of the vehicles."""
        if self._link is None:
            return
        counts = {"vehicles": float(len(self._vehicles)), "faults": float(self._faults)}
        alarms = [
            (one.robot, one.controller.alarm(now)) for one in self._vehicles.values() if one.is_introduced
        ]
        text = self._trouble or summary([f"{robot}: {alarm}" for robot, alarm in alarms if alarm])
        with contextlib.suppress(ValueError):
            self._link.report(ok=text is None, text=text, counts=counts, reached=self._trouble is None)


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter with them; raises LinkError."""
    settings, own = read_settings(file, "vda5050", Vda5050Settings)
    return settings, Vda5050Adapter(settings, own)
