"""Draw docs/images/road-surfaces*.png with a QGIS that has no display: generated surfaces, real and made up.

python -m tools.pictures.road_surfaces [docs/images]

The two of the real track are left as they are without the data beside the project.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from tools.pictures.stage import CRS, SITE, draw_map, drawing, photo, run, vector
from tools.plugin_files import ROOT

DATA = ROOT.parent / "shared" / "data" / "zalazone"
EXTENT = (640420.0, 5193482.0, 640620.0, 5193622.0)
PIXELS_PER_M = 5
MARGIN_M = 8.0
PHOTO_PIXELS_PER_M = 2
"""Less than the photo has: an illustration, not the photo."""


def main() -> None:
    with drawing(__doc__) as folder, tempfile.TemporaryDirectory() as place:
        made = Path(place)
        sample_site(made / "sample.gpkg", folder / "road-surfaces.png")
        if DATA.is_dir():
            real_track(made, folder / "road-surfaces-track.png", folder / "road-surfaces-photo.png")


def sample_site(made: Path, picture: Path) -> None:
    """Draw the surfaces that the sample site's centrelines make, over its orthophoto."""
    roads = f"{SITE / 'site.gpkg'}|layername=road_centrelines"
    print(run("road_surfaces.BuildRoadSurfaces", {"ROADS": roads, "SURFACES": str(made)}))
    layers = [_line(roads, "#ffffff", 0.5, "dash"), vector(str(made), style="road_surfaces"), photo()]
    draw_map(layers, EXTENT, PIXELS_PER_M, picture)


def real_track(folder: Path, picture: Path, beside: Path) -> None:
    """Draw what the lanes of the real track make, its digitised surfaces as outlines, and the real drive.

    ``beside`` becomes the photo of the same ground, with the outlines of what was made.
    """
    roads = str(DATA / "university_track_centrelines.geojson")
    real = str(DATA / "university_track_surfaces_derived_utm33.gpkg")
    made = str(folder / "track.gpkg")
    given = {"ROADS": roads, "SITE_CRS": CRS, "SURFACE": "'asphalt'", "DRAWN": [_parking(real)]}
    print(run("road_surfaces.BuildRoadSurfaces", {**given, "SURFACES": made}))
    drive = f"file://{DATA / 'uni_track_drive_utm33.csv'}?xField=x_utm33&yField=y_utm33&crs={CRS}"
    surfaces = _solid(made)
    box = surfaces.extent().buffered(MARGIN_M)
    extent = (box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum())
    draw_map([_dots(drive), _outline(real, "#c01c28"), surfaces], extent, PIXELS_PER_M, picture)
    taken = photo(DATA / "zalazone_university_track_utm33_35cm.tif")
    lanes = _line(roads, "#ffd43b", 0.3, "solid")
    draw_map([lanes, _outline(made, "#ffffff"), taken], extent, PHOTO_PIXELS_PER_M, beside)


def _solid(source: str) -> Any:
    from qgis.core import QgsCategorizedSymbolRenderer, QgsFillSymbol, QgsRendererCategory

    layer = vector(source)
    colours = {"asphalt": "#a9b4c0", "parking pavement": "#e6c88f"}
    categories = [
        QgsRendererCategory(
            name, QgsFillSymbol.createSimple({"color": colour, "outline_color": "#6b7683"}), name
        )
        for name, colour in colours.items()
    ]
    layer.setRenderer(QgsCategorizedSymbolRenderer("surface", categories))
    return layer


def _parking(source: str) -> Any:
    """Return the digitised parking, under the name that the style knows."""
    from fleet_supervisor.plugin.layers.roles import LayerExpressions, LayerSetup, keep_setup

    layer = vector(source)
    expressions = LayerExpressions(
        filter="\"surface\" = 'parking_pavement'", semantics="replace(\"surface\", '_', ' ')"
    )
    keep_setup(layer, LayerSetup("road_surface", expressions))
    return layer


def _line(source: str, colour: str, width: float, style: str) -> Any:
    from qgis.core import QgsLineSymbol, QgsSingleSymbolRenderer

    layer = vector(source)
    look = {"line_color": colour, "line_width": str(width), "line_style": style}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsLineSymbol.createSimple(look)))
    return layer


def _outline(source: str, colour: str) -> Any:
    from qgis.core import QgsFillSymbol, QgsSingleSymbolRenderer

    layer = vector(source)
    look = {"style": "no", "outline_color": colour, "outline_width": "0.4"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsFillSymbol.createSimple(look)))
    return layer


def _dots(source: str) -> Any:
    from qgis.core import QgsMarkerSymbol, QgsSingleSymbolRenderer

    layer = vector(source, provider="delimitedtext")
    look = {"name": "circle", "size": "1.5", "color": "#1a202c", "outline_style": "no"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(look)))
    return layer


if __name__ == "__main__":
    main()
