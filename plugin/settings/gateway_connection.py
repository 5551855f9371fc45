"""A gateway under a name, as operators keep it; and several of them as a file, to be handed on."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...robot_bridge.core.decoding import decode_json
from ..errors import FleetError
from ..language import tr
from ..wire.addresses import check_address

FORMAT = "fleet-supervisor-connections"
VERSION = 1
_LARGEST = 200_000
"""characters: a thousand connections, each of which is written into QGIS's settings."""
CHOOSE = tr("Choose a file that Export wrote.")


class BadConnectionError(FleetError):
    """A connection, or a file of them, cannot be used as it is."""


@dataclass(frozen=True)
class GatewayConnection:
    """What it takes to connect. ``auth`` is the id of an authentication configuration of QGIS, or empty."""

    name: str
    url: str
    operator: str = ""
    ca_file: str = ""
    auth: str = ""

    def checked(self) -> GatewayConnection:
        """Return the connection without blanks around its values.

        :raises FleetError: when the name is empty or the URL cannot be a gateway's.
        """
        name = " ".join(self.name.split())
        if not name:
            raise BadConnectionError(tr("The connection has no name. Give it one, such as the site's."))
        url = check_address(self.url)
        return GatewayConnection(name, url, self.operator.strip(), self.ca_file.strip(), self.auth)


def connections_text(connections: Sequence[GatewayConnection]) -> str:
    """Return connections as JSON, without tokens and without what only this computer's QGIS knows."""
    rows = [
        {"name": one.name, "url": one.url, "operator": one.operator, "ca_file": one.ca_file}
        for one in connections
    ]
    content = {"format": FORMAT, "version": VERSION, "connections": rows}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def connections_in(text: str, source: str) -> list[GatewayConnection]:
    """Return the connections in ``text``, the content of the file ``source``.

    :raises FleetError: naming ``source``, the entry and what is wrong with it.
    """
    try:
        if len(text) > _LARGEST:
            raise ValueError(f"it has {len(text)} characters, more than {_LARGEST}")
        content = decode_json(text)
    except ValueError as error:
        raise BadConnectionError(
            tr("{source} is not JSON: {error}. {choose}", source=source, error=error, choose=CHOOSE)
        ) from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise BadConnectionError(
            tr("{source} holds no connections to gateways. {choose}", source=source, choose=CHOOSE)
        )
    if content.get("version") != VERSION:
        raise BadConnectionError(
            tr(
                "{source} is of version {found}; this plugin reads version {version}. Update the plugin.",
                source=source,
                found=content.get("version"),
                version=VERSION,
            )
        )
    rows = content.get("connections")
    if not isinstance(rows, list):
        raise BadConnectionError(
            tr("{source} has no list named connections. {choose}", source=source, choose=CHOOSE)
        )
    return [_connection(row, number, source) for number, row in enumerate(rows, 1)]


def _connection(row: Any, number: int, source: str) -> GatewayConnection:
    keys = ("name", "url", "operator", "ca_file")
    if not isinstance(row, dict) or not all(isinstance(row.get(key, ""), str) for key in keys):
        raise BadConnectionError(
            tr(
                "{source}: connection {number} is not a set of texts named {keys}. {choose}",
                source=source,
                number=number,
                keys=", ".join(keys),
                choose=CHOOSE,
            )
        )
    try:
        return GatewayConnection(*(row.get(key, "") for key in keys)).checked()
    except FleetError as error:
        raise BadConnectionError(
            tr("{source}: connection {number}: {error}", source=source, number=number, error=error)
        ) from error
