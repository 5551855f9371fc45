"""Where the operator's tokens are kept: encrypted, in the authentication manager of QGIS, or nowhere."""

from __future__ import annotations

from qgis.core import QgsApplication, QgsAuthMethodConfig

from ..errors import FleetError
from ..language import tr

TITLE = "Fleet Supervisor"
METHOD = "Basic"
"""The method whose user name is the operator and whose password is the token."""
HEADERS = "APIHeader"


class TokenStoreError(FleetError):
    """A token could not be kept, or not be read."""


class TokenStore:
    """Tokens as authentication configurations, listed in QGIS's options under *Authentication*.

    QGIS asks for its master password when it has to.
    """

    @property
    def is_there(self) -> bool:
        """Whether this QGIS can keep tokens."""
        return not QgsApplication.authManager().isDisabled()

    def has(self, url: str) -> bool:
        """Tell whether a token is kept for a gateway; nobody is asked for anything."""
        return bool(self.kept_for(url))

    def kept_for(self, url: str) -> str:
        """Return the id of the configuration that was kept here for a gateway, nothing where none is."""
        return self.id_of(_name(url))

    def id_of(self, name: str) -> str:
        """Return the id of the configuration called ``name``, nothing where there is none."""
        if not self.is_there:
            return ""
        known = QgsApplication.authManager().availableAuthMethodConfigs().items()
        return next((key for key, one in known if one.name() == name), "")

    def read(self, url: str) -> str:
        """Return the token for a gateway; empty where none is kept.

        :raises TokenStoreError: when QGIS does not give it, as without its master password.
        """
        config = self.kept_for(url)
        return self.token_in(config) if config else ""

    def token_in(self, config: str) -> str:
        """Return the token in the authentication configuration with the id ``config``.

        :raises TokenStoreError: when QGIS does not give it, or it holds no token.
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
        """Keep a token for a gateway, in place of one that is kept, and return its configuration's id.

        :raises TokenStoreError: when QGIS does not take it.
        """
        return self.write(self.kept_for(url), _name(url), url, token, operator)

    def write(self, config_id: str, name: str, url: str, token: str, operator: str) -> str:
        """Keep a token in the configuration ``config_id``, empty for a new one, and return its id.

        :raises TokenStoreError: when QGIS does not take it.
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
        """Keep no token for a gateway any more."""
        config = self.kept_for(url)
        if config:
            QgsApplication.authManager().removeAuthenticationConfig(config)


def _name(url: str) -> str:
    return f"{TITLE}: {url}"


def _token(config: QgsAuthMethodConfig) -> str:
    """Return the token: a password, or what a header of a web service would be sent with."""
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
