"""Take docs/images/accounts.png, token.png and sites.png: a supervisor's windows over a real gateway.

python -m tools.pictures.supervisors [docs/images]
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.support.errors import StageError
from tests.support.fleet import account, start_gateway
from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tools.pictures.stage import SITE, drawing, part

PATIENCE_S = 60.0
REVOKED, NEW = "Cleo", "Dana"
OPERATORS = {"Ada": "supervisor", "Ben": "operator", REVOKED: "viewer"}
GATEWAY = "wss://gateway.example.org:8765/desk"
WEEK_S = 7 * 86_400.0
SERVED = "proving_ground"
SITES = {
    SERVED: {},
    "winter": {
        'id = "sample"': 'id = "winter"',
        'name = "Sample proving ground and campus"': 'name = "Winter: west road closed"',
    },
    "harbour": {
        'id = "sample"': 'id = "harbour"',
        'name = "Sample proving ground and campus"': 'name = "Harbour"',
        "origin = [640420.0, 5193480.0]": "origin = [640000.0, 5193000.0]",
    },
}
"""Folders beside one another, and what differs in each one's settings; the last lies in another frame."""


def main() -> None:
    with (
        drawing(__doc__) as folder,
        tempfile.TemporaryDirectory() as place,
        Processes(Path(place) / "logs") as processes,
    ):
        database = Path(place) / "fleet.db"
        tokens = {name: account(database, "add", name, "--role", role) for name, role in OPERATORS.items()}
        account(database, "revoke", REVOKED)
        address = start_gateway(processes, database, publish(Path(place) / "sites"))
        with connected(f"{address}/desk", tokens) as (desk, window):
            draw_sites(desk, window, folder / "sites.png")
            draw_accounts(desk, window, folder)


def publish(folder: Path) -> Path:
    """Write :data:`SITES` into ``folder`` and return the folder of the one that is served first."""
    settings = (SITE / "site.toml").read_text(encoding="utf-8")
    for name, changes in SITES.items():
        (folder / name).mkdir(parents=True)
        shutil.copy(SITE / "site.gpkg", folder / name)
        text = settings
        for before, after in changes.items():
            if before not in text:
                raise StageError(f"{SITE / 'site.toml'} has no line {before!r}")
            text = text.replace(before, after)
        (folder / name / "site.toml").write_text(text, encoding="utf-8")
    return folder / SERVED


@contextmanager
def connected(url: str, tokens: dict[str, str]) -> Iterator[tuple[Any, Any]]:
    """Connect Ben and Ada; the context is Ada's desk and a window for its dialogs."""
    from qgis.core import QgsProject
    from qgis.gui import QgsMapCanvas
    from qgis.PyQt.QtWidgets import QWidget

    credentials = part("plugin.gateway_client.connection_status").OperatorCredentials
    ben = part("plugin.gateway_client.connection").ConnectionThread()
    desk = part("plugin.control.fleet_controller").FleetController(QgsMapCanvas(), QgsProject.instance())
    try:
        ben.open(url, "Ben", credentials(tokens["Ben"]))
        wait(lambda: ben.collect_updates().link.operator == "Ben", "Ben's link")
        desk.open_link(url, "Ada", credentials(tokens["Ada"]))
        yield desk, QWidget()
    finally:
        desk.shut_down()
        ben.shut_down()


def draw_sites(desk: Any, window: Any, picture: Path) -> None:
    """Open the choice of the site with one selected that can be chosen, and take its picture."""
    dialog = part("plugin.admin.supervision").SiteChoiceDialog(desk, window)
    dialog.show()
    wait(lambda: len(dialog.model.rows) == len(SITES), "the sites")
    ready = [not row.served and row.refusal is None for row in dialog.model.rows]
    dialog.view.selectRow(ready.index(True))
    wait(lambda: dialog.selected() is not None, "the selection")
    save(dialog, picture)
    dialog.close()


def draw_accounts(desk: Any, window: Any, folder: Path) -> None:
    """Open the accounts and take their picture; make one more, and take the picture of its token.

    The token's picture is of a desk that is connected by an address that phones reach.
    """
    from qgis.PyQt.QtWidgets import QDialog, QLineEdit, QPushButton

    messages = part("robot_bridge.core.messages")
    dialog = part("plugin.admin.accounts_dialog").AccountsDialog(desk, window)
    dialog.show()
    wait(lambda: len(dialog.model.rows) == len(OPERATORS), "the accounts")
    dialog.view.selectRow(1)
    wait(lambda: dialog.selected() is not None, "the selection")
    save(dialog, folder / "accounts.png")
    question = part("plugin.admin.accounts_dialog").NewAccountDialog
    dialog._add()
    asks = dialog.findChild(question)
    asks.confirmed.emit(NEW, messages.Role.OPERATOR, WEEK_S)
    asks.close()
    wait(lambda: window.findChild(QDialog, "fleet_token_dialog") is not None, "the token")
    secret = window.findChild(QLineEdit, "fleet_new_token").text()
    made = messages.NewToken(NEW, messages.Role.OPERATOR, secret, time.time() + WEEK_S)
    token = part("plugin.admin.token_dialog").TokenDialog(made, GATEWAY, ends_link=False, parent=window)
    token.show()
    token.findChild(QPushButton, "fleet_token_copy").click()
    save(token, folder / "token.png")
    token.close()
    dialog.close_tokens()
    dialog.close()


def save(dialog: Any, picture: Path) -> None:
    """Take a dialog's picture once it is laid out."""
    from qgis.PyQt.QtTest import QTest

    QTest.qWait(100)
    if not dialog.grab().save(str(picture)):
        raise SystemExit(f"{picture} cannot be written: choose a folder that exists.")
    reduce_colours(picture)


def wait(condition: Callable[[], bool], what: str) -> None:
    """Let Qt work until ``condition`` holds; raises StageError when it does not."""
    from qgis.PyQt.QtTest import QTest

    until = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > until:
            raise StageError(f"{what} did not come within {PATIENCE_S:.0f} s")
        QTest.qWait(20)


if __name__ == "__main__":
    main()
