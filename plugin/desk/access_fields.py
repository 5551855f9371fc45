"""The operator's token and the CA file, for gateways that have accounts and TLS."""

from __future__ import annotations

from qgis.core import QgsSettings
from qgis.gui import QgsFileWidget
from qgis.PyQt.QtWidgets import QCheckBox, QGridLayout, QLabel, QLineEdit, QWidget

from ..wire.addresses import Credentials
from .token_store import TokenStore

CA_KEY = "fleet_supervisor/ca_file"
NONE_KEPT = "fleet_op_…, as it was printed when the account was made"
KEPT = "kept by QGIS; enter another one to replace it"


class AccessFields(QWidget):
    """Token, whether QGIS keeps it, and CA file. The token itself goes into no settings file."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setVisible(False)
        self._store = TokenStore()
        self._token = QLineEdit()
        self._token.setObjectName("fleet_token")
        self._token.setEchoMode(QLineEdit.EchoMode.Password)
        self._keep = QCheckBox("Keep in QGIS")
        self._keep.setObjectName("fleet_keep_token")
        self._keep.setToolTip("Encrypted, under the master password of the QGIS authentication manager")
        self._keep.setEnabled(self._store.is_there)
        self._ca = QgsFileWidget()
        self._ca.setObjectName("fleet_ca_file")
        self._ca.setFilter("Certificates (*.pem *.crt *.cer);;All files (*)")
        self._ca.setDialogTitle("The site's ca.pem")
        self._ca.setFilePath(QgsSettings().value(CA_KEY, "") or "")
        self._ca.lineEdit().setPlaceholderText("the site's ca.pem; empty for public authorities")
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(4)
        grid.addWidget(QLabel("Token"), 0, 0)
        grid.addWidget(self._token, 0, 1)
        grid.addWidget(self._keep, 0, 2)
        grid.addWidget(QLabel("CA file"), 1, 0)
        grid.addWidget(self._ca, 1, 1, 1, 2)

    def show_kept(self, url: str) -> None:
        """Show whether QGIS keeps a token for the gateway at ``url``."""
        kept = self._store.has(url)
        self._token.setPlaceholderText(KEPT if kept else NONE_KEPT)
        self._keep.setChecked(kept or (self._keep.isChecked() and bool(self._token.text())))

    def credentials(self, url: str) -> Credentials:
        """Return what stands in the fields; where no token does, the one that QGIS keeps."""
        token = self._token.text().strip()
        if not token and self._keep.isChecked():
            token = self._store.read(url)
        return Credentials(token, self._ca.filePath().strip())

    def remember(self, url: str) -> None:
        """Keep the CA file's name, and the token where that is wanted; forget it where it is not.

        :raises TokenStoreError: when QGIS does not keep it.
        """
        QgsSettings().setValue(CA_KEY, self._ca.filePath().strip())
        token = self._token.text().strip()
        if not self._keep.isChecked():
            self._store.forget(url)
        elif token:
            self._store.keep(url, token)
            self._token.clear()
        self.show_kept(url)
