"""What the adapter keeps of each vehicle on its disk, so that one that is started anew goes on."""

from __future__ import annotations

import hashlib
from pathlib import Path

import msgspec
from msgspec import Struct, field

from ...core.decoding import Bounds, DecodingError, decode_json
from .errors import Vda5050Error
from .route import OrderPlan

_BOUNDS = Bounds(depth=8, length=8 << 20, values=200_000)


class RememberedTask(Struct, frozen=True, kw_only=True):
    """The task under way: its command, its route, and how far that is known to be driven.

    ``accepted`` is true once the vehicle has shown the order.
    """

    command: int
    op: str
    params: str
    plan: OrderPlan | None = None
    passed: int = 0
    accepted: bool = False
    acknowledged: bool = False
    resumed: int = 0


class Remembered(Struct, frozen=True, kw_only=True):
    """What a vehicle is occupied with; ``ended`` are the newest commands that were taken on and are over.

    ``paused`` is true while a startPause of ours is to be lifted before the next order; ``revoked`` are
    orders that the vehicle must not carry out.
    """

    task: RememberedTask | None = None
    paused: bool = False
    revoked: list[str] = field(default_factory=list)
    ended: list[int] = field(default_factory=list)


class Memory:
    """A folder with a file for each vehicle, which outlives the process; never half of it.

    A power failure may bring an older one back: nothing waits for the disk, so that no stop does.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def recall(self, vehicle: str) -> Remembered | None:
        """Return what was kept of a vehicle, None where nothing was; raises Vda5050Error."""
        file = self._file(vehicle)
        try:
            return msgspec.convert(decode_json(file.read_bytes(), _BOUNDS), Remembered, strict=True)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise Vda5050Error(f"memory {file} cannot be read: {error.strerror or error}") from None
        except (DecodingError, msgspec.ValidationError) as error:
            raise Vda5050Error(
                f"memory {file} is none of a vehicle ({error}); delete it if the vehicle may be told once "
                "more what it has done"
            ) from None

    def keep(self, vehicle: str, remembered: Remembered) -> None:
        """Write what is to be remembered of a vehicle in place of what was; raises Vda5050Error."""
        file = self._file(vehicle)
        partial = file.with_suffix(".part")
        try:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            with partial.open("wb") as stream:
                stream.write(msgspec.json.encode(remembered))
            partial.replace(file)
        except OSError as error:
            raise Vda5050Error(
                f"memory {file} cannot be written: {error.strerror or error}; check its folder and free space"
            ) from error

    def _file(self, vehicle: str) -> Path:
        # A serial number may hold what no file name does, and two may differ in case alone.
        return self._folder / f"{hashlib.sha256(vehicle.encode()).hexdigest()[:24]}.json"
