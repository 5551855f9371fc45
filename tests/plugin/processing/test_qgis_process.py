"""``qgis_process`` as a process of its own, with no display, on real layers."""

from __future__ import annotations

import os
import re
import signal
import subprocess

import numpy as np
import pyogrio
import pytest
import shapely
from fleet_supervisor.robot_bridge.core.robotmap.text_format import read_text

CAMPUS_LAYERS = ("buildings", "walls", "furniture")
HELSINKI_LAYERS = ("buildings", "barriers")
HELSINKI_WINDOW = (385700.0, 6671500.0, 386100.0, 6671900.0)
ROUNDING_M = 0.01


@pytest.fixture(scope="module")
def campus(data):
    return data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"


@pytest.fixture(scope="module")
def helsinki(data):
    return data / "osm" / "helsinki_centre_utm35n.gpkg"


@pytest.fixture(scope="module")
def campus_text(campus, export_by_process):
    """The campus exported once: the finished process and the text of the map."""
    layers = [f"{campus}|layername={name}" for name in CAMPUS_LAYERS]
    done, file = export_by_process(*layers, CENTER="48,48", WIDTH=104, HEIGHT=104)
    assert done.status == 0, done.said
    return done, file.read_text()


@pytest.fixture(scope="module")
def helsinki_window(helsinki, export_by_words):
    """A window of Helsinki exported once: the finished run and the map."""
    x_min, y_min, x_max, y_max = HELSINKI_WINDOW
    layers = [f"{helsinki}|layername={name}" for name in HELSINKI_LAYERS]
    done, file = export_by_words(*layers, EXTENT=f"{x_min},{x_max},{y_min},{y_max}")
    assert done.status == 0, done.said
    return done, read_text(file.read_text())


def segments_of(robot_map):
    """Return every segment as (n, 2, 2)."""
    return np.concatenate([np.stack([o.a, o.b], axis=1) for o in robot_map.obstacles])


def named_in(warnings):
    """Return the features, as ``layer:id``, that warnings name one by one."""
    found = (re.match(r"Layer (.+), feature (\d+): ", warning) for warning in warnings)
    return {f"{match[1]}:{match[2]}" for match in found if match}


def test_the_provider_is_there_with_no_display_and_its_help_is_plain_text(qgis_process):
    done = qgis_process("help", "fleet:exportrobotmap")
    assert done.status == 0 and "Arguments" in done.stdout, done.said
    assert done.stdout.startswith("Export robot map (fleet:exportrobotmap)")
    assert "<p>" not in done.stdout and "<strong>" not in done.stdout


def test_the_campus_comes_out_in_the_papers_window_with_its_size(campus_text):
    done, text = campus_text
    assert text.partition("border;\n")[2].startswith("-4;100;\n100;-4;\n#\n")
    size = len(text.encode())
    assert done.result("BYTES") == size
    assert done.result("BYTES_PER_M2") == pytest.approx(size / 104**2)
    assert f"{size} bytes of text, {size / 104**2:.3g} bytes/m² (paper 1: about 3 bytes/m²" in done.said
    assert done.warnings == []


def test_the_campus_has_the_column_of_the_papers_sample_where_the_paper_has_it(campus_text):
    """Fig. 2 gives a face of ``column,A5`` from (4.53, 12.10) to (7.29, 12.10)."""
    robot_map = read_text(campus_text[1])
    faces = segments_of(robot_map)
    level = np.abs(faces[:, :, 1] - 12.2).max(axis=1) < 0.15
    ends = np.sort(faces[level][:, :, 0], axis=1)
    assert (np.abs(ends - (4.50, 7.24)).max(axis=1) < 0.1).any()
    assert {obstacle.semantics for obstacle in robot_map.obstacles} == set(CAMPUS_LAYERS)


def test_the_campus_heights_are_those_of_the_layers(campus_text, campus):
    wanted = heights_in(campus)
    for obstacle in read_text(campus_text[1]).obstacles:
        assert (np.abs(obstacle.height - wanted[obstacle.ext["src"]]) <= 0.0051).all()


