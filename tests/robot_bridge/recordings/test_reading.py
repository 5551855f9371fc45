"""Recordings out of files that are in order, and out of such that are not."""

from __future__ import annotations

import gzip
import math
import time

import pytest

from robot_bridge.recordings import csv_table
from robot_bridge.recordings.csv_table import TableForm
from robot_bridge.recordings.readers import ReadingOptions, read_recording
from robot_bridge.recordings.tracks import RecordingError, Remarks, longest_rising

HEAD = "time,robot,x,y,theta,v\n"
GPX = '<gpx xmlns="http://www.topografix.com/GPX/1/1" version="1.1"><trk><name>car</name>{}</trk></gpx>'
POINT = '<trkpt lat="{}" lon="{}"><ele>200</ele><time>{}</time></trkpt>\n'


@pytest.fixture(autouse=True)
def cheap():
    began = time.process_time()
    yield
    assert time.process_time() - began < 3.0


@pytest.fixture
def read(tmp_path):
    """Read a file of this content: ``read(name, content, **columns)``."""

    def read(name, content, form=TableForm({})):  # noqa: B008 - it does not change
        file = tmp_path / name
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_recording(file, ReadingOptions(form))

    return read


def rows_of(track):
    return list(zip(track.t.tolist(), track.x.tolist(), track.y.tolist(), strict=True))


def test_a_long_table_has_a_track_for_each_robot(read):
    found = read("drive.csv", HEAD + "0,a,1,2,0.5,3\n0,b,5,6,4,-1\n1,a,2,2,,\n")
    a, b = found.tracks
    assert (found.crs, found.count, found.begin, found.end) == (None, 3, 0.0, 1.0)
    assert (a.robot, rows_of(a)) == ("a", [(0, 1, 2), (1, 2, 2)])
    assert (b.theta[0], b.v[0]) == (pytest.approx(4 - math.tau), -1.0)
    # What the second row of a does not say is told from its movement.
    assert (a.theta[1], a.v[1]) == (0.0, 1.0)


def test_a_wide_table_has_columns_for_each_robot_and_empty_cells_say_nothing(read):
    form = TableForm({"x": "{robot} e", "y": "{robot} n", "theta": "{robot} h"}, ";", "ms", "compass")
    found = read("w.csv", "time;r1 e;r1 n;r1 h;r2 e;r2 n;r2 h\n0;1;2;90;;;\n500;1;2;0;7;8;180\n", form)
    r1, r2 = found.tracks
    assert (rows_of(r1), rows_of(r2)) == ([(0, 1, 2), (0.5, 1, 2)], [(0.5, 7, 8)])
    assert r1.theta.tolist() == pytest.approx([0, math.pi / 2])
    assert r2.theta[0] == pytest.approx(-math.pi / 2)
    assert not found.remarks.count


def test_a_table_of_degrees_without_a_robot_is_one_robots_and_dates_are_times(read):
    found = read(
        "tour.csv", "time,lat,lon\n2026-11-21T08:00:00Z,46.8,16.8\n2026-11-21T09:00:01+01:00,46.8,16.9\n"
    )
    (track,) = found.tracks
    assert (found.crs, track.robot) == ("wgs84", "tour")
    assert (track.t[1] - track.t[0], track.x[1]) == (1.0, 16.9)


WRONG_ROWS = [
    ("1,a,nan,2,,", "column x: 'nan' is not a number from"),
    ("1,a,inf,2,,", "column x: 'inf' is not a number from"),
    ("1,a,1e300,2,,", "column x: '1e300' is not a number from"),
    ("1,a,,2,,", "column x: nothing is no number"),
    ("1,a,1,two,,", "column y: 'two' is no number"),
    ("1,a,1,2,,900", "column v: '900' is not a number from -100 to 100"),
    ("soon,a,1,2,,", "column time: 'soon' is no time"),
    ("1790000000000,a,1,2,,", "column time: '1790000000000' is no time in s; give time_unit"),
    ("1, ,1,2,,", "column robot: nothing is no name of a robot"),
    ("1,a,1,2", "4 columns stand there, and row 1 names 6"),
    ("1,a,1,2,,,,,", "9 columns stand there, and row 1 names 6"),
    ("0.5,a,1,2,,", "the time of robot a does not go on: 0.500 s"),
]


@pytest.mark.parametrize(("row", "says"), WRONG_ROWS)
def test_a_row_that_cannot_be_used_is_named_and_all_others_are_played(read, row, says):
    found = read("drive.csv", f"{HEAD}0,a,0,0,,\n0.7,a,1,0,,\n{row}\n2,a,2,0,,\n3,b,1,1,,\n")
    assert [rows_of(track) for track in found.tracks] == [[(0, 0, 0), (0.7, 1, 0), (2, 2, 0)], [(3, 1, 1)]]
    assert found.remarks.count == 1 and "drive.csv: row 4" in found.remarks.texts[0]
    assert says in found.remarks.texts[0]


def test_one_time_that_runs_ahead_costs_one_position(read):
    rows = "".join(f"{9000 if n == 3 else n},a,{n},0,,\n" for n in range(10))
    found = read("drive.csv", HEAD + rows)
    assert found.tracks[0].t.tolist() == [0, 1, 2, 4, 5, 6, 7, 8, 9]
    assert (found.remarks.count, "row 5" in found.remarks.texts[0]) == (1, True)


