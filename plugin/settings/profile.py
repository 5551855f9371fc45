"""Data in the QGIS profile: connections, gateways, preferences, and tokens in its authentication data."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

from qgis.core import QgsApplication, QgsAuthMethodConfig, QgsSettings
from qgis.PyQt.QtCore import QStandardPaths

from ...robot_bridge.core.json_decoder import decode_json
from ...robot_bridge.core.messages.base import usable_addresses
from ...robot_bridge.core.reconnection import FleetGateways
from ..gateway_client.connection_status import check_address
from ..ui.errors import FleetError
from ..ui.language import tr

TITLE = "Fleet Supervisor"
METHOD = "Basic"
"""The authentication method: its user name is the operator, its password the token."""
HEADERS = "APIHeader"


class TokenStoreError(FleetError):
    """A token could not be stored, or not be read."""


class TokenStore:
    """Tokens as authentication configurations, listed in QGIS's options under *Authentication*.

    QGIS asks for its master password when necessary.
    """

    @property
    def is_there(self) -> bool:
        """Whether this QGIS can store tokens."""
        return not QgsApplication.authManager().isDisabled()

    def has(self, url: str) -> bool:
        """Return whether a token is stored for a gateway, without asking for the master password."""
        return bool(self.kept_for(url))

    def kept_for(self, url: str) -> str:
        """Return the id of the configuration stored here for a gateway, empty where there is none."""
        return self.id_of(_name(url))

    def id_of(self, name: str) -> str:
        """Return the id of the configuration called ``name``, empty where there is none."""
        if not self.is_there:
            return ""
        known = QgsApplication.authManager().availableAuthMethodConfigs().items()
        return next((key for key, one in known if one.name() == name), "")

    def read(self, url: str) -> str:
        """Return the token for a gateway; empty where none is stored.

        :raises TokenStoreError: when QGIS does not return it, as without its master password.
        """
        config = self.kept_for(url)
        return self.token_in(config) if config else ""

    def token_in(self, config: str) -> str:
        """Return the token in the authentication configuration with the id ``config``.

        :raises TokenStoreError: when QGIS does not return it, or it contains no token.
        """
        if not self.is_there:
            raise TokenStoreError(
                tr(
                    "This QGIS keeps no authentication (its options say why, under Authentication): enter "
                    "the token under Access."
                )
            )
        manager = QgsApplication.authManager()
        if config not in manager.configIds():
            raise TokenStoreError(
                tr(
                    "The authentication {config} that the connection names is not in this QGIS. Edit the "
                    "connection and choose another, or enter the token.",
                    config=config,
                )
            )
        done, loaded = manager.loadAuthenticationConfig(config, QgsAuthMethodConfig(), True)
        if not done:
            raise TokenStoreError(
                tr(
                    "QGIS did not give the token that it keeps: its master password was not given. Press "
                    "Connect and enter it, or enter the token under Access."
                )
            )
        return _token(loaded)

    def keep(self, url: str, token: str, operator: str = "") -> str:
        """Store a token for a gateway, replacing a former one, and return its configuration's id.

        :raises TokenStoreError: when QGIS does not accept it.
        """
        return self.write(self.kept_for(url), _name(url), url, token, operator)

    def write(self, config_id: str, name: str, url: str, token: str, operator: str) -> str:
        """Store a token in the configuration ``config_id``, empty for a new one, and return its id.

        :raises TokenStoreError: when QGIS does not accept it.
        """
        config = QgsAuthMethodConfig(METHOD)
        config.setName(name)
        config.setUri(url)
        config.setConfig("username", operator)
        config.setConfig("password", token)
        config.setId(config_id)
        manager = QgsApplication.authManager()
        if config.id():
            done = manager.updateAuthenticationConfig(config)
        elif manager.isDisabled():
            done = False
        else:
            done, config = manager.storeAuthenticationConfig(config)
        if not done:
            raise TokenStoreError(
                tr(
                    "QGIS did not keep the token: its master password was not given. The token is used now "
                    "and has to be entered again next time."
                )
            )
        return str(config.id())

    def forget(self, url: str) -> None:
        """Delete the token for a gateway."""
        config = self.kept_for(url)
        if config:
            QgsApplication.authManager().removeAuthenticationConfig(config)


def _name(url: str) -> str:
    return f"{TITLE}: {url}"


def _token(config: QgsAuthMethodConfig) -> str:
    """Return the token: a password, or the value that a web service's header would have."""
    if config.method() == METHOD:
        return config.config("password").strip()
    if config.method() == HEADERS:
        header = config.configMap().get("Authorization", "")
        return header.removeprefix("Bearer ").strip()
    raise TokenStoreError(
        tr(
            "The authentication {config} is of the method {method}, which gateways do not know. "
            "Choose one of the method {wanted} with the token as its password.",
            config=config.name(),
            method=config.method(),
            wanted=METHOD,
        )
    )


