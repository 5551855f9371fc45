"""What each gateway makes once, such as decoders of its settings: made as this is loaded.

None of it depends on the site, the database or the options of a gateway.
"""

from __future__ import annotations

from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway.monitoring import gateway_version
from tests.support.fleet import SITE

read_site(SITE)
gateway_version()
