"""Run by test_zip_in_qgis.py in the Python of QGIS: loads the plugin and connects its desk.

python alone_in_qgis.py PLUGINS_FOLDER DESK_URL
"""

import importlib
import json
import pkgutil
import sys
import time
from pathlib import Path

FOREIGN = {
    "cbor2",
    "msgspec",
    "pyogrio",
    "pyproj",
    "rich",
    "shapely",
    "sqlalchemy",
    "typer",
    "websockets",
    "zstandard",
}
CORE = "fleet_supervisor.robot_bridge.core"
"""What the plugin uses of the bridge."""


class NothingForeign:
    """Makes every package fail to import that a stock QGIS need not have, even where one is installed."""

    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in FOREIGN:
            raise ModuleNotFoundError(f"No module named {name!r} (a stock QGIS need not have it)", name=name)


def import_everything():
    """Import every module of the plugin and of what it may use; return how many."""
    count = 0
    for name in ("fleet_supervisor.plugin", CORE):
        module = importlib.import_module(name)
        inside = pkgutil.walk_packages(getattr(module, "__path__", []), f"{name}.")
        for found in (found for found in inside if ".vendor" not in found.name):
            importlib.import_module(found.name)
            count += 1
    return count


def connect(url):
    """Return the news of a connection that is up, as the desk gets them."""
    from fleet_supervisor.plugin.gateway_client.connection import ConnectionThread

    connection = ConnectionThread()
    connection.open(url, "packaging test")
    try:
        until = time.monotonic() + 40
        while time.monotonic() < until:
            news = connection.collect_updates()
            if news.site is not None:
                return news
            time.sleep(0.05)
        sys.exit(f"not connected after 40 s: {news.link}")
    finally:
        connection.shut_down()


def main():
    folder, url = sys.argv[1:]
    sys.meta_path.insert(0, NothingForeign())
    sys.path.insert(0, folder)
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    application.initQgis()
    # Processing comes with every QGIS, beside the plugins that users install.
    sys.path.append(str(Path(QgsApplication.pkgDataPath()) / "python" / "plugins"))
    count = import_everything()
    from fleet_supervisor.plugin.ui.vendored import websocket_library

    library = websocket_library()
    news = connect(url)
    told = {
        "library": library.__name__,
        "library_file": library.__file__,
        "phase": news.link.phase.name,
        "site": news.site.id,
        "modules": count,
    }
    application.exitQgis()
    print(json.dumps(told))


main()
