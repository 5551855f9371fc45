"""Calls that are nearly right: the protocol's names, with values too deep, too long or of another kind."""

from __future__ import annotations

import dataclasses
import functools
import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from hypothesis import strategies as st

from robot_bridge.core.messages.links import GetAreas, LinkHello, LinkPositions, LinkStatus
from robot_bridge.core.messages.robots import REQUESTS
from robot_bridge.core.position_frame import NUMBERS as POSITION_NUMBERS
from robot_bridge.core.position_frame import TEXTS as POSITION_TEXTS
from robot_bridge.core.position_frame import packed_frame

DEPTHS = (20, 500, 2_000, 5_000, 50_000)
TEXTS = (
    "",
    "\x00",
    "a\x00b",
    "\ud800",
    "\udfff low",
    "x" * 600,
    "y" * 70_000,
    "9" * 400,
    "\n\x1b[31m",
    "\u202e",
)
TEXTS += ("' or 1=1 --", "$$; drop table sa; --", "1970-01-01", "NaN", "true", "[[", "{}")
NUMBERS = (10**400, -(10**400), 2**31, 2**63, 2**64, -1, 0, 1e308, -1e308, 5e-324, 1e300, -0.0)
RAW = (
    "NaN",
    "Infinity",
    "-Infinity",
    "1e400",
    "9" * 5000,
    "0x1",
    "01",
    "'a'",
    "\ud7ff",
    '"\\ud800"',
    '"\\u0000"',
)
RAW += ('{"id": true}', '{"id": 1e0}', '{"id": "1"}', '{"id": 1, "id": 2}', "[" * 3 + '"' + "]" * 3)

_text = st.sampled_from(TEXTS) | st.text(max_size=30)
_number = st.sampled_from(NUMBERS) | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
_leaf = st.none() | st.booleans() | _number | _text
_value = st.recursive(
    _leaf,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(_text, inner, max_size=3),
    max_leaves=6,
)


def _nested(kind: str, depth: int, closed: bool) -> str:
    begin, end = {"list": ("[", "]"), "object": ('{"a":', "}"), "pair": ("[1,", "]")}[kind]
    return begin * depth + "1" + (end * depth if closed else "")


deep_texts = st.builds(
    _nested, st.sampled_from(["list", "object", "pair"]), st.sampled_from(DEPTHS), st.booleans()
)
"""JSON, complete or cut off, of more levels than anybody needs."""
json_texts = _value.map(json.dumps) | deep_texts | st.sampled_from(RAW)
"""The text of one value, as it may stand in a call: JSON, and what looks like it."""

_place = st.floats(0.0, 150.0)
_name = st.sampled_from(["bad-ws", "bad-sql", "bad-linked", "bad-linked-2", "nobody"])
_RIGHT: Mapping[str, st.SearchStrategy[Any]] = {
    "robot": _name,
    "other": _name,
    "by": st.sampled_from(["waiting", "way"]),
    "robots": st.lists(_name, max_size=2),
    "operator": st.just("somebody"),
    "role": st.sampled_from(["viewer", "operator", "supervisor"]),
    "command": st.integers(0, 200).map(lambda number: f"fuzzed-{number:04}"),
    "aborts": st.integers(0, 200).map(lambda number: f"fuzzed-{number:04}"),
    "op": st.sampled_from(["SetPosEnd", "SetPath", "Abort", "SetPosIni"]),
    "params": st.fixed_dictionaries({"x": _place, "y": _place})
    | st.lists(st.tuples(_place, _place), min_size=2, max_size=4).map(lambda points: {"points": points})
    | st.just({})
    | st.just({"emergency": True}),
    "revision": st.integers(0, 20),
    "tasks": st.lists(
        st.builds(
            lambda n, x, y: {"task": f"task-{n:04}", "x": x, "y": y}, st.integers(0, 99), _place, _place
        ),
        max_size=3,
    ),
    "task": st.integers(0, 99).map(lambda number: f"task-{number:04}"),
    "positions": st.lists(
        st.builds(lambda robot, x, y: {"robot": robot, "x": x, "y": y}, _name, _place, _place), max_size=2
    ),
    "points": st.lists(st.tuples(_place, _place), max_size=3),
    "reason": st.just("because") | st.none(),
    "ok": st.booleans(),
    "id": st.integers(0, 300),
    "magic": st.integers(0, 3),
    "x": _place,
    "y": _place,
    "theta": st.floats(-3.0, 3.0),
    "v": st.floats(0.0, 2.0),
    "lat": st.floats(46.0, 47.0),
    "lon": st.floats(16.0, 17.0),
    "limit": st.integers(1, 5),
    "rate": st.floats(0.1, 20.0),
    "image": st.just("AAAA"),
    "t": st.floats(0.0, 2e9),
    "protocol": st.just(1),
    "kind": st.just("siege"),
    "abilities": st.lists(st.sampled_from(["targets", "paths", "cones", "map"]), max_size=3),
    "counts": st.dictionaries(st.sampled_from(["found", "faults"]), _number, max_size=2),
    "box": st.tuples(_place, _place, _place, _place),
}


