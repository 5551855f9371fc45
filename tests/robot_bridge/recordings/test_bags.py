"""Bags that rosbags wrote, whole and cut off in the middle."""

from __future__ import annotations

import math
import shutil
import struct
import tracemalloc

import numpy as np
import pytest
import zstandard

from robot_bridge.recordings.readers import ReadingOptions, read_recording
from robot_bridge.recordings.tracks import RecordingError

pytest.importorskip("rosbags.highlevel")
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
ODOMETRY, POSE, FIX = "nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "sensor_msgs/msg/NavSatFix"
COUNT = 3000
BEGIN = 1_790_000_000_000_000_000


def made(store, kind, **fields):
    """Return a message whose other fields are nought."""
    values = {}
    for name, (nodetype, what) in store.fielddefs[kind][1]:
        if name in fields:
            values[name] = fields[name]
        elif int(nodetype) == 1:
            values[name] = "" if what[0] == "string" else 0
        elif int(nodetype) == 2:
            values[name] = made(store, what)
        else:
            values[name] = np.zeros(what[1] or 0, dtype=np.float64)
    return store.types[kind](**values)


def odometry(store, x, y=0.0, w=1.0, v=2.0):
    point = made(store, "geometry_msgs/msg/Point", x=x, y=y)
    rotation = made(store, "geometry_msgs/msg/Quaternion", w=w)
    pose = made(store, "geometry_msgs/msg/Pose", position=point, orientation=rotation)
    linear = made(store, "geometry_msgs/msg/Vector3", x=v)
    twist = made(store, "geometry_msgs/msg/Twist", linear=linear)
    return made(
        store,
        ODOMETRY,
        pose=made(store, "geometry_msgs/msg/PoseWithCovariance", pose=pose),
        twist=made(store, "geometry_msgs/msg/TwistWithCovariance", twist=twist),
    )


def drive(store):
    """Yield topic, type, nanoseconds and message of two robots; one says NaN and no rotation, each once."""
    for n in range(COUNT):
        x = math.nan if n == 2 else n / 10
        yield "/r1/odom", ODOMETRY, BEGIN + n * 100_000_000, odometry(store, x, w=3.0 if n == 4 else 1.0)
        point = made(store, "geometry_msgs/msg/Point", x=n / 10, y=5.0)
        half = math.sqrt(0.5)
        rotation = made(store, "geometry_msgs/msg/Quaternion", z=half, w=half)
        pose = made(store, "geometry_msgs/msg/Pose", position=point, orientation=rotation)
        yield "/fleet/r2/pose", POSE, BEGIN + n * 100_000_000, made(store, POSE, pose=pose)


@pytest.fixture(scope="module")
def bags(tmp_path_factory):
    """One drive as each kind of bag, and a file of each."""
    folder = tmp_path_factory.mktemp("bags")
    files = {}
    for kind, plugin, packed in (
        ("mcap", StoragePlugin.MCAP, False),
        ("mcap-zstd", StoragePlugin.MCAP, True),
        ("db3", StoragePlugin.SQLITE3, False),
    ):
        bag = Writer(folder / kind, version=9, storage_plugin=plugin)
        if packed:
            bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        with bag:
            _write(bag, ROS2, ROS2.serialize_cdr)
        files[kind] = next(file for file in (folder / kind).iterdir() if file.suffix in (".mcap", ".db3"))
    for kind, form in (("bag", None), ("bag-bz2", "BZ2"), ("bag-lz4", "LZ4")):
        bag = Writer1(folder / f"{kind}.bag")
        if form:
            bag.set_compression(Writer1.CompressionFormat[form])
        with bag:
            _write(bag, ROS1, ROS1.serialize_ros1)
        files[kind] = folder / f"{kind}.bag"
    return files


def _write(bag, store, serialize):
    connections = {}
    for topic, kind, at, message in drive(store):
        if topic not in connections:
            connections[topic] = bag.add_connection(topic, kind, typestore=store)
        bag.write(connections[topic], at, serialize(message, kind))


KINDS = ("mcap", "mcap-zstd", "db3", "bag", "bag-bz2", "bag-lz4")


@pytest.mark.parametrize("kind", KINDS)
def test_a_bag_is_read_and_what_is_nonsense_in_it_is_named(bags, kind):
    found = read_recording(bags[kind], ReadingOptions())
    r1, r2 = found.tracks
    assert (found.crs, r1.robot, r2.robot) == (None, "r1", "fleet/r2")
    assert (len(r1.t), len(r2.t)) == (COUNT - 2, COUNT)
    assert r2.t.tolist() == pytest.approx([BEGIN / 1e9 + n / 10 for n in range(COUNT)], abs=1e-6)
    assert r2.x.tolist() == [n / 10 for n in range(COUNT)]
    assert (r1.theta[0], r2.theta[0], r1.v[0]) == (0.0, pytest.approx(math.pi / 2), 2.0)
    assert [text.split(" of ")[1] for text in found.remarks.texts] == [
        "/r1/odom: column position.x: nan is not a number from -1e+08 to 1e+08",
        "/r1/odom: column orientation.w: 3.0 is not a number from -2 to 2",
    ]


