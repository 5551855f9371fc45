"""``site.cache``: what comes of it is what comes of site.gpkg, and no other file is used in its place."""

from __future__ import annotations

import hashlib
import json
import logging
import shutil
import sqlite3
import struct
from dataclasses import replace

import numpy as np
import pytest

from robot_bridge.core.messages.records import ObservationReport, ObservationState
from robot_bridge.core.robotmap.binary import decode
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.text_format import write_text
from robot_bridge.core.sites import column_file
from robot_bridge.core.sites.column_file import ColumnFile, ColumnFiles, Texts
from robot_bridge.core.sites.column_writers import TextColumns
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.geopackage import Area
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import read_site, write_site
from robot_bridge.core.sites.site_cache import CACHE_FILE
from robot_bridge.gateway.site.site_maps import SiteMaps

SIDE = 300.0
SETTINGS = SiteSettings(
    "town",
    "Town",
    1,
    "EPSG:32633",
    (640420.0, 5193480.0),
    SiteBounds(0.0, 0.0, SIDE, SIDE),
    rotation_deg=30.0,
)
PIT = Area((np.array([[1.0, 1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 1.0]]),), "Pit")
BOX = np.array([[0, 0], [9, 0], [9, 7], [0, 7], [0, 0]])
LINES = np.array([[0, 0], [4, 0], [4, 1], [0, 1]])
GROUPS = ("wall", "building", "bänk")


def town(count=150, height=6.0):
    """Obstacles of all kinds, courtyards, wrong ones and some far away, in no order."""
    chance, rows = np.random.default_rng(3), []
    for k, (x, y) in enumerate(chance.uniform(0, SIDE, (count, 2)).tolist()):
        about = {"height": height, "semantics": f"{GROUPS[k % 3]},no {k % 7}", "source": f"layer:{k}"}
        about |= {"base": 3.0 if k % 11 == 0 else 0.0, "ext": {"h": "est"} if k % 5 == 0 else {}}
        at = np.array([x, y])
        box = BOX + at
        lines = LINES + at
        shapes = list(ShapeType)
        shape = shapes[k % len(shapes)]
        closed = shape in (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)
        rows.append(OutlineRow(box if closed else lines, shape, **about))
        if shape is ShapeType.CLOSED_POLYGON:
            rows.append(OutlineRow(BOX / 3 + at + 2, shape, **about, courtyard=True))
    speck = np.array([[0.0, 0.0], [0.001, 0.0]])
    rows.append(OutlineRow(speck + 50, ShapeType.OPEN_POLYGON, 1.0, "speck", "specks:1"))
    rows.append(OutlineRow(speck + 9000, ShapeType.OPEN_POLYGON, 1.0, "speck", "specks:2"))
    return Outlines.from_rows(rows)


@pytest.fixture(scope="module")
def published(tmp_path_factory):
    """A published town, which nobody changes."""
    written = tmp_path_factory.mktemp("published") / "town"
    write_site(written, SETTINGS, town(), keepouts=[PIT])
    return written


@pytest.fixture
def folder(published, tmp_path):
    """A published town of the test's own."""
    return shutil.copytree(published, tmp_path / "town")


def without_cache(folder):
    kept = (folder / CACHE_FILE).rename(folder / "away")
    site = read_site(folder)
    kept.rename(folder / CACHE_FILE)
    return site


def texts_of(site):
    """The maps of a site as text: the whole one, and windows that cut."""
    windows = [(40.0, 50.0, 900.0), (150.0, 150.0, 10_000.0), (290.0, 20.0, 2500.0), (40.0, 50.0, 0.01)]
    maps = [site.whole_map(), *(site.map_around(*window) for window in windows)]
    return [(write_text(one), one.warnings) for one in maps]


def test_what_comes_of_it_is_what_comes_of_the_layers(folder):
    cached, plain = read_site(folder), without_cache(folder)
    assert cached.cache is not None and plain.cache is None
    for name in ("coordinates", "offsets", "shape_type", "courtyard", "height", "outdoor", "base"):
        np.testing.assert_array_equal(getattr(cached.outlines, name), getattr(plain.outlines, name), name)
    for name in ("semantics", "source", "ext"):
        assert getattr(cached.outlines, name) == list(getattr(plain.outlines, name))
    assert texts_of(cached) == texts_of(plain)
    assert any("specks:1" in warning for warning in cached.whole_map().warnings)
    places = np.random.default_rng(5).uniform(0, SIDE, (400, 2))
    for metres in (0.0, 0.5, 30.0):
        found, wanted = (
            {(k, site.fences.obstacles.name(area)) for k, area in near.T.tolist()}
            for site in (cached, plain)
            for near in [site.fences.obstacles.near(places, metres)]
        )
        assert found == wanted and found


