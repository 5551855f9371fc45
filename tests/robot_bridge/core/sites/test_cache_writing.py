"""``site.cache`` is written piece by piece, and holds what all obstacles together come to."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.robotmap.binary import encode, encode_pieces
from robot_bridge.core.robotmap.model import ShapeType
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.window_index import BoxGrid, OutlineIndex, levels_of
from robot_bridge.core.sites import column_file, column_writers
from robot_bridge.core.sites.column_file import CodedTexts, ColumnFiles, RowFile, Texts
from robot_bridge.core.sites.column_writers import CellSorting, CodedTextColumns, median
from robot_bridge.core.sites.fences import FencedRows
from robot_bridge.core.sites.geopackage import extras_text
from robot_bridge.core.sites.site import read_site, write_site
from robot_bridge.core.sites.site_cache import CACHE_FILE, CacheWriter
from robot_bridge.core.sites.site_layers import as_read_back
from tests.robot_bridge.core.sites.dying_writer import PLACES
from tests.robot_bridge.core.sites.test_site_cache import SETTINGS, town
from tests.support.forked_programs import Program
from tests.support.patience import BUSY, START
from tests.support.processes import Processes

PIECEWISE = (column_writers, column_file)


@pytest.fixture(params=[40, 700, 100_000])
def at_once(request, monkeypatch):
    """How many points are in memory together."""
    for module in PIECEWISE:
        monkeypatch.setattr(module, "AT_ONCE", request.param)
    return request.param


def test_pieces_make_the_file_that_all_of_it_makes(tmp_path, at_once):
    flat = np.array([[0.0, 0.0], [5.0, 0.0], [0.0, 0.0], [0.0, 0.0]])
    more = [
        OutlineRow(flat + 70, ShapeType.CLOSED_POLYGON, 1.0, "flat", "flat:1"),
        OutlineRow(flat[:2] + 5e8, ShapeType.OPEN_POLYGON, np.pi, "far", "far:1"),
        OutlineRow(flat[2:] + 80, ShapeType.OPEN_POLYGON, 1.0, "speck", "specks:9"),
    ]
    rows = town(400).rows()
    obstacles = Outlines.from_rows([*rows[:300], *more, *rows[300:]])
    write_site(tmp_path, SETTINGS, obstacles)
    about, arrays = column_file.read_columns(tmp_path / CACHE_FILE)
    whole = as_read_back(obstacles, SETTINGS.frame)
    index, fenced = OutlineIndex.of(whole), FencedRows.of(whole)
    wanted = {name: getattr(whole, name) for name in ("coordinates", "offsets", "shape_type", "base")}
    wanted |= {name: getattr(whole, name) for name in ("courtyard", "height", "outdoor")}
    for name, grid in (("grid", index.grid), ("fence_grid", fenced.grid)):
        wanted |= {f"{name}_keys": grid.cells.keys, f"{name}_starts": grid.cells.starts}
        said = {"origin": grid.cells.origin, "placed": grid.cells.placed, "levels": [*grid.cells.levels]}
        assert about[name] == said
    wanted |= {f"fence_{name}": getattr(fenced, name) for name in ("first", "last", "low", "high")}
    wanted |= {f"note_{name}": getattr(index.notes, name) for name in ("low", "high", "everywhere")}
    wanted |= {"rows": index.rows}
    for name, array in wanted.items():
        np.testing.assert_array_equal(arrays[name], array, name)
        assert arrays[name].dtype == array.dtype, name
    texts = {name: Texts(arrays[f"{name}_text"], arrays[f"{name}_offsets"]) for name in ("note", "source")}
    coded = {
        name: CodedTexts(Texts(arrays[f"{name}_text"], arrays[f"{name}_offsets"]), arrays[f"{name}_codes"])
        for name in ("semantics", "ext")
    }
    assert texts["note"] == list(index.notes.texts) and len(texts["note"]) == 4
    assert texts["source"] == whole.source and coded["semantics"] == whole.semantics
    assert coded["ext"] == [extras_text(one) for one in whole.extras]
    assert arrays["rows"].dtype == np.int64


coordinate = st.one_of(st.integers(-300, 300).map(lambda n: n / 4), st.sampled_from([0.0, -0.0, 1e9, -7e12]))


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(coordinate, coordinate, st.integers(0, 5)), max_size=120), st.data())
def test_boxes_are_put_cell_by_cell_as_in_memory(tmp_path_factory, boxes, data):
    folder = tmp_path_factory.mktemp("sorting")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(column_writers, "AT_ONCE", data.draw(st.integers(1, 9)))
        patch.setattr(column_writers, "_SAMPLED", data.draw(st.integers(1, 3)))
        low = np.array([box[:2] for box in boxes]).reshape(-1, 2)
        high = low + 10.0 ** np.array([box[2] * 2.5 for box in boxes]).reshape(-1, 1)
        rows = np.arange(2 * len(boxes)).reshape(-1, 2)
        sorting, made = CellSorting(folder, "boxes"), ColumnFiles(folder)
        some = data.draw(st.integers(1, 50))
        for begin in range(0, max(len(boxes), 1), some):
            part = slice(begin, begin + some)
            kind = np.int32 if begin % 2 else np.int64
            sorting.add(low[part], levels_of(low[part], high[part]), rows[part].astype(kind))
        about = sorting.sort_into(made, "grid", "rows")
    grid, order = BoxGrid.of(low, high)
    found = made.mapped()
    assert found["rows"].tolist() == rows[order].tolist()
    assert found["grid_keys"].tolist() == grid.cells.keys.tolist()
    assert found["grid_starts"].tolist() == grid.cells.starts.tolist()
    assert (tuple(about["levels"]), about["placed"]) == (grid.cells.levels, grid.cells.placed)
    assert about["origin"] == grid.cells.origin


number = st.one_of(st.floats(allow_nan=False, allow_infinity=False), st.sampled_from([0.0, -0.0, 1.0, -1.0]))


@settings(max_examples=60, deadline=None)
@given(st.lists(number.filter(lambda one: abs(one) < 1e300), min_size=1, max_size=60), st.integers(1, 9))
def test_the_median_of_a_file_is_that_of_the_numbers(tmp_path_factory, numbers, at_once):
    file = RowFile(tmp_path_factory.mktemp("median") / "numbers", np.float64)
    file.append(np.array(numbers))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(column_writers, "AT_ONCE", at_once)
        assert median(file) == np.median(numbers)


# --- memory -----------------------------------------------------------------------------------------------


def street(count):
    """Yield ``count`` buildings, each different from all others, a hundred at a time."""
    box = np.array([[0, 0], [9, 0], [9, 7], [0, 7], [0, 0]])
    for begin in range(0, count, 100):
        places = 17.0 * np.column_stack([np.arange(100), np.full(100, begin / 100)])
        numbers = range(begin, begin + 100)
        yield Outlines(
            coordinates=(box + places[:, None]).reshape(-1, 2),
            offsets=5 * np.arange(101),
            shape_type=np.full(100, int(ShapeType.CLOSED_POLYGON), dtype=np.int8),
            courtyard=np.zeros(100, dtype=bool),
            height=np.arange(100) / 7,
            outdoor=np.ones(100, dtype=bool),
            semantics=[f"building,house number {k}" for k in numbers],
            source=[f"buildings:{k}" for k in numbers],
            ext=[{"ref": str(k)} for k in numbers],
        )


def most_memory(folder, monkeypatch, count):
    """Return the most bytes that were in use while the cache of ``count`` buildings was written."""
    for module in PIECEWISE:
        monkeypatch.setattr(module, "AT_ONCE", 4000)
    monkeypatch.setattr(column_writers, "_SAMPLED", 64)
    monkeypatch.setattr(column_writers, "_MOST_KNOWN", 100_000)
    folder.mkdir()
    (folder / "site.gpkg").write_bytes(b"")
    publication = {"bounds": [0.0, 0.0, 2000.0, 17.0 * count / 100]}
    tracemalloc.start()
    try:
        with CacheWriter(folder / "columns", SETTINGS.frame) as cache:
            for some in street(count):
                cache.add(some)
            cache.write(folder / CACHE_FILE, folder / "site.gpkg", publication, "", 1000)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_a_city_of_many_times_the_buildings_takes_no_more_memory(tmp_path, monkeypatch):
    most_memory(tmp_path / "first", monkeypatch, 1500)  # modules, caches of numpy
    town_took = most_memory(tmp_path / "town", monkeypatch, 1500)
    city_took = most_memory(tmp_path / "city", monkeypatch, 6000)
    assert (tmp_path / "city" / CACHE_FILE).stat().st_size > 2e6
    assert city_took < 1.2 * town_took


def test_texts_that_are_all_different_are_not_all_remembered(tmp_path, monkeypatch):
    monkeypatch.setattr(column_writers, "_MOST_KNOWN", 1000)
    made = ColumnFiles(tmp_path)
    coded, texts = CodedTextColumns(made, "of"), [f"text {k % 40}" for k in range(200)] + ["one"] * 200
    for begin in range(0, len(texts), 50):
        coded.add(texts[begin : begin + 50])
    found = made.mapped()
    assert CodedTexts(Texts(found["of_text"], found["of_offsets"]), found["of_codes"]) == texts
    assert 41 < len(made["of_offsets"]) < 250


def test_a_map_in_pieces_has_the_bytes_of_the_map():
    pieces = [f"%line {k}\n" * 50 for k in range(400)]
    assert encode_pieces(lambda: pieces) == encode("".join(pieces))


# --- what ends in the midst of it -------------------------------------------------------------------------

WRITER = Program(("tests.robot_bridge.core.sites.dying_writer",))


@pytest.mark.parametrize("place", PLACES)
def test_one_that_is_killed_leaves_the_site_as_it_was(tmp_path, place):
    folder = tmp_path / "town"
    write_site(folder, SETTINGS, town())
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    with Processes(tmp_path / "logs") as processes:
        writer = processes.start_forked(WRITER, "writer", [folder, place])
        processes.wait_for_line("writer", "here", START)
        writer.kill()
        writer.wait(BUSY * 5)
    assert any(file.is_dir() for file in folder.iterdir())
    assert {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()} == before
    site = read_site(folder)
    assert site.version == 1 and site.cache is not None
    write_site(folder, replace(SETTINGS, version=2), town(200))
    assert read_site(folder).version == 2


def test_a_full_disk_leaves_the_site_as_it_was_and_nothing_else(tmp_path, monkeypatch):
    write_site(tmp_path, SETTINGS, town())
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(column_writers._CellColumns, "add", refuse)
    with pytest.raises(Exception, match="No space left on device"):
        write_site(tmp_path, replace(SETTINGS, version=2), town(200))
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before
