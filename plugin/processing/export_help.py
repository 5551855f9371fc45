"""The help of ``fleet:exportrobotmap``."""

from ..language import tr_page

HELP = tr_page("""
<p>Writes the obstacles in a window of the site as a map that robots read: oriented segments with free space
to their right, grouped by kind. Robots get metres in the <b>site frame</b>: a projected CRS, an origin in it
and a rotation.</p>
<p><b>Obstacle layers</b>: lines and polygons, several at once, in any CRS. Curves become chords (2 cm). What
the window cuts becomes open chains; no wall is invented on the border.</p>
<p><b>Window</b>: a centre with width and height in metres, or an extent. Positions may name their CRS, as in
<i>12.5,48.1 [EPSG:4326]</i>; without one they are in the site CRS.</p>
<p><b>Site CRS</b>: in metres, such as the local UTM zone. EPSG:3857 is refused, because its metres are not
metres. Default: the project's CRS; without a project the layers' own. A local engineering CRS is used as it
is.</p>
<p><b>Height, foot, label, outdoors</b>: QGIS expressions; the foot is where a feature begins above the
ground, and its height counts from there. What a layer keeps (menu Fleet Supervisor, Layer roles) wins over
these. There its role makes flights of risers of a layer (stairs) or surfaces without height (ramp), its
filter says which features count, and points of furniture get a shape. Default: the field <i>height</i> or
<i>height_m</i>, on the ground, the layer's name, true. Where no height is known, the default height is used,
said in a warning and marked <i>h=est</i> in the map.</p>
<p><b>Map profile</b>: a file that says by layer name what layers are: <i>openstreetmap</i>,
<i>upc_campus_nord</i> or the path of one's own. It wins over what the layers keep.</p>
<p><b>Smaller maps</b> (advanced, each off unless asked for): only what the robot's plane meets, without
walls between or inside buildings, lines joined, fewer corners, no short segments, heights in steps. The log
says how many obstacles and segments there were before and after. Walls between buildings, corners and short
segments need the Python package shapely 2.</p>
<p><b>Format</b>: text; binary (the text compressed, with a check sum), which needs the Python package
zstandard; compact (about a third of binary, whole centimetres), which needs cbor2 instead. The file
<i>docs/robot-map.md</i> of the project describes them, and exports from a script.</p>
<p>Broken geometry is repaired where that is safe and left out where it is not. Each time a warning names the
layer and the feature; the export goes on.</p>
""")
"""In one line, because QGIS takes every line break for the end of a paragraph."""