def seen(x, y, label):
    return ObservationReport(7, "r1", "SetObject", "thing", x, y, 0.0, ObservationState.ACCEPTED, label=label)


@pytest.mark.parametrize("packages", ["all", "numpy alone"])
def test_the_whole_map_is_made_once_and_says_what_robots_saw_since(folder, monkeypatch, packages):
    if packages != "all":  # as in QGIS
        monkeypatch.setattr("robot_bridge.core.robotmap.binary._zstandard", _no_zstandard)
        write_site(folder, SETTINGS, town(), keepouts=[PIT])
        monkeypatch.undo()
    cached, plain = SiteMaps(read_site(folder)), SiteMaps(without_cache(folder))
    assert (cached.site.whole_binary() is not None) == (packages == "all")
    assert decode(cached.whole_map()).segment_count > 100
    assert cached.whole_map() == plain.whole_map()
    for maps in (cached, plain):
        maps.show([seen(100.0, 100.0, "bench"), seen(200.0, 200.0, "a tree")])
    assert cached.whole_map() == plain.whole_map()
    assert "a tree" in write_text(decode(cached.whole_map()))


def _no_zstandard():
    from robot_bridge.core.errors import MissingCodecError

    raise MissingCodecError("not here")


def test_a_map_that_is_larger_than_the_site_allows_is_not_kept(folder):
    toml = folder / "site.toml"
    toml.write_text(toml.read_text() + "\n[maps]\nlargest_whole_bytes = 1000\n")
    write_site(folder, replace(SETTINGS, version=2), town())
    site = read_site(folder)
    assert site.cache.whole.texts is None and site.cache.whole.content is None
    assert site.is_too_large(1000) and not site.is_too_large(900_000)
    assert SiteMaps(site).whole_map() is None
    toml.write_text(toml.read_text().replace("= 1000", "= 900000"))
    site = read_site(folder)
    whole = SiteMaps(site).whole_map()
    assert decode(whole).segment_count > 100
    write_site(folder, replace(SETTINGS, version=3), town())
    site = read_site(folder)
    assert not site.is_too_large(len(whole)) and site.is_too_large(len(whole) - 1)


# --- files that are not to be used ------------------------------------------------------------------------


def refusal(folder, caplog):
    """Return why the cache is not used, having seen that the site is read all the same."""
    caplog.clear()
    with caplog.at_level(logging.WARNING):
        site = read_site(folder)
    assert site.cache is None
    assert len(site.outlines) > 0
    (record,) = caplog.records
    assert str(folder / CACHE_FILE) in record.getMessage()
    assert "publish the site again" in record.getMessage()
    return record.getMessage()


@pytest.mark.parametrize("share", [0.0, 0.0005, 0.003, 0.5, 0.9999])
def test_one_that_is_cut_off_is_refused(folder, caplog, share):
    file = folder / CACHE_FILE
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    assert "cut off" in refusal(folder, caplog)


