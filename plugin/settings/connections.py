"""The connections that QGIS keeps, and which one was used last."""

from __future__ import annotations

from urllib.parse import quote, unquote

from qgis.core import QgsSettings

from .gateway_connection import GatewayConnection

GROUP = "fleet_supervisor/connections"
LAST = "fleet_supervisor/last_connection"
_KEYS = ("url", "operator", "ca_file", "auth")


class Connections:
    """Named connections in the settings of the QGIS profile; every part that makes one sees the same."""

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

    def put(self, connection: GatewayConnection, instead_of: str = "") -> None:
        """Keep a connection, in place of one of that name and of the one called ``instead_of``."""
        if instead_of and instead_of != connection.name:
            was_last = self.last == instead_of
            self.remove(instead_of)
            if was_last:
                self.last = connection.name
        for key in _KEYS:
            QgsSettings().setValue(f"{_group(connection.name)}/{key}", getattr(connection, key))

    def remove(self, name: str) -> None:
        """Keep the connection ``name`` no longer; its token stays with QGIS's authentication."""
        QgsSettings().remove(_group(name))
        if self.last == name:
            self.last = ""

    @property
    def last(self) -> str:
        """The name of the connection that was used last, empty for one without a name."""
        return str(QgsSettings().value(LAST, "") or "")

    @last.setter
    def last(self, name: str) -> None:
        QgsSettings().setValue(LAST, name)


def _group(name: str) -> str:
    # A slash in a name would be a group of its own.
    return f"{GROUP}/{quote(name, safe='')}"
