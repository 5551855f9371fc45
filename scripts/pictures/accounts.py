"""Take docs/images/accounts.png: the window over the accounts of a real gateway.

PYTHONPATH=scripts python -m pictures.accounts [docs/images]
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from stage.errors import StageError
from stage.fleet import start_gateway
from stage.picture import reduce_colours
from stage.processes import Processes

from .stage import drawing, part

PATIENCE_S = 60.0
REVOKED = "Cleo"
OPERATORS = {"Ada": "supervisor", "Ben": "operator", REVOKED: "viewer"}


def main() -> None:
    with (
        drawing(__doc__) as folder,
        tempfile.TemporaryDirectory() as place,
        Processes(Path(place) / "logs") as processes,
    ):
        database = Path(place) / "fleet.db"
        tokens = {name: account(database, "add", name, "--role", role) for name, role in OPERATORS.items()}
        account(database, "revoke", REVOKED)
        draw(f"{start_gateway(processes, database)}/desk", tokens, folder / "accounts.png")


def account(database: Path, *words: str) -> str:
    """Do something to an account, and return what that prints."""
    command = [sys.executable, "-m", "robot_bridge", "operators", *words]
    command += ["--database", f"sqlite:///{database}"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def draw(url: str, tokens: dict[str, str], picture: Path) -> None:
    """Connect Ben and Ada, open the window as Ada, and take its picture."""
    from qgis.core import QgsProject
    from qgis.gui import QgsMapCanvas
    from qgis.PyQt.QtWidgets import QWidget

    credentials = part("plugin.wire.addresses").Credentials
    ben = part("plugin.connection").Connection()
    desk = part("plugin.desk.desk").Desk(QgsMapCanvas(), QgsProject.instance())
    window = QWidget()
    dialog = part("plugin.desk.accounts.accounts_dialog").AccountsDialog(desk, window)
    try:
        ben.open(url, "Ben", credentials(tokens["Ben"]))
        wait(lambda: ben.take().link.operator == "Ben", "Ben's link")
        desk.open_link(url, "Ada", credentials(tokens["Ada"]))
        dialog.show()
        wait(lambda: len(dialog.model.rows) == len(OPERATORS), "the accounts")
        dialog.view.selectRow(1)
        wait(lambda: dialog.selected() is not None, "the selection")
        if not dialog.grab().save(str(picture)):
            raise SystemExit(f"{picture} cannot be written: choose a folder that exists.")
    finally:
        dialog.close()
        desk.shut_down()
        ben.shut_down()
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
