"""Tables of cones are read by named columns; what cannot be read is named by row and column."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robot_bridge.core.errors import ConeTableError
from robot_bridge.core.layouts.cone_files import ConeColumns, cones_of, read_csv


def written(folder: Path, text: str) -> Path:
    file = folder / "cones.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_columns_are_mapped_and_cones_sorted_by_order(tmp_path: Path) -> None:
    head, rows = read_csv(written(tmp_path, "no,east,north,turned,paint\n2,5,6,90,blue\n1,3,4,0,\n"))
    columns = ConeColumns(x="east", y="north", order="no", heading="turned", colour="paint")
    first, second = cones_of(rows, head, columns, "mine")
    assert (first.x, first.y, first.order, first.colour, first.id) == (3, 4, 1, "orange", "mine-2")
    assert (second.x, second.y, second.colour) == (5, 6, "blue")
    assert (first.theta, second.theta) == pytest.approx((math.pi / 2, 0))


def test_the_real_layouts_are_read_one_by_one(data: Path) -> None:
    head, rows = read_csv(data / "cones" / "cone_layouts.csv")
    columns = ConeColumns(colour="colour", layout="track", only="eufs_skidpad")
    made = cones_of(rows, head, columns, "eufs_skidpad")
    assert len(made) == 84
    assert sum(cone.colour == "big_orange" for cone in made) == 4
    assert len(cones_of(rows, head, ConeColumns(layout="track", only="fssim_FSG"), "fsg")) == 188


@pytest.mark.parametrize(
    ("text", "columns", "reason"),
    [
        ("x_m,y_m\n1,2\n3,ten\n", ConeColumns(), r"Row 3, column y_m: 'ten' is no number"),
        ("x_m,y_m\n1,nan\n", ConeColumns(), r"Row 2, column y_m: 'nan' is no number"),
        (
            "x_m,y_m\n1\n",
            ConeColumns(),
            r"cones\.csv, row 2: it has not as many columns as the head line \(2\)",
        ),
        ("x,y_m\n1,2\n", ConeColumns(), r"There is no column 'x_m': choose among x, y_m"),
        ("x_m,y_m\n", ConeColumns(), "There is no row"),
        (
            "x_m,y_m,t\n1,2,c\n3,4,a\n5,6,c\n",
            ConeColumns(layout="t", only="b"),
            r"No row has 'b' in column t, so there is nothing to place: choose among a, c\.",
        ),
        (
            "x_m,y_m,t\n1,2,a\n",
            ConeColumns(only="a"),
            "'a' is to be taken, and no column .* among x_m, y_m, t",
        ),
        (
            "x_m,y_m,n\n1,2,a\n3,4,a\n",
            ConeColumns(id="n"),
            "Row 3, column n: the id 'a' is that of row 2 too",
        ),
        (
            "x_m,y_m,n\n1,2,1.5\n",
            ConeColumns(order="n"),
            r"Row 2, column n: 1\.5 is no whole number",
        ),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path: Path, text: str, columns: ConeColumns, reason: str) -> None:
    with pytest.raises(ConeTableError, match=reason):
        head, rows = read_csv(written(tmp_path, text))
        cones_of(rows, head, columns, "mine")


def test_a_file_that_is_not_there_or_no_text_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConeTableError, match=r"gone\.csv cannot be read \(No such file"):
        read_csv(tmp_path / "gone.csv")
    (tmp_path / "photo.csv").write_bytes(b"\xff\xd8\xff\xe0")
    with pytest.raises(ConeTableError, match=r"photo\.csv cannot be read"):
        read_csv(tmp_path / "photo.csv")
