"""The operator's token and the CA file, for gateways that have accounts and TLS."""

from __future__ import annotations

from qgis.core import QgsSettings
from qgis.PyQt.QtWidgets import QCheckBox, QGridLayout, QLabel, QLineEdit, QWidget

from ..file_dialogs import file_field
from ..language import tr
from ..settings.token_store import TokenStore
from ..wire.addresses import Credentials

CA_KEY = "fleet_supervisor/ca_file"
NONE_KEPT = tr("fleet_op_…, as it was printed when the account was made")
KEPT = tr("kept by QGIS; enter another one to replace it")
BY_CONNECTION = tr("of the connection's authentication; enter another one for this time")


class AccessFields(QWidget):
    """Token, whether QGIS keeps it, and CA file. The token itself goes into no settings file."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setVisible(False)
        self._store = TokenStore()
        self._auth = ""
        self._token = QLineEdit()
        self._token.setObjectName("fleet_token")
        self._token.setEchoMode(QLineEdit.EchoMode.Password)
        self._keep = QCheckBox(tr("Keep in QGIS"))
        self._keep.setObjectName("fleet_keep_token")
        self._keep.setToolTip(tr("Encrypted, under the master password of the QGIS authentication manager"))
        self._keep.setEnabled(self._store.is_there)
        self._ca = file_field()
        self._ca.setObjectName("fleet_ca_file")
        self._ca.setFilter(tr("Certificates (*.pem *.crt *.cer);;All files (*)"))
        self._ca.setDialogTitle(tr("The site's ca.pem"))
        self._ca.setFilePath(QgsSettings().value(CA_KEY, "") or "")
        hint = tr("the site's ca.pem; empty for public authorities")
        self._ca.lineEdit().setPlaceholderText(hint)
        self._ca.lineEdit().setToolTip(hint)
        self._lay_out()

    def show_kept(self, url: str) -> None:
        """Show whether QGIS keeps a token for the gateway at ``url``."""
        kept = self._store.has(url)
        hint = BY_CONNECTION if self._auth else KEPT if kept else NONE_KEPT
        self._token.setPlaceholderText(hint)
        self._token.setToolTip(hint)
        self._keep.setChecked(kept or (self._keep.isChecked() and bool(self._token.text())))

    def use(self, auth: str, ca_file: str | None = None) -> None:
        """Take the token out of the authentication configuration ``auth``; ``ca_file`` where one is given."""
        self._auth = auth
        self._token.clear()
        if ca_file is not None:
            self._ca.setFilePath(ca_file)

    def ca_file(self) -> str:
        """Return the CA file's name as it stands in the field."""
        return self._ca.filePath().strip()

    def credentials(self, url: str) -> Credentials:
        """Return what stands in the fields; where no token does, the one that QGIS keeps.

        :raises TokenStoreError: when QGIS does not give it.
        """
        token = self._token.text().strip()
        if not token and self._auth:
            token = self._store.token_in(self._auth)
        elif not token and self._keep.isChecked():
            token = self._store.read(url)
        return Credentials(token, self.ca_file())

    def remember(self, url: str, operator: str = "") -> None:
        """Keep the CA file's name, and the token where that is wanted; forget it where it is not.

        :raises TokenStoreError: when QGIS does not keep it.
        """
        QgsSettings().setValue(CA_KEY, self.ca_file())
        token = self._token.text().strip()
        if self._auth:
            # The connection's own; another token typed over it is for this time.
            return
        if not self._keep.isChecked():
            self._store.forget(url)
        elif token:
            self._store.keep(url, token, operator)
            self._token.clear()
        self.show_kept(url)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(6)
        grid.setVerticalSpacing(4)
        for row, (text, field) in enumerate(((tr("Token"), self._token), (tr("CA file"), self._ca))):
            label = QLabel(text)
            label.setBuddy(field)
            grid.addWidget(label, row, 0)
        grid.addWidget(self._token, 0, 1)
        grid.addWidget(self._keep, 0, 2)
        grid.addWidget(self._ca, 1, 1, 1, 2)
