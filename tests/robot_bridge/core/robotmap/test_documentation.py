"""Every example in docs/robot-map.md is what it says, and its Python runs."""

from __future__ import annotations

import re

import numpy as np
import pytest

from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.robotmap.parametric_shapes import NAMED
from robot_bridge.core.robotmap.text_format import read_text, write_text

BORDER = "border;\n-100;100;\n100;-100;\n#\n"
RINGS = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)


@pytest.fixture(scope="module")
def document(root) -> str:
    return (root / "docs" / "robot-map.md").read_text(encoding="utf-8")


def blocks(document: str, kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```$", document, re.MULTILINE | re.DOTALL)


def examples(document: str):
    """Return the map in each example of one shape."""
    return [read_text(BORDER + block) for block in blocks(document, "obstacle")]


def outline_of(obstacle, courtyard: bool) -> OutlineRow:
    """Return the outline that the builder would have made ``obstacle`` from."""
    stairs = obstacle.shape_type is ShapeType.STAIRS
    risers = np.stack([obstacle.a, obstacle.b], axis=1).reshape(-1, 2)
    points = risers if stairs else np.concatenate([obstacle.a, obstacle.b[-1:]])
    return OutlineRow(
        points=points,
        shape_type=obstacle.shape_type,
        height=float(obstacle.height[0]),
        semantics=obstacle.semantics,
        source=obstacle.ext["src"],
        courtyard=courtyard,
    )


def test_the_papers_sample_is_verbatim_and_is_written_back(document, fig_2):
    assert blocks(document, "robotmap") == [fig_2]
    assert write_text(read_text(fig_2)) == fig_2


def test_there_is_an_example_of_each_shape_without_anything_odd(document):
    shown = {obstacle.shape_type for example in examples(document) for obstacle in example.obstacles}
    assert shown == set(ShapeType)
    assert [example.warnings for example in examples(document)] == [()] * len(examples(document))


def test_each_example_is_what_the_builder_makes_of_such_an_outline(document):
    for block, example in zip(blocks(document, "obstacle"), examples(document), strict=True):
        rows = [outline_of(obstacle, courtyard=k > 0) for k, obstacle in enumerate(example.obstacles)]
        built = build_map(Outlines.from_rows(rows), Window(0, 0, 200, 200))
        # The builder does not know which heights were estimated: the export adds that.
        assert write_text(built) == BORDER + block.replace(",h=est", "")


def test_rings_close_and_run_with_the_free_space_to_their_right(document):
    for example in examples(document):
        for k, obstacle in enumerate(example.obstacles):
            if obstacle.shape_type in RINGS:
                assert (np.roll(obstacle.a, -1, axis=0) == obstacle.b).all()
                twice_area = (obstacle.a[:, 0] * obstacle.b[:, 1] - obstacle.b[:, 0] * obstacle.a[:, 1]).sum()
                assert (twice_area < 0) == (k > 0)


def test_a_map_with_every_shape_goes_through_each_piece_of_python(document, tmp_path, monkeypatch, capsys):
    obstacles = "".join(blocks(document, "obstacle"))
    text = "%crs EPSG:32633\n" + BORDER + obstacles
    robot_map = read_text(text)
    (tmp_path / "map.txt").write_text(text, encoding="utf-8")
    (tmp_path / "map.rmap").write_bytes(encode(text))
    monkeypatch.chdir(tmp_path)
    by_hand, unpacked, _, placed = every = [{} for _ in range(4)]
    for code, names in zip(blocks(document, "python"), every, strict=True):
        exec(compile(code, "docs/robot-map.md", "exec"), names)
    assert by_hand["border"] == [-100, 100, 100, -100]
    assert [segment[1:] for segment in by_hand["segments"]] == [
        (*a, *b, height, outdoor)
        for o in robot_map.obstacles
        for a, b, height, outdoor in zip(*(c.tolist() for c in (o.a, o.b, o.height, o.outdoor)), strict=True)
    ]
    assert [segment[0][3] for segment in by_hand["segments"][:1]] == ["building,A5"]
    assert unpacked["text"].decode() == text
    assert capsys.readouterr().out.count("STAIRS stairs") == 1
    assert placed["points"].mean(axis=0) == pytest.approx([12.5, 40], abs=0.5)


def test_the_table_of_templates_is_the_one_in_the_code(document):
    rows = re.findall(r"^\| `([a-z_]+)` \| `([a-z]+ [0-9. ]+)` \|$", document, re.MULTILINE)
    assert dict(rows) == NAMED
