"""The help of ``fleet:publishsite``."""

from ..language import tr_page

HELP = tr_page("""
<p>Writes the layers of a site into a folder with <i>site.toml</i> and <i>site.gpkg</i>, which
<i>robot-bridge serve --site FOLDER</i> serves.</p>
<p><b>Layers</b>: those of the project by their roles (menu Fleet Supervisor, Layer roles), or by a <b>map
profile</b>, or the layers given here. Which features count, heights, where things begin above the ground,
labels, road widths and shapes of furniture come from the expressions kept with the roles; heights, labels and
widths else from the fields <i>height</i> or <i>height_m</i>, <i>surface</i>, <i>name</i>, <i>width_m</i> or
<i>width</i>.</p>
<p><b>Version</b>: 1 for a new folder, else one more than the version there. A folder that holds another site
is refused unless <b>Replace</b> is ticked.</p>
<p><b>Bounds</b>: the rectangle, along the axes of the site frame, that robots may be sent into. Obstacles are
published up to 100 m beyond it, so that a robot at its edge is told what stands there.</p>
<p><b>Site CRS, origin, rotation</b>: where the robots' (0, 0) is and how their x axis lies. Default: as the
project has it.</p>
<p>An earlier publication is replaced only after the new one is complete; a cancel leaves it as it was. Broken
geometry is repaired where that is safe and left out where it is not, each time with a warning that names the
layer and the feature. One publication into a folder runs at a time.</p>
""")
"""In one line, because QGIS takes every line break for the end of a paragraph."""
