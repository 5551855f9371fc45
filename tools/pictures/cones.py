"""Draw docs/images/cones-*.png: every standard layout, and one on the sample site, with no display.

python -m tools.pictures.cones [docs/images]
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.support.picture import reduce_colours
from tools.pictures.stage import CRS, SITE, draw_map, drawing, part, photo, run, vector

PLACE = (640432.0, 5193486.2)
DIMENSIONS = "vehicle_width=1.7; exit_length=15"
EXTENT = (640424.0, 5193480.0, 640552.0, 5193508.0)
PIXELS_PER_M = 1100 / 128
FILL = {"orange": "#f26a1b", "big_orange": "#c22800", "blue": "#2d6cdf", "yellow": "#f2c200"}
LONG, ROUND = (1100, 260), (760, 790)
MARGIN, FOOT = 46, 40
STRETCH = 4.0
SHOWN: dict[str, dict[str, float]] = {"circle": {"radius": 30, "spacing": 8}}
"""The circle is drawn smaller than the standard's, or its cones could not be told apart."""


def main() -> None:
    with drawing(__doc__) as folder, tempfile.TemporaryDirectory() as place:
        for name, kind in part("robot_bridge.core.layouts.catalogue").LAYOUTS.items():
            draw(kind.of(SHOWN.get(name, {})).cones(), folder / f"cones-{name.replace('_', '-')}.png")
        draw_on_site(Path(place) / "cones.gpkg", folder / "cones-on-site.png")


@dataclass(frozen=True)
class Scale:
    """Where metres come to lie on a picture."""

    size: tuple[int, int]
    middle: tuple[float, float]
    along: float
    aside: float

    @classmethod
    def of(cls, cones: list[Any]) -> Scale:
        """Return the scale that shows ``cones``: what is much longer than wide is stretched across."""
        xs, ys = [cone.x for cone in cones], [cone.y for cone in cones]
        length, width = max(xs) - min(xs), max(max(ys) - min(ys), 0.1)
        size = LONG if length > 3 * width else ROUND
        along = (size[0] - 2 * MARGIN) / length
        aside = (size[1] - 2 * MARGIN - FOOT) / width
        along = min(along, aside)
        aside = min(aside, STRETCH * along) if size == LONG else along
        return cls(size, ((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2), along, aside)

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Return the pixel of x, y."""
        across, down = self.size[0] / 2, (self.size[1] - FOOT) / 2
        return across + (x - self.middle[0]) * self.along, down - (y - self.middle[1]) * self.aside


def draw(cones: list[Any], file: Path) -> None:
    """Draw ``cones`` in their colours, numbered, with a scale and an arrow at the layout's origin."""
    from qgis.PyQt.QtGui import QColor, QFont, QImage, QPainter

    scale = Scale.of(cones)
    image = QImage(*scale.size, QImage.Format.Format_RGB32)
    image.fill(QColor("white"))
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setFont(QFont("Sans Serif", 8))
    for cone in cones:
        draw_cone(painter, scale, cone)
    draw_scale(painter, scale)
    painter.end()
    image.save(str(file))
    reduce_colours(file)


def draw_cone(painter: Any, scale: Scale, cone: Any) -> None:
    from qgis.PyQt.QtCore import QPointF
    from qgis.PyQt.QtGui import QColor, QPen

    place = QPointF(*scale.at(cone.x, cone.y))
    painter.setPen(QPen(QColor("#333333"), 0.8))
    painter.setBrush(QColor(FILL[cone.colour]))
    size = 6.5 if cone.colour == "big_orange" else 5.0
    painter.drawEllipse(place, size, size)
    painter.setPen(QColor("#444444"))
    painter.drawText(place + QPointF(-6, -9 if cone.y >= scale.middle[1] else 18), str(cone.order))


def draw_scale(painter: Any, scale: Scale) -> None:
    from qgis.PyQt.QtCore import QPointF
    from qgis.PyQt.QtGui import QColor, QPen

    painter.setPen(QPen(QColor("#222222"), 1.6))
    foot = scale.size[1] - 26.0
    painter.drawLine(QPointF(MARGIN, foot), QPointF(MARGIN + 10 * scale.along, foot))
    times = scale.aside / scale.along
    stretched = f"; drawn {times:.1f} times as wide as it is" if times > 1.05 else ""
    painter.drawText(QPointF(MARGIN, foot + 15), f"10 m{stretched}")
    painter.setPen(QPen(QColor("#2a6f97"), 2))
    x, y = scale.at(0, 0)
    tip = QPointF(x, y)
    for back in (QPointF(30, 0), QPointF(8, 5), QPointF(8, -5)):
        painter.drawLine(tip, tip - back)


def draw_on_site(file: Path, picture: Path) -> None:
    """Place the double lane change on the sample site's straight and draw it over the orthophoto."""
    site = SITE / "sample_site.gpkg"
    made = run(
        "cone_layout.ConeLayout",
        {
            "LAYOUT": "iso3888_1",
            "POINT": f"{PLACE[0]},{PLACE[1]} [{CRS}]",
            "HEADING": 90,
            "DIMENSIONS": DIMENSIONS,
            "SITE_CRS": CRS,
            "SURFACES": [f"{site}|layername=road_surfaces"],
            "OBSTACLES": [f"{site}|layername={name}" for name in ("buildings", "walls", "columns")],
            "CONES": str(file),
            "FINDINGS": f"{file}.findings.gpkg",
        },
    )
    print(made)
    draw_map([vector(made["CONES"], style="cones"), photo()], EXTENT, PIXELS_PER_M, picture)


if __name__ == "__main__":
    main()