def cut_off(bag, share, folder):
    cut = folder / bag.name
    shutil.copy(bag, cut)
    with cut.open("r+b") as file:
        file.truncate(int(cut.stat().st_size * share))
    return cut


@pytest.mark.parametrize(("kind", "share"), [(kind, 0.98 if kind == "db3" else 0.5) for kind in KINDS])
def test_a_bag_that_is_cut_off_is_played_up_to_there(bags, tmp_path, kind, share):
    found = read_recording(cut_off(bags[kind], share, tmp_path), ReadingOptions())
    assert COUNT / 2 < found.count < 2 * COUNT - 2
    assert "nothing behind is read: " in found.remarks.texts[-1]


def test_a_bag_in_sqlite_that_lost_its_tree_of_pages_is_refused(bags, tmp_path):
    with pytest.raises(
        RecordingError, match=r"no topic tells a position; .*\d+ bytes are missing at its end"
    ):
        read_recording(cut_off(bags["db3"], 0.5, tmp_path), ReadingOptions())


def test_topics_are_chosen_and_two_of_one_robot_are_refused(tmp_path):
    bag = Writer(tmp_path / "two", version=9, storage_plugin=StoragePlugin.MCAP)
    with bag:
        odom = bag.add_connection("/r1/odom", ODOMETRY, typestore=ROS2)
        fix = bag.add_connection("/r1/fix", FIX, typestore=ROS2)
        other = bag.add_connection("/r2/fix", FIX, typestore=ROS2)
        for n in range(3):
            bag.write(odom, BEGIN + n, ROS2.serialize_cdr(odometry(ROS2, n / 10), ODOMETRY))
            place = made(ROS2, FIX, latitude=46.8 + n / 1e4, longitude=16.8)
            for one in (fix, other):
                bag.write(one, BEGIN + n * 10**9, ROS2.serialize_cdr(place, FIX))
    with pytest.raises(RecordingError, match=r"/r1/odom and /r1/fix both tell where robot 'r1' is; choose"):
        read_recording(tmp_path / "two", ReadingOptions())
    with pytest.raises(RecordingError, match="in degrees and in metres"):
        read_recording(tmp_path / "two", ReadingOptions(topics=("/r1/odom", "/r2/fix")))
    with pytest.raises(RecordingError, match="none of the topics asked for tells a position"):
        read_recording(tmp_path / "two", ReadingOptions(topics=("/r3/*",)))
    found = read_recording(tmp_path / "two", ReadingOptions(topics=("/*/fix",)))
    assert (found.crs, found.count, found.tracks[0].x[0]) == ("wgs84", 6, 16.8)


NONSENSE = [
    b"",
    b"nonsense" * 100,
    b"#ROSBAG V2.0\n\xff\xff\xff\xff",
    b"\x89MCAP0\r\n\x05" + b"\xff" * 8,
    b"SQLite format 3\0" + b"\xff" * 100,
]


@pytest.mark.parametrize("name", ["a.mcap", "a.db3", "a.bag"])
@pytest.mark.parametrize(
    "content", [b"", b"nonsense" * 100, b"#ROSBAG V2.0\n\xff\xff\xff\xff", b"\x89MCAP0\r\n\x05" + b"\xff" * 8]
)
def test_a_file_that_is_no_bag_is_refused(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(RecordingError, match="no topic tells a position"):
        read_recording(tmp_path / name, ReadingOptions())


@pytest.mark.parametrize("says", [10, 1 << 40])
@pytest.mark.parametrize("way", ["zstd", "lz4"])
def test_a_chunk_that_unpacks_to_more_than_it_says_is_refused(tmp_path, way, says):
    lz4_frame = pytest.importorskip("lz4.frame")
    content = bytes(50_000_000)
    packed = lz4_frame.compress(content) if way == "lz4" else zstandard.ZstdCompressor().compress(content)
    chunk = struct.pack("<QQQI", 0, 0, says, 0) + struct.pack("<I", len(way)) + way.encode()
    chunk += struct.pack("<Q", len(packed)) + packed
    (tmp_path / "a.mcap").write_bytes(b"\x89MCAP0\r\n" + struct.pack("<BQ", 6, len(chunk)) + chunk)
    del content
    tracemalloc.start()
    try:
        with pytest.raises(RecordingError, match="nothing behind is read"):
            read_recording(tmp_path / "a.mcap", ReadingOptions())
        assert tracemalloc.get_traced_memory()[1] < 20_000_000
    finally:
        tracemalloc.stop()