def test_one_with_a_changed_byte_is_refused_wherever_it_is(folder, caplog):
    file = folder / CACHE_FILE
    content = file.read_bytes()
    _about, places = column_file._head(file, file.open("rb"), len(content))
    begins = [0, 9, 20, 60, *(one.offset + one.size // 2 for one in places if one.size)]
    for begin in begins:
        file.write_bytes(content[:begin] + bytes([content[begin] ^ 1]) + content[begin + 1 :])
        refusal(folder, caplog)
    assert len(begins) > 25


@pytest.mark.parametrize(
    "column",
    [
        {"kind": "<f8", "shape": [1 << 50], "sha256": ""},
        {"kind": "<f8", "shape": [1 << 39, 1 << 39], "sha256": ""},
        {"kind": "<f8", "shape": [-1], "sha256": ""},
        {"kind": "|O8", "shape": [1], "sha256": ""},
        {"kind": "<f8", "shape": [1, 1, 1], "sha256": ""},
        {"kind": "<f8", "shape": "8", "sha256": ""},
        {"kind": "<f8"},
        3,
    ],
)
def test_one_that_says_impossible_things_is_refused_before_anything_is_made(folder, caplog, column):
    about = column_file.read_about(folder / CACHE_FILE)
    write_head(folder / CACHE_FILE, {"about": about, "columns": {"rows": column}})
    refusal(folder, caplog)


def write_head(file, head):
    raw = json.dumps(head).encode()
    file.write_bytes(struct.pack("<8sII32s", b"FLEETCOL", 1, len(raw), hashlib.sha256(raw).digest()) + raw)


def test_one_without_a_column_that_is_needed_is_refused(folder, tmp_path, caplog):
    file = folder / CACHE_FILE
    about, arrays = column_file.read_columns(file)
    made = {}
    for name, array in {**arrays, "short": arrays["height"][1:]}.items():
        made[name] = ColumnFile(tmp_path / name, array.dtype, *array.shape[1:])
        made[name].append(array)
    short = made.pop("short")
    for name in ("rows", "fence_low", "source_text", "grid_keys"):
        column_file.write_columns(file, about, {key: one for key, one in made.items() if key != name})
        assert name in refusal(folder, caplog)
    column_file.write_columns(file, about, {**made, "height": short})
    refusal(folder, caplog)


def test_one_of_an_earlier_publication_is_refused(folder, caplog):
    earlier = (folder / CACHE_FILE).read_bytes()
    write_site(folder, replace(SETTINGS, version=2), town(height=9.0))
    (folder / CACHE_FILE).write_bytes(earlier)
    assert "town version 1" in refusal(folder, caplog)


def test_one_of_the_same_version_and_other_obstacles_is_refused(folder, caplog):
    earlier = (folder / CACHE_FILE).read_bytes()
    write_site(folder, SETTINGS, town(height=9.0))
    (folder / CACHE_FILE).write_bytes(earlier)
    assert "its geopackage" in refusal(folder, caplog)


@pytest.mark.parametrize("line", ["rotation_deg = 31.0", "bounds = [0.0, 0.0, 300.0, 200.0]"])
def test_one_of_another_frame_or_other_bounds_is_refused(folder, caplog, line):
    key = line.split()[0]
    lines = (folder / "site.toml").read_text().splitlines()
    (folder / "site.toml").write_text("\n".join(line if one.startswith(key) else one for one in lines))
    refusal(folder, caplog)


def test_it_is_refused_when_somebody_edits_the_layers(folder, caplog):
    with sqlite3.connect(folder / "site.gpkg") as connection:
        named = connection.execute("select name from sqlite_master where type = 'trigger'").fetchall()
        for (name,) in named:
            connection.execute(f'drop trigger "{name}"')
        connection.execute("update obstacles set height_m = 77.0 where source = 'layer:1'")
    connection.close()
    assert "its geopackage" in refusal(folder, caplog)
    assert 77.0 in read_site(folder).outlines.height


def test_it_is_used_after_a_program_has_looked_at_the_layers_as_qgis_does(folder):
    before = (folder / "site.gpkg").read_bytes()
    for mode in ("wal", "delete"):
        connection = sqlite3.connect(folder / "site.gpkg")
        connection.execute(f"pragma journal_mode = {mode}")
        assert connection.execute("select count(*) from obstacles").fetchone()[0] > 100
        connection.close()
        assert read_site(folder).cache is not None
    assert (folder / "site.gpkg").read_bytes() != before


@pytest.mark.parametrize("largest", [0, 1 << 40])
def test_a_file_that_is_cut_off_or_written_over_while_it_is_in_use_changes_nothing(
    folder, monkeypatch, largest
):
    monkeypatch.setattr(column_file, "_LARGE", largest)
    site = read_site(folder)
    wanted = texts_of(without_cache(folder))
    with (folder / CACHE_FILE).open("r+b") as file:
        file.truncate(10)
    assert texts_of(site) == wanted
    write_site(folder, replace(SETTINGS, version=2), town(20))
    assert texts_of(site) == wanted
    assert read_site(folder).version == 2


def test_a_publication_that_the_layers_alone_tell_has_none(folder):
    open_ring = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]])
    broken = OutlineRow(open_ring, ShapeType.RAMP, 1.0, "ramp", "ramps:1")
    write_site(folder, replace(SETTINGS, version=2), Outlines.from_rows([broken]))
    assert not (folder / CACHE_FILE).exists()
    assert len(read_site(folder).outlines) == 1


def test_a_large_site_without_one_is_read_with_a_word_about_it(folder, caplog, monkeypatch):
    (folder / CACHE_FILE).unlink()
    read_site(folder)
    assert not caplog.records
    monkeypatch.setattr("robot_bridge.core.sites.site.MANY", 10)
    assert len(read_site(folder).outlines) > 10
    assert "publish the site again" in caplog.text


def test_texts_come_back_one_by_one(tmp_path):
    texts = ["", "äö", "a" * 1000, "\ud800", ""]
    made = ColumnFiles(tmp_path)
    for name, some in (("few", texts), ("no", [])):
        TextColumns(made, name).add(some)
    found = made.mapped()
    kept = Texts(found["few_text"], found["few_offsets"])
    assert kept == texts
    assert (kept[-2], kept[1:3]) == ("\ud800", texts[1:3])
    with pytest.raises(IndexError):
        kept[5]
    assert Texts(found["no_text"], found["no_offsets"]) == []
