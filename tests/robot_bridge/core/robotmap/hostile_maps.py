"""Robot maps made to cost their reader as much as can be, up to 1 MB each; run by itself it reads them all.

It prints what each one cost: seconds of the processor, the most memory of the process in MB, bytes, its name.
"""

from __future__ import annotations

import contextlib
import hashlib
import lzma
import struct
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import cbor2
import numpy as np
import zstandard

from robot_bridge.core.errors import RobotMapError
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.robotmap.columnar import pack_map
from robot_bridge.core.robotmap.columns import pack_numbers
from robot_bridge.core.robotmap.model import RobotMap
from robot_bridge.core.robotmap.text_format import read_text

SIZE = 1_000_000
HEAD = "border;\n0;10;\n10;0;\n#\n"
EMPTY = "obstacle;\n1;1;0;;\n#\n"
SEGMENT = "0;0;\n0;0;\n0;0;;\n#\n"
ONE = f"obstacle;\n1;1;1;;\n#\n{SEGMENT}"
NAMES = [
    "meta",
    "x_min",
    "y_min",
    "x_max",
    "y_max",
    "heads",
    "tails",
    "obstacles",
    "segments",
    "bodies",
    "starts",
    "steps",
    "heights",
    "varies",
    "tail",
    "kinds",
    "counts",
    "body",
    "head",
    "ids",
    "others",
    "numbers",
]


_COMPRESSED_TOO = (
    "obstacles without segments",
    "segments",
    "comments",
    "escapes",
    "backslashes",
    "digits with a wrong end",
    "blanks",
    "wide characters",
)


def obstacle(label: str = "", ext: str = "", segments: int = 0) -> str:
    """Return an obstacle's first lines."""
    return f"obstacle;\n1;1;{segments};{label};{ext}\n#\n"


