"""Codec 2 read by what docs/robot-map.md says of it, with nothing of the project but its text codec."""

from __future__ import annotations

import lzma

import cbor2
import pytest

from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.text_format import read_text, write_text
from tests.robot_bridge.core.robotmap.rows import box, outlines, row

RING, CHAIN, LOOSE = range(3)


def numbers(column):
    """Yield the numbers of a column; zeros without end where it is empty."""
    if not column:
        while True:
            yield 0
    width, rest = column[0], column[1:]
    if width:
        count = len(rest) // width
        values = [sum(rest[plane * count + k] << 8 * plane for plane in range(width)) for k in range(count)]
    else:
        values, value, shift = [], 0, 0
        for byte in rest:
            value, shift = value | (byte & 127) << shift, shift + 7
            if byte < 128:
                values.append(value)
                value, shift = 0, 0
    yield from (value // 2 if value % 2 == 0 else -(value + 1) // 2 for value in values)


def differences(column, less=0):
    """Yield the numbers of a column of differences."""
    value = 0
    for step in numbers(column):
        value += step + less
        yield value


def metres(centimetres):
    return f"{centimetres / 100:.2f}".rstrip("0").rstrip(".")


def one_body(items, columns):
    """Return the next body: its ST, its form, its steps, and what follows the height of each segment."""
    kind, count, varies = next(columns["kinds"]), next(columns["counts"]), next(columns["varies"])
    form = kind // 8
    ways = {RING: count - 1, CHAIN: count, LOOSE: max(2 * count - 1, 0)}[form]
    steps = [(next(columns["steps"]), next(columns["steps"])) for _ in range(ways)]
    said = {}
    for name, bit in (("tail", 1), ("heights", 2)):
        several = varies & bit
        own = [next(columns[name]) for _ in range(count if several else min(count, 1))]
        said[name] = own if several else own * count
    lines = items[6].split("\n")
    tails = [f"{metres(h)};{lines[t]}" for h, t in zip(said["heights"], said["tail"], strict=True)]
    return kind % 8, form, steps, tails


def text_of(content):
    """Return the text of a map in codec 2."""
    unpacker = lzma.LZMADecompressor(
        lzma.FORMAT_RAW, filters=[{"id": lzma.FILTER_LZMA1, "lc": 0, "lp": 0, "pb": 0, "dict_size": 1 << 22}]
    )
    items = cbor2.loads(unpacker.decompress(content[48:]))
    columns = {
        name: (differences if name == "heights" else numbers)(items[11 + k])
        for k, name in enumerate(("steps", "heights", "varies", "tail", "kinds", "counts"))
    }
    bodies = [one_body(items, columns) for _ in range(items[9])]
    starts, backs, heads = numbers(items[10]), numbers(items[17]), differences(items[18])
    ids, others, number_steps = differences(items[19], 1), numbers(items[20]), numbers(items[21])
    x, y, expected, used = 0, 0, 0, 0
    left, lower, right, upper = map(metres, items[1:5])
    out = [f"%{line}" for line in items[0].split("\n") if line]
    out += ["border;", f"{left};{upper};", f"{right};{lower};", "#"]
    for _ in range(items[7]):
        back = next(backs)
        used += back == 0
        st, form, steps, tails = bodies[used - max(back, 1)]
        head = items[5].split("\n")[next(heads)]
        if "\x01" in head or "\x02" in head:
            number = expected + next(number_steps)
            more = next(others) + len(tails) - 1 if "\x02" in head else 0
            expected = number + more + 1
            written = f"{number}+{more}" if more else str(number)
            head = head.replace("\x01", written).replace("\x02", written)
        out += ["obstacle;", f"{next(ids)};{st};{len(tails)};{head}", "#"]
        x, y = x + next(starts), y + next(starts)
        points = [(x, y)]
        for dx, dy in steps:
            points.append((points[-1][0] + dx, points[-1][1] + dy))
        points += points[:1] if form == RING else []
        for k, tail in enumerate(tails):
            for px, py in points[2 * k : 2 * k + 2] if form == LOOSE else points[k : k + 2]:
                out.append(f"{metres(px)};{metres(py)};")
            out += [tail, "#"]
    return "\n".join(out) + "\n"


def built():
    """A built map with rings, chains, stairs, repeats and sources of every kind."""
    risers = row([(0, 0), (2, 0), (0, 0.3), (2, 0.3)], ShapeType.STAIRS, semantics="stairs", height=0.17)
    benches = [box(3 * k, -8, 3 * k + 1.8, -7.4, source=f"benches:{k}") for k in range(4)]
    walls = [row([(-9, 2), (3, 2), (3, 9 + k)], source=f"walls:{7 * k}+{k}") for k in range(3)]
    rows = [box(5, 5, 400, 15), box(8, 8, 12, 12, courtyard=True), risers, *benches, *walls]
    meta = {"version": "7", "crs": "EPSG:25831", "id": "campus"}
    return write_text(build_map(outlines(*rows), Window(5, 5, 30, 30), meta))


SEVERAL = """\
border;
-4;100;
100;-4;
#
obstacle;
-7;2;2;wall;
#
1;1;
2;-1.5;
0.25;0;brick;
#
5;5;
6;5;
-1;1;;k=v;
#
obstacle;
3;1;0;nothing;src=walls:4;
#
"""


@pytest.mark.parametrize("text", [built(), SEVERAL], ids=["built", "several"])
def test_a_reader_made_from_the_document_reads_codec_2(text):
    assert write_text(read_text(text)) == text
    assert text_of(encode(text, codec=2)) == text
