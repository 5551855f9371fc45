"""What a robot keeps on its disk, so that a program that is started anew goes on as the one before it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ..core.errors import BridgeError
from ..core.files import write_state
from ..core.json_decoder import decode_json
from .body import Pose

Point = tuple[float, float]


@dataclass(frozen=True)
class RememberedRun:
    """The run of a robot: its ``magic`` number, and the ids of the messages of ``database`` that it has done.

    ``pose`` is where it was, ``way`` the points that are left of its task (none when it has nothing to do),
    and ``theta`` the heading to end in; metres and radians in the site frame. With ``awaits_path`` it was not
    told the path to the end of ``way`` yet, and stands.
    """

    magic: int
    database: str | None = None
    done: Sequence[int] = field(default_factory=list)
    pose: Pose = (0.0, 0.0, 0.0)
    way: Sequence[Point] = field(default_factory=list)
    theta: float | None = None
    awaits_path: bool = False


class RobotMemory:
    """A file with what a robot remembers: on the disk when :meth:`keep` returns, and never half of it."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def recall(self) -> RememberedRun | None:
        """Return what an earlier run kept, None where there was none; raises BridgeError."""
        try:
            kept = decode_json(self._file.read_bytes())
            x, y, theta = kept["pose"]
            way = [(float(to_x), float(to_y)) for to_x, to_y in kept["way"]]
            return RememberedRun(**{**kept, "pose": (float(x), float(y), float(theta)), "way": way})
        except FileNotFoundError:
            return None
        except OSError as error:
            raise BridgeError(f"memory {self._file} cannot be read: {error.strerror or error}") from None
        except (ValueError, TypeError, KeyError) as error:
            raise BridgeError(
                f"memory {self._file} is none of a robot ({error}); name another file, or delete it if the "
                "robot may be told once more what it has done"
            ) from None

    def keep(self, remembered: RememberedRun) -> None:
        """Write what is to be remembered in place of what was; raises BridgeError."""
        try:
            write_state(self._file, json.dumps(asdict(remembered)).encode())
        except OSError as error:
            raise BridgeError(
                f"memory {self._file} cannot be written: {error.strerror or error}; check its folder and "
                "free space"
            ) from error