def texts(size: int) -> dict[str, Callable[[], str]]:
    """Return makers of texts of some ``size`` characters, by their names."""
    return {
        "obstacles without segments": lambda: HEAD + EMPTY * (size // len(EMPTY)),
        "obstacles of one segment": lambda: HEAD + ONE * (size // len(ONE)),
        "segments": lambda: HEAD + obstacle() + SEGMENT * (size // len(SEGMENT)),
        "odd segments": lambda: HEAD + obstacle() + SEGMENT.replace("0;;", "0; ;") * (size // len(SEGMENT)),
        "comments": lambda: HEAD + "%\n" * (size // 2),
        "comments between": lambda: HEAD + obstacle() + (SEGMENT + "%\n" * 50) * (size // 120),
        "leading lines": lambda: "".join(f"%{n:x}\n" for n in range(size // 7)) + HEAD,
        "a leading line of blanks": lambda: "%" + " " * size + "\n" + HEAD,
        "commas in one extra": lambda: HEAD + obstacle(ext="a=" + "," * size + ";"),
        "extras": lambda: HEAD + obstacle(ext=",".join(f"{n:x}=" for n in range(size // 7)) + ";"),
        "extras without a key": lambda: HEAD + obstacle(ext="," * size + ";"),
        "escapes": lambda: HEAD + obstacle("\\2c" * (size // 3)),
        "backslashes": lambda: HEAD + obstacle("\\" * size),
        "semicolons": lambda: HEAD + "obstacle;\n" + ";" * size + "\n",
        "blanks": lambda: HEAD + " " * size + "x",
        "digits with a wrong end": lambda: HEAD.replace("10;0", "1" * size + "x;0"),
        "digits": lambda: HEAD.replace("10;0", "1" * size + ";0"),
        "digits after the point": lambda: HEAD.replace("10;0", "0." + "1" * size + ";0"),
        "digits of an exponent": lambda: HEAD.replace("10;0", "1e" + "1" * size + ";0"),
        "an id of digits": lambda: HEAD + f"obstacle;\n{'1' * size};1;0;;\n#\n",
        "a count of digits": lambda: HEAD + f"obstacle;\n1;1;{'9' * size};;\n#\n",
        "no line break": lambda: "border;" * (size // 7),
        "wide characters": lambda: HEAD + ("%\U0001f600\n" * (size // 6)),
    }


def sealed(codec: int, body: bytes, text: bytes, length: int | None = None) -> bytes:
    """Return an envelope around a compressed ``body``."""
    length = len(text) if length is None else length
    layout = {1: 0, 2: 2}[codec]
    return (
        struct.pack("<4sBBBBQ32s", b"RMAP", 1, codec, layout, 0, length, hashlib.sha256(text).digest()) + body
    )


def columns(length: int, text: bytes = b"", **changes: object) -> bytes:
    """Return codec 2 with a map of one obstacle in which ``changes`` are made."""
    items = dict(zip(NAMES, cbor2.loads(pack_map(read_text(HEAD + ONE))), strict=True)) | changes
    return sealed(2, _squeezed(cbor2.dumps(list(items.values()))), text, length)


def same(value: int, count: int) -> bytes:
    """Return a column of ``count`` times ``value``."""
    return pack_numbers(np.full(count, value, dtype=np.int64))


def many_obstacles(count: int, **changes: object) -> bytes:
    """Return codec 2 with ``count`` obstacles of one segment, all of one body."""
    text = (HEAD + ONE * count).encode()
    body = np.ones(count, dtype=np.int64)
    body[:1] = 0
    many = {"obstacles": count, "segments": count, "body": pack_numbers(body), "ids": same(0, count)}
    return columns(len(text), text, **(many | changes))


def binaries() -> Iterator[tuple[str, bytes]]:
    """Yield names and contents of binary maps; each has at most 1 MB."""
    large = texts(7_900_000)
    for name in _COMPRESSED_TOO:
        raw = large[name]().encode()
        yield f"codec 1: {name}", sealed(1, zstandard.compress(raw, 1), raw)
    bomb = zstandard.compress(bytes(250_000_000), 1)
    yield "codec 1: 250 MB declared", sealed(1, bomb, b"", 250_000_000)
    yield "codec 1: 250 MB hidden", sealed(1, bomb, b"", 1000)
    yield "codec 1: a length of 64 bits", sealed(1, bomb, b"", 2**64 - 1)
    yield "codec 2: a count that is free", columns(250_000_000, obstacles=10_000_000, segments=0, body=b"")
    full = 8_000_000
    yield (
        "codec 2: obstacles without segments",
        many_obstacles(56_000, segments=0, counts=b"", kinds=same(17, 1)),
    )
    yield "codec 2: obstacles", many_obstacles(44_000)
    yield "codec 2: as many as the text has room for", many_obstacles(full // 38)
    yield (
        "codec 2: segments",
        columns(
            full, segments=220_000, counts=pack_numbers(np.array([220_000])), steps=b"", kinds=same(17, 1)
        ),
    )
    yield "codec 2: bodies", many_obstacles(44_000, bodies=44_000, body=b"", kinds=same(9, 44_000))
    yield "codec 2: lines of labels", columns(full, heads="\n" * full)
    yield "codec 2: lines of segments' labels", columns(full, tails="\n" * full)
    yield "codec 2: extras that nobody has", columns(full, tails="0;;;\n" + "a=," * (full // 3))
    yield "codec 2: commas", columns(full, heads=";a=" + "," * (full - 10) + ";")
    yield "codec 2: labels repeated", many_obstacles(40_000, heads="x" * 150 + ";")
    yield "codec 2: leading lines", columns(full, meta="".join(f"{n:x}\n" for n in range(full // 7)))
    yield "codec 2: long numbers", columns(full, steps=b"\x00" + b"\x80" * (full - 100) + b"\x01")
    yield "codec 2: many numbers", columns(full, starts=b"\x00" + b"\x01" * (full - 100))
    yield "codec 2: wide numbers", columns(full, starts=b"\x08" + bytes(full - 100))
    yield "codec 2: arrays in arrays", sealed(2, _squeezed(b"\x96" + b"\x81" * full), b"", full)
    yield "codec 2: tags", sealed(2, _squeezed(b"\x96" + b"\xc1" * full), b"", full)
    yield "codec 2: a length of 64 bits", sealed(2, _squeezed(b"\x96\x5b" + b"\xff" * 8), b"", full)
    yield "codec 2: 250 MB hidden", sealed(2, _squeezed(bytes(250_000_000)), b"", full)


def _squeezed(content: bytes) -> bytes:
    filters = [{"id": lzma.FILTER_LZMA1, "lc": 0, "lp": 0, "pb": 0, "preset": 0, "dict_size": 65_536}]
    # 250 MB are pressed in two thirds of the time.
    filters[0] |= {"nice_len": 273, "depth": 1}
    return lzma.compress(content, format=lzma.FORMAT_RAW, filters=filters)


def cost(read: Callable[[], object]) -> float:
    """Return the seconds of the processor that reading takes, or refusing to."""
    began = time.process_time()
    with contextlib.suppress(RobotMapError):
        read()
    return time.process_time() - began


def main() -> None:
    """Read the maps that :func:`store` wrote, and print what each cost."""
    for name, content in _stored(Path(sys.argv[1])):
        # From here on the most memory is counted anew.
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
        seconds = cost(partial(decode, content) if content.startswith(b"RMAP") else partial(_text, content))
        print(f"{seconds:.3f} {_most_memory()} {len(content)} {name}", flush=True)


def _most_memory() -> int:
    # What getrusage says is that of the process that started this one, where that had more.
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmHWM"))) // 1024


def store(file: Path) -> None:
    """Write all maps into one file."""
    maps = [*((name, make().encode()) for name, make in texts(SIZE - 40).items()), *binaries()]
    parts = [struct.pack("<II", len(name), len(content)) + name.encode() + content for name, content in maps]
    file.write_bytes(b"".join(parts))


def _text(content: bytes) -> RobotMap:
    return read_text(content.decode())


def _stored(file: Path) -> Iterator[tuple[str, bytes]]:
    with file.open("rb") as maps:
        while head := maps.read(8):
            of_name, of_content = struct.unpack("<II", head)
            yield maps.read(of_name).decode(), maps.read(of_content)


if __name__ == "__main__":
    main()