def heights_in(file):
    heights = {}
    for name in CAMPUS_LAYERS:
        _, ids, _, (values,) = pyogrio.raw.read(
            file, name, columns=["height"], read_geometry=False, return_fids=True
        )
        heights |= {f"{name}:{fid}": value for fid, value in zip(ids, values, strict=True)}
    return heights


def test_binary_is_the_same_map_and_less_than_the_papers_three_bytes_per_square_metre(
    export, campus, campus_text
):
    layers = [f"{campus}|layername={name}" for name in CAMPUS_LAYERS]
    made = export(*layers, CENTER="48,48", WIDTH=104, HEIGHT=104, FORMAT="binary")
    assert made.text == campus_text[1]
    assert made.results["BYTES"] == made.file.stat().st_size
    assert made.results["BYTES_PER_M2"] < 3


def test_helsinki_counts_every_broken_feature_names_the_first_and_ends_well(export, helsinki):
    x_min, y_min, x_max, y_max = pyogrio.read_info(helsinki, "buildings")["total_bounds"]
    layers = [f"{helsinki}|layername={name}" for name in HELSINKI_LAYERS]
    made = export(*layers, EXTENT=f"{x_min - 5},{x_max + 5},{y_min - 5},{y_max + 5}")
    broken = {f"buildings:{fid}" for fid, shape in features(helsinki, "buildings") if is_broken(shape)}
    assert len(broken) >= 18
    told = [
        re.match(r"Layer buildings, features? ([\d, ]+)(?:and (\d+) more)?", one) for one in made.warnings
    ]
    named = {f"buildings:{fid}" for one in told if one for fid in re.findall(r"\d+", one[1])}
    assert 5 <= len(named) < len(broken) and named <= broken
    assert len(named) + sum(int(one[2] or 0) for one in told if one) == len(broken)
    assert made.results["WARNING_COUNT"] == len(made.warnings)


def test_no_helsinki_feature_in_the_window_is_lost_without_a_word(helsinki_window, helsinki):
    done, robot_map = helsinki_window
    exported = {obstacle.ext["src"] for obstacle in robot_map.obstacles}
    inside = shapely.box(*HELSINKI_WINDOW).buffer(-2 * ROUNDING_M)
    wanted = {
        f"{layer}:{fid}"
        for layer in HELSINKI_LAYERS
        for fid, shape in features(helsinki, layer)
        if shape is not None and outline_of(shape).intersects(inside)
    }
    assert len(wanted) > 100
    assert wanted - exported - named_in(done.warnings) == set()


def test_the_helsinki_segments_are_the_outlines_that_shapely_clips(helsinki_window, helsinki):
    done, robot_map = helsinki_window
    made = shapely.MultiLineString(list(segments_of(robot_map)))
    odd = named_in(done.warnings)
    outlines = [
        outline_of(shape)
        for layer in HELSINKI_LAYERS
        for fid, shape in features(helsinki, layer)
        if shape is not None and f"{layer}:{fid}" not in odd
    ]
    clipped = shapely.intersection(shapely.union_all(outlines), shapely.box(*HELSINKI_WINDOW))
    assert clipped.length > 10_000
    tolerance = 1.5 * ROUNDING_M
    assert shapely.difference(clipped, made.buffer(tolerance)).length < 0.1
    others = [o for o in robot_map.obstacles if o.ext["src"] not in odd]
    sound = shapely.MultiLineString([*np.concatenate([np.stack([o.a, o.b], axis=1) for o in others])])
    assert shapely.difference(sound, clipped.buffer(tolerance)).length < 0.1


def test_solid_helsinki_outlines_have_free_space_to_their_right(helsinki_window, helsinki):
    done, robot_map = helsinki_window
    shapes = {f"buildings:{fid}": shape for fid, shape in features(helsinki, "buildings")}
    odd = named_in(done.warnings)
    checked = 0
    for obstacle in robot_map.obstacles:
        source = obstacle.ext["src"]
        if not source.startswith("buildings:") or source in odd:
            continue
        along = obstacle.b - obstacle.a
        length = np.hypot(*along.T)[:, None]
        long = length[:, 0] > 1.0
        right = (obstacle.a + obstacle.b) / 2 + 0.05 * np.column_stack([along[:, 1], -along[:, 0]]) / length
        shapely.prepare(shapes[source])
        assert not shapely.contains_xy(shapes[source], *right[long].T).any(), source
        checked += long.sum()
    assert checked > 500


