"""Other gateways of a fleet, kept in the QGIS profile: a desk that is opened while one is dead knows them."""

from __future__ import annotations

import json
from urllib.parse import quote

from qgis.core import QgsSettings

from ...robot_bridge.core.gateway_addresses import FleetGateways
from ...robot_bridge.core.json_decoder import decode_json
from ...robot_bridge.core.messages.validation import usable_addresses

GROUP = "fleet_supervisor/gateways"
LONGEST_DATABASE = 128
"""characters that tell a database from every other."""


class KnownGateways:
    """What gateways told, by the address of the one that the operator connects to.

    It is no secret, and no reason to trust an address: that has TLS, and the fleet that answers there.
    """

    def of(self, url: str) -> FleetGateways | None:
        """Return what the gateway at ``url`` told, None where it told nothing or that cannot be read."""
        try:
            kept = decode_json(str(QgsSettings().value(_key(url), "") or "null"))
        except ValueError:
            return None
        if not isinstance(kept, dict):
            return None
        database, gateways = kept.get("database"), kept.get("gateways")
        if not isinstance(database, str) or len(database) > LONGEST_DATABASE:
            return None
        if not isinstance(gateways, list):
            return None
        usable = usable_addresses([one for one in gateways if isinstance(one, str)])
        return FleetGateways(database, tuple(usable)) if usable else None

    def keep(self, url: str, told: FleetGateways) -> None:
        """Keep what was told in place of what was told before."""
        if not told.gateways:
            if QgsSettings().contains(_key(url)):
                QgsSettings().remove(_key(url))
        elif told != self.of(url):  # what is written is written to the disk, in the window's thread
            content = {"database": told.database, "gateways": list(told.gateways)}
            QgsSettings().setValue(_key(url), json.dumps(content))


def _key(url: str) -> str:
    # A slash would be a group of its own.
    return f"{GROUP}/{quote(url, safe='')}"