FORMAT = "fleet-supervisor-connections"
VERSION = 1
_LARGEST = 200_000
"""characters: a thousand connections, each of which is written into QGIS's settings."""
CHOOSE = tr("Choose a file that Export wrote.")


class BadConnectionError(FleetError):
    """A connection, or a file of them, is invalid."""


@dataclass(frozen=True)
class GatewayConnection:
    """The data of a connection. ``auth`` is the id of an authentication configuration of QGIS, or empty."""

    name: str
    url: str
    operator: str = ""
    ca_file: str = ""
    auth: str = ""

    def checked(self) -> GatewayConnection:
        """Return the connection with its values stripped.

        :raises FleetError: when the name is empty or the URL is invalid for a gateway.
        """
        name = " ".join(self.name.split())
        if not name:
            raise BadConnectionError(tr("The connection has no name. Give it one, such as the site's."))
        url = check_address(self.url)
        return GatewayConnection(name, url, self.operator.strip(), self.ca_file.strip(), self.auth)


def connections_text(connections: Sequence[GatewayConnection]) -> str:
    """Return connections as JSON, without tokens and without data specific to this computer's QGIS."""
    rows = [
        {"name": one.name, "url": one.url, "operator": one.operator, "ca_file": one.ca_file}
        for one in connections
    ]
    content = {"format": FORMAT, "version": VERSION, "connections": rows}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def connections_in(text: str, source: str) -> list[GatewayConnection]:
    """Return the connections in ``text``, the content of the file ``source``.

    :raises FleetError: naming ``source``, the entry and its error.
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


GROUP = "fleet_supervisor/connections"
LAST = "fleet_supervisor/last_connection"
_KEYS = ("url", "operator", "ca_file", "auth")


class Connections:
    """Named connections in the settings of the QGIS profile; all instances share the same data."""

    def names(self) -> list[str]:
        """Return the names, in their order."""
        settings = QgsSettings()
        settings.beginGroup(GROUP)
        return sorted((unquote(group) for group in settings.childGroups()), key=str.casefold)

    def all(self) -> list[GatewayConnection]:
        """Return every connection, in the order of their names."""
        return [one for one in map(self.get, self.names()) if one is not None]

    def get(self, name: str) -> GatewayConnection | None:
        """Return the connection ``name``, None if there is none."""
        settings = QgsSettings()
        if not name or not settings.value(f"{_group(name)}/url"):
            return None
        values = (str(settings.value(f"{_group(name)}/{key}", "") or "") for key in _KEYS)
        return GatewayConnection(name, *values)

    def store(self, connection: GatewayConnection, instead_of: str = "") -> None:
        """Store a connection, replacing one of that name and the one called ``instead_of``."""
        if instead_of and instead_of != connection.name:
            was_last = self.last == instead_of
            self.remove(instead_of)
            if was_last:
                self.set_last(connection.name)
        for key in _KEYS:
            QgsSettings().setValue(f"{_group(connection.name)}/{key}", getattr(connection, key))

    def remove(self, name: str) -> None:
        """Delete the connection ``name``; its token stays in QGIS's authentication database."""
        QgsSettings().remove(_group(name))
        if self.last == name:
            self.set_last("")

    @property
    def last(self) -> str:
        """The name of the connection that was used last, empty for one without a name."""
        return str(QgsSettings().value(LAST, "") or "")

    def set_last(self, name: str) -> None:
        """Record the name of the connection that was used last, empty for one without."""
        if name != self.last:  # what is written is written to the disk, in the window's thread
            QgsSettings().setValue(LAST, name)


