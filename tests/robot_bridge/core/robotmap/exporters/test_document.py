"""The code that docs/navigation-maps.md shows."""

from __future__ import annotations

import json
import re

from robot_bridge.core.robotmap.text_format import write_text


def test_the_python_of_the_guide_runs_as_it_stands(root, site_on_disk, tmp_path, monkeypatch):
    guide = (root / "docs" / "navigation-maps.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", guide, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "map.txt").write_text(write_text(site_on_disk.whole_map()))
    exec(compile(code, "docs/navigation-maps.md", "exec"), {})
    assert (tmp_path / "map.pgm").stat().st_size == 4000 * 3200 + len("P5\n4000 3200\n255\n")
    assert len(json.loads((tmp_path / "map.geojson").read_text())["features"]) > 40