def test_as_many_values_as_possible_rise():
    assert longest_rising([5, 1, 2, 2, 9, 3, 4]).tolist() == [1, 2, 5, 6]
    assert longest_rising([]).tolist() == []


def test_a_compressed_file_that_is_cut_off_is_played_up_to_there(read):
    import random

    generator = random.Random(1)
    text = HEAD + "".join(f"{n},a,{generator.uniform(0, 100):.6f},0,,\n" for n in range(5000))
    found = read("drive.csv.gz", gzip.compress(text.encode())[:-20_000])
    assert 1000 < found.count < 5000
    assert any("the file is cut off or damaged" in text for text in found.remarks.texts)


REFUSED = [
    ("a.csv", "", "row 1: no names of columns stand there"),
    ("a.csv", "time,robot,lon\n0,a,1\n", "row 1: no column is called x; name the one that holds it"),
    ("a.csv", HEAD, "no position can be used"),
    (
        "a.csv",
        HEAD + "a,b,c,d,e,f\n",
        "no position can be used; the first of 1 remarks: .*row 2: column time",
    ),
    ("a.csv", b"\xff\xfe" + HEAD.encode("utf-16-le"), "row 1: no column is called x"),
    ("a.csv", HEAD + "".join(f"0,r{n},1,1,,\n" for n in range(2001)), "more than 2000 robots"),
    ("a.csv", "x" * 2_000_000, "a line has more than 1048576 characters"),
    ("a.csv.gz", b"nonsense", "cannot be read: Not a gzipped file"),
    ("a.gpx", "<html><body/></html>", "row 1: it is no GPX: its first element is html"),
    ("a.gpx", "nonsense", "row 1, column 0: what follows cannot be read: syntax error"),
    ("a.gpx", '<!DOCTYPE x [<!ENTITY a "b">]><gpx/>', "it has a document type"),
    ("a.gpx", f'<gpx a="{"x" * 3_000_000}"/>', "a tag has more than 1048576 characters"),
    ("a.gpx", "<gpx>" + "<a>" * 100, "nested deeper than 64 levels"),
    (
        "a.gpx",
        f"<gpx><trk><name>{'n' * 2000}</name></trk></gpx>",
        "element name has more than 1000 characters",
    ),
    (
        "a.gpx",
        GPX.format('<trkseg><trkpt lat="1" lon="2"/></trkseg>'),
        "a track without times cannot be played",
    ),
]


@pytest.mark.parametrize(("name", "content", "says"), REFUSED)
def test_what_holds_no_recording_is_refused(read, name, content, says):
    with pytest.raises(RecordingError, match=says):
        read(name, content)


def test_rows_are_counted_also_where_nothing_stands(tmp_path):
    (tmp_path / "a.csv.gz").write_bytes(gzip.compress(HEAD.encode() + b"\n" * 5000))
    with pytest.raises(RecordingError, match="more than 1000 rows; part the file"):
        list(csv_table._rows(tmp_path / "a.csv.gz", ",", Remarks(), 1000))


def test_a_long_gpx_is_no_long_tag(read):
    points = "".join(
        POINT.format(46.8, 16.8, f"2026-11-21T08:{n // 60:02}:{n % 60:02}Z") for n in range(3600)
    )
    found = read("a.gpx", GPX.format(f"<trkseg>{points}{' ' * 3_000_000}</trkseg>"))
    assert (found.count, found.remarks.count) == (3600, 0)


def test_a_gpx_of_several_segments_is_one_drive_and_bad_points_are_named(read):
    def points(*times):
        return "".join(POINT.format(46.8, 16.8 + t / 1e4, f"2026-11-21T08:00:{t:02}Z") for t in times)

    wrong = POINT.format("NaN", 16.8, "2026-11-21T08:00:02Z")
    segments = f"<trkseg>{points(0, 1)}</trkseg>\n<trkseg>{wrong}{points(30)}</trkseg>"
    found = read("a.gpx", GPX.format(segments))
    (track,) = found.tracks
    assert (found.crs, track.robot, (track.t - track.t[0]).tolist()) == ("wgs84", "car", [0, 1, 30])
    assert abs(track.theta[1]) < 0.01 and track.v[1] == pytest.approx(7.6, abs=0.1)
    assert "row 4, trkpt: column lat: 'NaN' is not a number" in found.remarks.texts[0]

    whole = GPX.format(segments)
    cut = read("b.gpx", whole[: whole.index("2026-11-21T08:00:30") + 8])
    assert cut.count == 2
    assert "what follows cannot be read" in cut.remarks.texts[-1]


def test_the_heading_stays_while_a_robot_stands_and_its_speed_becomes_nought(read):
    rows = [(0, 0), (1, 2), (2, 4), (3, 4.1), (5, 4.1), (6, 4.2)]
    (track,) = read("a.csv", "time,x,y\n" + "".join(f"{t},0,{y}\n" for t, y in rows)).tracks
    assert track.theta.tolist() == pytest.approx([0, *[math.pi / 2] * 5])
    assert track.theta_from.tolist() == [3, 1, 1, 1, 2, 2]
    assert track.v.tolist() == [0, 2, 2, 2, 0, 0]