def _group(name: str, within: str = GROUP) -> str:
    # A slash in a name would be a group of its own.
    return f"{within}/{quote(name, safe='')}"


# --- Other gateways of a fleet: known to a desk that is opened while one is down ---

GATEWAYS = "fleet_supervisor/gateways"
LONGEST_DATABASE = 128
"""characters that distinguish a database from every other."""


class KnownGateways:
    """Reports of gateways about their fleets, by the address of the one that the operator connects to.

    An address here is no secret, and not trusted: TLS and the fleet's identity are checked on connecting.
    """

    def of(self, url: str) -> FleetGateways | None:
        """Return the report of the gateway at ``url``, None where there is none or it cannot be read."""
        try:
            kept = decode_json(str(QgsSettings().value(_group(url, GATEWAYS), "") or "null"))
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

    def keep(self, url: str, reported: FleetGateways) -> None:
        """Store a report, replacing the former one."""
        if not reported.gateways:
            if QgsSettings().contains(_group(url, GATEWAYS)):
                QgsSettings().remove(_group(url, GATEWAYS))
        elif reported != self.of(url):  # what is written is written to the disk, in the window's thread
            content = {"database": reported.database, "gateways": list(reported.gateways)}
            QgsSettings().setValue(_group(url, GATEWAYS), json.dumps(content))


# --- Preferences, and the folder for files ---

PREFERENCES = "fleet_supervisor/preferences"

RANGES = {"positions_rate": (1.0, 20.0), "layer_seconds": (1.0, 60.0), "robot_size": (0.5, 3.0)}
"""The range of each number."""


@dataclass(frozen=True)
class Preferences:
    """``positions_rate`` is the greatest number of positions requested per second, from the next connection
    on; ``layer_seconds`` are the seconds between two writes of the layer of robots; ``robot_size`` is the
    scale at which robots are drawn, 1 by default; ``drawn_by_layer`` is whether the layer of robots draws
    them, in its style, in place of the overlay's arrows; ``folder`` is where files are written to unless
    another is chosen, empty for the user's documents.
    """

    positions_rate: float = 10.0
    layer_seconds: float = 1.0
    robot_size: float = 1.0
    drawn_by_layer: bool = False
    folder: str = ""


def read_preferences() -> Preferences:
    """Return the stored preferences; an invalid number, or one out of its range, counts as not set."""
    settings = QgsSettings()
    values: dict[str, object] = {}
    for name, (least, most) in RANGES.items():
        try:
            number = float(str(settings.value(f"{PREFERENCES}/{name}")))
        except ValueError:
            continue
        if least <= number <= most:
            values[name] = number
    return Preferences(
        **values,
        drawn_by_layer=str(settings.value(f"{PREFERENCES}/drawn_by_layer", "")).lower() == "true",
        folder=str(settings.value(f"{PREFERENCES}/folder", "") or ""),
    )


def write_preferences(preferences: Preferences) -> None:
    """Store every value."""
    for field in fields(preferences):
        QgsSettings().setValue(f"{PREFERENCES}/{field.name}", getattr(preferences, field.name))


def exports_folder() -> str:
    """Return the folder in which file dialogs begin: the first that exists."""
    documents = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.DocumentsLocation)
    folders = (Path(one) for one in (read_preferences().folder, documents) if one)
    return str(next((folder for folder in folders if folder.is_dir()), Path.home()))


def export_path(name: str) -> str:
    """Return the default path for a file called ``name``."""
    return str(Path(exports_folder()) / name)
