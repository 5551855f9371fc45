"""Where the operator's tokens are kept: encrypted, in the authentication manager of QGIS, or nowhere."""

from __future__ import annotations

import hashlib

from qgis.core import QgsApplication

from ..errors import FleetError


class TokenStoreError(FleetError):
    """A token could not be kept."""


class TokenStore:
    """One token for each gateway. QGIS asks for its master password when it has to."""

    @property
    def is_there(self) -> bool:
        """Whether this QGIS can keep tokens."""
        return not QgsApplication.authManager().isDisabled()

    def has(self, url: str) -> bool:
        """Tell whether a token is kept for a gateway; nobody is asked for anything."""
        return self.is_there and QgsApplication.authManager().existsAuthSetting(_key(url))

    def read(self, url: str) -> str:
        """Return the token for a gateway; empty where none is kept or the master password was not given."""
        if not self.has(url):
            return ""
        return str(QgsApplication.authManager().authSetting(_key(url), "", True) or "")

    def keep(self, url: str, token: str) -> None:
        """Keep a token; raises TokenStoreError when QGIS does not take it."""
        if not QgsApplication.authManager().storeAuthSetting(_key(url), token, True):
            raise TokenStoreError(
                "QGIS did not keep the token: its master password was not given. The token is used now and "
                "has to be entered again next time."
            )

    def forget(self, url: str) -> None:
        """Keep no token for a gateway any more."""
        if self.has(url):
            QgsApplication.authManager().removeAuthSetting(_key(url))


def _key(url: str) -> str:
    return f"fleet_supervisor/token/{hashlib.sha256(url.encode()).hexdigest()[:32]}"
