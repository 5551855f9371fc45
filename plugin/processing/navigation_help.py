"""The help of ``fleet:exportnavigationmap``."""

from ..language import tr_page

HELP = tr_page("""
<p>Writes a robot map as other robots and people read it.</p>
<p><b>Robot map</b>: a file of <i>fleet:exportrobotmap</i> or of the gateway, text or binary.</p>
<p><b>Formats</b>, several at once:</p>
<ul>
<li><i>occupancy</i>: occupancy grid for Nav2 (PGM and YAML). What a wall touches is occupied, so thin walls
have no gap; courtyards are free; the inside of obstacles is unknown, or occupied on request. The frame of the
grid is the site frame.</li>
<li><i>keepout</i>: mask for Nav2's keepout filter, from the keepout layer, with the filter's parameters.</li>
<li><i>speed</i>: mask for Nav2's speed filter, from the speed layer and its expression in m/s. A limit is
never rounded up; where areas overlap the lower one holds.</li>
<li><i>geojson</i>: obstacles and segments in WGS 84 (RFC 7946).</li>
<li><i>geopackage</i>: the same in the site's CRS.</li>
<li><i>svg</i>, <i>png</i>: a picture for people.</li>
</ul>
<p><b>Keepout and speed layers</b> are polygons in any CRS. Where the map's place is not known, layers
are taken to be in its own metres, and a warning says so; <i>SITE_CRS</i>, <i>ORIGIN</i> and <i>ROTATION</i>
give it one.</p>
<p><b>Robots drive over</b> obstacles that are lower: 0 keeps every kerb. Ramps are always driven on, stairs
are obstacles, also from the side.</p>
<p>Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md
says what is in each.</p>
<p>From a script, with no display:</p>
<pre>qgis_process run fleet:exportnavigationmap --
  MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus</pre>
""")
