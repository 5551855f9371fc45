"""Messages survive the wire, and a message that cannot be understood is named by operation and parameter."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.messages.administration import Hello, SiteReport, site_report
from robot_bridge.core.messages.base import DESK_REQUESTS, MessageError, check_robot_name, to_json
from robot_bridge.core.messages.commands import (
    AbortAll,
    CommandReport,
    CommandState,
    CommandStep,
    GetCommands,
    Send,
    SetPositions,
    TargetPosition,
    command_report,
)
from robot_bridge.core.messages.positions import (
    AlarmLimits,
    FindRobots,
    GetPositions,
    RobotReport,
    Subscribe,
    View,
    robot_report,
)
from robot_bridge.core.messages.robots import (
    ANSWERS,
    REQUESTS,
    Abort,
    Alive,
    GetMap,
    GetPath,
    GetPosEnd,
    GetPosIni,
    OpAck,
    Ready,
    SendGPS,
    SendImage,
    SendPos,
    SetMap,
    SetObject,
    SetPath,
    SetPosEnd,
    SetPosIni,
    Start,
    Stopped,
)
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.protocol.codec import (
    UnknownOperationError,
    decode_answer,
    decode_desk_request,
    decode_request,
    params_of,
    parse_params,
    payload_of,
)

metres = st.floats(-1e6, 1e6)
speeds = st.floats(-100, 100)
heights = st.floats(-1e4, 1e4)
ids = st.integers(1, 2**63 - 1)
texts = st.text(max_size=40)
words = st.text(st.characters(categories=["L", "N", "P"]), min_size=1, max_size=40)


def through_json(values):
    return json.loads(json.dumps(values))


REQUEST_MESSAGES = st.one_of(
    st.builds(Ready, magic=st.integers(0, 2**63 - 1)),
    st.just(Stopped()),
    st.just(Alive()),
    st.builds(OpAck, id=st.none() | ids, ok=st.booleans(), reason=st.none() | texts),
    st.builds(
        SendPos,
        x=metres,
        y=metres,
        theta=metres,
        v=speeds,
        t=st.none() | metres,
        battery=st.none() | st.floats(0, 1),
        status=st.none() | texts,
    ),
    st.builds(GetMap, x=metres, y=metres, area=st.floats(0.01, 1e9)),
    st.builds(
        SendGPS,
        lat=st.floats(-90, 90),
        lon=st.floats(-180, 180),
        altitude=st.none() | heights,
        heading=st.none() | st.floats(0, 360),
        v=st.none() | speeds,
        accuracy=st.none() | st.floats(0, 100),
    ),
    st.sampled_from([GetPath(), GetPosIni(), GetPosEnd()]),
    st.builds(
        SetObject,
        x=metres,
        y=metres,
        object=words,
        label=st.none() | words,
        height=st.none() | st.floats(0, 100),
        radius=st.none() | st.floats(0.01, 50),
        source=st.none() | words,
    ),
    st.builds(SendImage, image=st.binary(max_size=40), x=metres, y=metres, object=words, source=words),
)
ANSWER_MESSAGES = st.one_of(
    st.just(Start()),
    st.just(Abort()),
    st.builds(OpAck, id=ids, magic=ids, robot=texts),
    st.builds(SetPath, points=st.lists(st.tuples(metres, metres), min_size=2, max_size=6)),
    st.builds(SetPosIni, x=metres, y=metres, theta=st.none() | metres),
    st.builds(SetPosEnd, x=metres, y=metres, theta=st.none() | metres, cone=st.booleans()),
)


@given(REQUEST_MESSAGES)
def test_a_request_comes_out_of_json_as_it_went_in(request):
    op, params = type(request).__name__, through_json(params_of(request))
    assert decode_request(op, params) == request
    assert decode_request(op, through_json(to_json(request)), payload_of(request)) == request


@given(ANSWER_MESSAGES)
def test_an_answer_comes_out_of_json_as_it_went_in(answer):
    assert decode_answer(type(answer).__name__, through_json(to_json(answer))) == answer


@given(st.binary(max_size=200))
def test_a_map_travels_in_the_payload_and_inside_json(content):
    assert decode_answer("SetMap", None, content) == SetMap(content)
    assert decode_answer("SetMap", through_json(params_of(SetMap(content)))) == SetMap(content)
    assert payload_of(SetMap(content)) == content
    assert to_json(SetMap(content)) == {}


@pytest.mark.parametrize(
    "request_",
    [
        Hello("Ada", 1),
        Subscribe(rate=2.0),
        Subscribe(view=View((0.0, 1.0, 2.5, 3.0), ["r1"], 100, AlarmLimits(None, 1.5, 0.0))),
        FindRobots("r", "r1", 10),
        FindRobots("r1", whole=True),
        GetPositions(),
        GetPositions(View((0.0, 1.0, 2.5, 3.0), ["r1"], 100)),
        SetPositions([TargetPosition("r1", 1.0, 2.0, 0.5, cone=True), TargetPosition("r2", 3.0, 4.0)]),
        Send("command-1", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0}),
        AbortAll(),
        GetCommands(robot="r1", limit=5),
    ],
)
def test_what_an_operator_asks_comes_out_of_json_as_it_went_in(request_):
    assert decode_desk_request(request_.method, through_json(to_json(request_))) == request_


def test_reports_come_out_of_json_as_they_went_in():
    step = CommandStep(CommandState.QUEUED, 12.5, "Ada")
    reports = [
        (robot_report, RobotReport("r1", RobotState.STALE, 3.5, "sql", x=1.0, y=2.0, theta=0.1, v=0.0)),
        (
            command_report,
            CommandReport(
                "c-1", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0}, "Ada", CommandState.QUEUED, [step], 0.05
            ),
        ),
        (
            site_report,
            SiteReport("s", "S", 1, "EPSG:32633", (1.0, 2.0), 0.0, (0.0, 0.0, 9.0, 9.0), 0.2, 3.0, 10.0),
        ),
    ]
    for read, report in reports:
        values = through_json(to_json(report))
        assert read(values) == report
        assert read({**values, "of_a_newer_gateway": 1}) == report


# --- what cannot be understood ----------------------------------------------------------------------------

GOOD_POSE = {"x": 1, "y": 2, "theta": 0, "v": 0}

WRONG_REQUESTS = [
    ("SendPos", {k: v for k, v in GOOD_POSE.items() if k != "theta"}, "`theta`"),
    ("SendPos", {**GOOD_POSE, "x": "12"}, "$.x"),
    ("SendPos", {**GOOD_POSE, "x": None}, "$.x"),
    ("SendPos", {**GOOD_POSE, "x": True}, "$.x"),
    ("SendPos", {**GOOD_POSE, "x": 10**400}, "$.x"),
    ("SendPos", {**GOOD_POSE, "y": math.nan}, "y is nan"),
    ("SendPos", {**GOOD_POSE, "v": math.inf}, "v is inf"),
    ("SendPos", {**GOOD_POSE, "t": -math.inf}, "t is -inf"),
    ("SendPos", {**GOOD_POSE, "battery": 1.01}, "battery is 1.01"),
    ("SendPos", {**GOOD_POSE, "battery": -0.5}, "battery is -0.5"),
    ("SendPos", {**GOOD_POSE, "status": 7}, "$.status"),
    ("Ready", None, "`magic`"),
    ("Ready", {"magic": 1.5}, "$.magic"),
    ("Ready", {"magic": "1"}, "$.magic"),
    ("Ready", {"magic": 10**30}, "magic is 1000"),
    ("OpAck", {"id": "x"}, "$.id"),
    ("OpAck", {"id": 2**63}, "id is 9223372036854775808"),
    ("OpAck", {"id": 1, "ok": 1}, "$.ok"),
    ("GetMap", {"x": 1, "y": 2}, "`area`"),
    ("GetMap", {"x": 1, "y": 2, "area": 0}, "area is 0"),
    ("GetMap", {"x": 1, "y": 2, "area": -4}, "area is -4"),
    ("GetMap", {"x": math.nan, "y": 2, "area": 4}, "x is nan"),
    ("GetMap", [1, 2, 4], "params is list"),
    ("Alive", "now", "params is str"),
    ("SendPos", {**GOOD_POSE, "accuracy": -1}, "accuracy is -1"),
    ("SendPos", {**GOOD_POSE, "battery": math.nan}, "battery is nan"),
    ("SendPos", {**GOOD_POSE, "theta_from": "guess"}, "$.theta_from"),
    ("SendGPS", {"lat": 50}, "`lon`"),
    ("SendGPS", {"lat": 90.5, "lon": 0}, "lat is 90.5; give a number from -90 to 90"),
    ("SendGPS", {"lat": 0, "lon": -181}, "lon is -181"),
    ("SendGPS", {"lat": math.nan, "lon": 0}, "lat is nan"),
    ("SendGPS", {"lat": 0, "lon": 0, "heading": -90}, "heading is -90"),
    ("SendGPS", {"lat": 0, "lon": 0, "altitude": math.inf}, "altitude is inf"),
    ("SetObject", {"x": 1, "y": 2}, "`object`"),
    ("SetObject", {"x": 1, "y": 2, "object": 7}, "$.object"),
    ("SetObject", {"x": 1, "y": 2, "object": 129 * "a"}, "give 1 to 128 printable characters"),
    ("SetObject", {"x": 1, "y": 2, "object": "a\nb"}, "object is 'a\\nb'"),
    ("SetObject", {"x": 1, "y": 2, "object": "a", "radius": 0}, "radius is 0"),
    ("SetObject", {"x": 1, "y": 2, "object": "a", "height": -1}, "height is -1"),
    ("SetObject", {"x": math.inf, "y": 2, "object": "a"}, "x is inf"),
    ("SendImage", {"x": 1, "y": 2, "object": "a", "image": "no base64!"}, "image is not base64"),
    ("SendImage", {"image": "", "x": 1, "y": 2}, "`object`"),
]


@pytest.mark.parametrize(("op", "params", "names"), WRONG_REQUESTS)
def test_a_wrong_request_is_named_by_operation_and_parameter(op, params, names):
    with pytest.raises(MessageError) as caught:
        decode_request(op, params)
    assert str(caught.value).startswith(f"{op}: ")
    assert names in str(caught.value)


WRONG_ANSWERS = [
    ("SetPosEnd", {"x": 1}, "`y`"),
    ("SetPosEnd", {"x": 1, "y": math.nan}, "y is nan"),
    ("SetPosEnd", {"x": 1, "y": 2, "theta": math.inf}, "theta is inf"),
    ("SetPosEnd", {"x": 1, "y": 2, "cone": "yes"}, "$.cone"),
    ("SetPosIni", {"x": 1}, "`y`"),
    ("SetPosIni", {"x": 1, "y": 2, "theta": math.nan}, "theta is nan"),
    ("SetPath", {"points": [[1, 2], [3, 4]], "theta": math.inf}, "theta is inf"),
    ("SetPath", {}, "`points`"),
    ("SetPath", {"points": []}, "points holds 0 points"),
    ("SetPath", {"points": [[1, 2]]}, "points holds 1 points"),
    ("SetPath", {"points": [[1, 2], [3]]}, "$.points[1]"),
    ("SetPath", {"points": [[1, 2], [3, "4"]]}, "$.points[1][1]"),
    ("SetPath", {"points": [[1, 2], [3, math.nan]]}, "points[1].y is nan"),
]


@pytest.mark.parametrize(("op", "params", "names"), WRONG_ANSWERS)
def test_a_wrong_answer_is_named_by_operation_and_parameter(op, params, names):
    with pytest.raises(MessageError) as caught:
        decode_answer(op, params)
    assert str(caught.value).startswith(f"{op}: ")
    assert names in str(caught.value)


WRONG_DESK_REQUESTS = [
    ("hello", {}, "`operator`"),
    ("subscribe", {"rate": 0}, "rate is 0"),
    ("subscribe", {"rate": 51}, "rate is 51"),
    ("subscribe", {"rate": math.nan}, "rate is nan"),
    ("subscribe", {"view": {}}, "bounds"),
    ("subscribe", {"view": {"bounds": [0, 0, 1]}}, "bounds"),
    ("subscribe", {"view": {"bounds": [0, 0, 0, 1]}}, "x_min < x_max"),
    ("subscribe", {"view": {"bounds": [0, 2, 1, 1]}}, "y_min < y_max"),
    ("subscribe", {"view": {"bounds": [0, 0, math.nan, 1]}}, "bounds is"),
    ("subscribe", {"view": {"bounds": [-math.inf, 0, 1, 1]}}, "bounds is"),
    ("subscribe", {"view": {"bounds": [0, 0, 2e8, 1]}}, "from -1e+08 to 1e+08"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "most": 0}}, "most is 0"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "most": 5001}}, "most is 5001"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "always": ["r"] * 501}}, "always has 501 robots"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "always": ["a b"]}}, "robot name 'a b'"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "alarms": {"low_battery": 1.1}}}, "low_battery is 1.1"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "alarms": {"unsure": math.nan}}}, "unsure is nan"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "alarms": {"outside": -1}}}, "outside is -1"),
    ("subscribe", {"view": {"bounds": [0, 0, 1, 1], "area": 1}}, "view.area is no parameter"),
    ("find_robots", {"text": "x" * 64}, "text has 64 characters"),
    ("find_robots", {"after": "x" * 64}, "after has 64 characters"),
    ("find_robots", {"limit": 0}, "limit is 0"),
    ("find_robots", {"limit": 501}, "limit is 501"),
    ("send", {"command": "short", "robot": "r1", "op": "SetPosEnd"}, "command is 'short'"),
    ("send", {"command": "long enough", "op": "Abort"}, "`robot`"),
    ("set_positions", {"positions": [{"robot": "r1", "x": 1}]}, "$.positions[0]"),
    ("set_positions", {"positions": [{"robot": "r1", "x": 1, "y": math.inf}]}, "y is inf"),
    ("get_commands", {"limit": 0}, "limit is 0"),
    ("get_observations", {"state": "lost"}, "$.state"),
    ("get_observations", {"limit": 0}, "limit is 0"),
    ("get_observations", {"before": -1}, "before is -1"),
    ("get_image", {}, "`observation`"),
    ("review_observation", {"observation": 1}, "`accept`"),
    ("review_observation", {"observation": 1, "accept": False, "height": 1}, "are for what is accepted"),
    ("review_observation", {"observation": 1, "accept": True, "semantics": ""}, "semantics is ''"),
    ("get_commands", {"limit": 10_001}, "limit is 10001"),
]


@pytest.mark.parametrize(("method", "params", "names"), WRONG_DESK_REQUESTS)
def test_a_wrong_desk_request_is_named_by_method_and_parameter(method, params, names):
    with pytest.raises(MessageError) as caught:
        decode_desk_request(method, params)
    assert str(caught.value).startswith(f"{method}: ")
    assert names in str(caught.value)


@pytest.mark.parametrize(
    ("decode", "table"),
    [(decode_request, REQUESTS), (decode_answer, ANSWERS), (decode_desk_request, DESK_REQUESTS)],
)
def test_an_unknown_operation_is_named_together_with_the_known_ones(decode, table):
    with pytest.raises(UnknownOperationError) as caught:
        decode("Fly", {})
    assert "'Fly'" in str(caught.value)
    assert all(name in str(caught.value) for name in table)


def test_a_map_without_its_payload_is_refused():
    with pytest.raises(MessageError, match="SetMap came without its payload"):
        decode_answer("SetMap", {})


@pytest.mark.parametrize("text", [None, 5, "not base64!", "AAA", "ä"])
def test_a_map_that_is_not_base64_is_refused(text):
    with pytest.raises(MessageError, match="SetMap: map is not base64"):
        decode_answer("SetMap", {"map": text})


@pytest.mark.parametrize("text", ["{", "nothing", '{"x": NaN}', '{"x": 1e400}', b"\xff", "[" * 100_000])
def test_params_that_are_not_json_are_refused_with_their_beginning(text):
    with pytest.raises(MessageError, match="SendPos: params is not JSON") as caught:
        parse_params("SendPos", text)
    assert str(text)[:5] in str(caught.value) or isinstance(text, bytes)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize("text", [None, "", b""])
def test_an_empty_params_column_means_no_parameters(text):
    assert parse_params("Alive", text) is None


@pytest.mark.parametrize("name", ["r1", "R-2", "7", "a" * 63, "robot_1.b"])
def test_a_robot_may_be_called(name):
    assert check_robot_name(name) == name


@pytest.mark.parametrize("name", ["", " r1", "r 1", "-r1", "a" * 64, "r1\n", "r1;drop", "é", "../r1"])
def test_a_robot_may_not_be_called(name):
    with pytest.raises(MessageError, match="cannot be used; take 1 to 63"):
        check_robot_name(name)