@pytest.fixture(scope="module")
def layer_without_crs(tmp_path_factory):
    """A GeoPackage that says that its CRS is not defined."""
    file = tmp_path_factory.mktemp("layers") / "scan.gpkg"
    line = shapely.to_wkb(np.array([shapely.LineString([(0, 5), (50, 5)])]))
    with pytest.warns(UserWarning, match="'crs' was not provided"):
        pyogrio.raw.write(file, line, [np.array([1.0])], ["height"], geometry_type="LineString", crs=None)
    return file


def test_a_refused_export_says_why_and_has_another_exit_status(
    helsinki, layer_without_crs, export_by_process, export_by_words, qgis_process, tmp_path
):
    """What a script sees of the errors that tests inside QGIS prove one by one.

    It sees each as often as one of QGIS's own algorithms.
    """
    away = f"OUTPUT={tmp_path / 'nowhere' / 'x.gpkg'}"
    qgis_own = qgis_process(
        "run", "native:reprojectlayer", "--", f"INPUT={helsinki}|layername=buildings",
        "TARGET_CRS=EPSG:4326", away,
    )  # fmt: skip
    often = qgis_own.said.count("Could not create layer")
    assert qgis_own.status != 0 and often > 0, qgis_own.said
    buildings, here = f"{helsinki}|layername=buildings", {"CENTER": "385900,6671700"}
    for layer, parameters, words, export in (
        (
            buildings,
            {**here, "SITE_CRS": "EPSG:3857"},
            "EPSG:3857 .* its metres are not metres.*UTM zone",
            export_by_process,
        ),
        (
            layer_without_crs,
            {"CENTER": "0,0"},
            "The layer scan has no CRS.*set the layer's CRS.*LOCAL=true",
            export_by_words,
        ),
    ):
        done, file = export(layer, **parameters)
        assert 1 <= len(re.findall(words, done.said)) <= often, done.said
        assert done.status != 0
        assert "Traceback" not in done.said
        assert not file.exists()


def test_a_layer_without_a_crs_is_in_the_site_frame_where_that_is_said(layer_without_crs, export):
    made = export(str(layer_without_crs), CENTER="0,0", LOCAL=True)
    assert segments_of(made.map).tolist() == [[[0, 5], [50, 5]]]


def features(file, layer):
    """Yield (id, geometry) as shapely reads them; None where it cannot."""
    _, ids, shapes, _ = pyogrio.raw.read(file, layer, columns=[], return_fids=True)
    yield from zip(ids, shapely.from_wkb(shapes, on_invalid="ignore"), strict=True)


def is_broken(shape):
    return shape is None or not shape.is_valid or shape.area == 0


def outline_of(shape):
    return shape.boundary if shape.geom_type.endswith("Polygon") else shape


def test_an_export_that_is_interrupted_ends_with_an_error_and_leaves_the_older_map(
    qgis_process_place, helsinki, tmp_path
):
    """A script must not go on with the map of yesterday."""
    program, environment = qgis_process_place
    target = tmp_path / "map.txt"
    target.write_text("an older map")
    words = (
        f"OBSTACLES={helsinki}|layername=buildings",
        "CENTER=385900,6671700",
        "WIDTH=4000",
        "HEIGHT=4000",
    )
    # Each height takes a moment: all of them would take minutes.
    slow = "HEIGHT_EXPRESSION=array_length(generate_series(1, 400000 + $id)) / 1e6"
    process = subprocess.Popen(
        [program, "run", "fleet:exportrobotmap", "--", *words, slow, f"OUTPUT={target}"],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    with process, process.stdout as output:
        said = b""
        while b"0..." not in said:
            some = os.read(output.fileno(), 4096)
            assert some, said.decode()
            said += some
        process.send_signal(signal.SIGINT)
        said += output.read()
    assert b"ERROR:\tIt was cancelled before its end." in said
    assert process.returncode == 1
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"map.txt": "an older map"}
