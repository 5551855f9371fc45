"""The as-placed report as rows, figures and CSV."""

from __future__ import annotations

import csv
import io

import pytest
from fleet_supervisor.plugin.desk.plans.as_placed import COLUMNS, as_csv, chosen, tally
from fleet_supervisor.robot_bridge.messages import PlacementReport


def placed(number, cone="c", at=1_700_000_000.0, deviation=0.05, **more):
    values = (number, f"task-{number}", "r1", 10.0, 20.0, 10.05, 20.0, 0.0, deviation, at, "command")
    return PlacementReport(*values, cone=cone, **{"layout": "row", "plan": "p", **more})


def test_the_report_has_every_cone_in_the_order_of_placing():
    ones = [
        placed(2, "b", 5.0),
        placed(1, "a", 9.0),
        placed(3, "x", 1.0, plan="q"),
        placed(4, "y", 1.0, layout="z"),
    ]
    assert [one.cone for one in chosen(ones, plan="p")] == ["y", "b", "a"]
    assert [one.cone for one in chosen(ones, layout="row")] == ["x", "b", "a"]
    assert len(chosen(ones)) == 4


def test_the_figures_are_those_of_the_deviations():
    ones = [placed(1, deviation=0.1), placed(2, deviation=0.3, collected_at=9.0)]
    found = tally(ones)
    assert (found.cones, found.collected, found.largest) == (2, 1, 0.3)
    assert found.mean == pytest.approx(0.2)
    assert (
        found.in_words(5)
        == "2 of 5 cones placed, 1 collected again; off by 0.200 m on average, at most 0.300 m"
    )
    assert tally([]).in_words() == "No cone was put down yet."


def test_the_csv_reads_back_with_commas_quotes_and_lines_in_names():
    ones = [placed(1, 'a,"b"\nc'), placed(2, None, label="by hand", collected_at=1_700_000_060.0)]
    head, first, second = csv.reader(io.StringIO(as_csv(ones)))
    assert tuple(head) == COLUMNS
    assert first == [
        'a,"b"\nc',
        "row",
        "10.000",
        "20.000",
        "10.050",
        "20.000",
        "0.050",
        "r1",
        "2023-11-14T22:13:20Z",
        "",
    ]
    assert second[0] == "by hand" and second[-1] == "2023-11-14T22:14:20Z"