def as_often(strategy: st.SearchStrategy[Any], times: int) -> st.SearchStrategy[Any]:
    """Return a choice that counts as ``times`` others beside it.

    Of one that is named twice Hypothesis drops the second. To make it twice takes Hypothesis seconds: it goes
    through all that a choice is made of before the first example.
    """
    return st.one_of([strategy.map(_same) for _ in range(times)])


def _same(value: Any) -> Any:
    return value


@functools.cache
def _right_value(name: str) -> st.SearchStrategy[str]:
    return _RIGHT.get(name, _leaf).map(json.dumps)


@functools.cache
def _values_of(name: str) -> st.SearchStrategy[str]:
    return _right_value(name) | json_texts


@functools.cache
def _params_of(cls: type[Any]) -> st.SearchStrategy[str]:
    names = [field.name for field in dataclasses.fields(cls)]
    values = st.fixed_dictionaries({}, optional={name: _values_of(name) for name in names})
    every = st.fixed_dictionaries({name: _right_value(name) for name in names})
    return (values | every).map(_object)


def _object(values: Mapping[str, str]) -> str:
    return "{" + ", ".join(f'"{name}": {value}' for name, value in values.items()) + "}"


def calls(methods: Mapping[str, type[Any]]) -> st.SearchStrategy[tuple[str, str]]:
    """Return methods and the text of their params, each method as often as any other."""
    return st.one_of(
        [st.tuples(st.just(name), as_often(_params_of(cls), 3) | json_texts) for name, cls in methods.items()]
    )


def frames(methods: Mapping[str, type[Any]]) -> st.SearchStrategy[str]:
    """Return frames of a WebSocket: calls, notifications, answers to what nobody asked, and less."""
    id_text = st.integers(0, 300).map(str) | json_texts
    one = calls(methods)
    call = st.builds(
        lambda call, id: f'{{"jsonrpc": "2.0", "method": "{call[0]}", "params": {call[1]}, "id": {id}}}',
        one,
        id_text,
    )
    notice = one.map(lambda call: f'{{"jsonrpc": "2.0", "method": "{call[0]}", "params": {call[1]}}}')
    reply = st.builds(
        lambda id, kind, value: f'{{"jsonrpc": "2.0", "id": {id}, "{kind}": {value}}}',
        id_text,
        st.sampled_from(["result", "error"]),
        json_texts,
    )
    return as_often(call, 3) | notice | reply | json_texts


def _of_robots(cls: type[Any]) -> type[Any]:
    names = dict.fromkeys(["robot", *(field.name for field in dataclasses.fields(cls))])
    return dataclasses.make_dataclass(cls.__name__, list(names))


_LINKED = {name: _of_robots(cls) for name, cls in REQUESTS.items()}
_LINKED |= {cls.method: cls for cls in (LinkHello, LinkStatus, GetAreas, LinkPositions)}
_columns = st.lists(st.sampled_from([*POSITION_NUMBERS, *POSITION_TEXTS, "\x00"]), max_size=8)
_numbers_of_rows = st.floats() | st.sampled_from([0.0, 1.0, 20.0, 40.0, 1e308, -1.0])


def _table(
    robots: Sequence[str], columns: Sequence[str], words: Any, numbers: Sequence[float], end: int
) -> bytes:
    head = json.dumps(
        {"method": "positions", "params": {"robots": robots, "columns": columns, "words": words}}
    ).encode()
    values = np.resize(np.array(numbers), (len(columns), len(robots)))
    return packed_frame(head, values)[: -end or None]


_robots_of_rows = st.lists(_name, max_size=4) | st.lists(_text, max_size=3)
tables = st.builds(
    _table,
    _robots_of_rows,
    st.just(["x", "y", "theta", "v", "status"]) | _columns,
    st.lists(_text, max_size=3) | _leaf,
    st.lists(_numbers_of_rows, min_size=1, max_size=9),
    st.sampled_from([0, 0, 0, 1, 8]),
)
"""Binary frames of a link: where many robots are, from nearly right to cut off."""
_linked_reply = st.builds(
    lambda robot, id, kind, value: f'{{"jsonrpc": "2.0", "id": "{robot}/{id}", "{kind}": {value}}}',
    _name,
    st.integers(0, 300) | st.just("emergency-stop") | st.just(10**40),
    st.sampled_from(["result", "error"]),
    json_texts,
)
link_frames = as_often(frames(_LINKED), 2) | tables | _linked_reply
"""What a link may send: calls about its robots and others', about itself, tables, answers."""
