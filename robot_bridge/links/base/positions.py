"""Positions of many robots as one binary frame, and those of GPS as calls; no I/O."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np
import numpy.typing as npt

from ... import jsonrpc
from ...core.position_frame import METHOD, packed_frame
from ...messages import SendGPS, SendPos, to_json
from ...messages.links import LinkColumns
from ...position_batches import NEEDED, NUMBERS, TEXTS

NOTHING = float("nan")


def frame_of(positions: Sequence[tuple[str, SendPos]]) -> bytes:
    """Return the frame that tells where robots are; what is known of none of them is left out."""
    columns: dict[str, npt.NDArray[np.float64]] = {}
    words: dict[str, int] = {}
    poses = [pose for _, pose in positions]
    for column, parameter in NUMBERS.items():
        values = [getattr(pose, parameter) for pose in poses]
        if column in NEEDED or any(value is not None for value in values):
            columns[column] = np.array([NOTHING if v is None else v for v in values], dtype=np.float64)
    for name in TEXTS:
        texts = [getattr(pose, name) for pose in poses]
        if any(text is not None for text in texts):
            places = [NOTHING if t is None else words.setdefault(t, len(words)) for t in texts]
            columns[name] = np.array(places, dtype=np.float64)
    table = LinkColumns([name for name, _ in positions], list(columns), list(words))
    head = msgspec.json.encode({"jsonrpc": "2.0", "method": METHOD, "params": table})
    return packed_frame(head, columns.values())


def gps_call(robot: str, fix: SendGPS) -> str:
    """Return the frame that tells where on the earth a robot is."""
    return jsonrpc.call(SendGPS.__name__, {"robot": robot, **to_json(fix)})
