"""Work QGIS Desktop under Xvfb by mouse and keyboard, as an operator does.

python -m tools.walkthrough [operator|qgis|processing] [--pictures docs/images]

The walk *operator* takes the tour and leads a fleet; *qgis* uses what the plugin adds to QGIS itself, in its
dark theme; *processing* runs algorithms, styles the robots, and prints. Without a name all are taken.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from pathlib import Path

from robot_bridge.core.sites.site import read_site
from tests.support.errors import StageError
from tests.support.fleet import SITE, account, start_gateway, start_robots
from tests.support.forked_programs import write_shell_command
from tests.support.patience import BUSY
from tests.support.processes import Processes
from tests.support.program import ended
from tests.support.qgis import Profile, virtual_screen
from tests.support.session import follow, start_qgis
from tools.plugin_files import ROOT
from tools.walkthrough.film import Film
from tools.walkthrough.gateway import Gateway
from tools.walkthrough.operator_at_screen import OperatorAtScreen
from tools.walkthrough.scene import NAME, Scene
from tools.walkthrough.screen import Screen
from tools.walkthrough.still_buttons import StillButtons
from tools.walkthrough.walks import WALKS, Walk
from tools.walkthrough.window import Window

FOLDER = Path(os.environ.get("FLEET_WALKTHROUGH_FOLDER") or ROOT / "build" / "walkthrough")
FAILED = FOLDER / "failed.png"
"""What was on the screen when a step did not happen."""
SIZE = (1280, 800)
SPEED = 2.5
"""m/s: fast enough that nobody waits long."""
OPENING_S = BUSY * 120


def run(walk: Walk, pictures: Path) -> None:
    """Play every act.

    :raises StageError: at the first step that does not happen, or does not look right.
    """
    database, home = FOLDER / "fleet.db", make_home()
    for old in FOLDER.glob("fleet.db*"):
        old.unlink()
    with Processes(FOLDER / "logs") as processes:
        display = virtual_screen(processes, *SIZE)
        token = account(database, "add", NAME, "--role", "supervisor") if walk.accounts else ""
        address = start_gateway(processes, database)
        start_robots(processes, address, database, SPEED)
        window = open_qgis(processes, display, walk, home)
        screen = Screen(display)
        operator = OperatorAtScreen(screen, window, read_site(SITE).frame)
        operator.take_the_screen()
        film = Film(screen, operator, pictures, walk.name, StillButtons(window))
        scene = Scene(operator, film, Gateway(address, token), home, database, processes)
        try:
            for act in walk.acts:
                act(scene)
                processes.require_running()
        except StageError:
            screen.photograph(FAILED)
            raise
        window.close()


def make_home() -> Path:
    """Make the operator's home folder, with a published site in it, and return it."""
    home = FOLDER / "home"
    shutil.rmtree(home, ignore_errors=True)
    site = home / SITE.name
    site.mkdir(parents=True)
    (home / "Documents").mkdir()
    for name in ("site.toml", "site.gpkg"):
        shutil.copy(SITE / name, site)
    return home


def open_qgis(processes: Processes, display: str, walk: Walk, home: Path) -> Window:
    """Open QGIS with a new profile and return how to look at it."""
    plan = {"journal": str(FOLDER / "journal.jsonl"), "socket": str(FOLDER / "reporter")}
    Path(plan["socket"]).unlink(missing_ok=True)
    profile = Profile(FOLDER / "profile", link=False, greeted=walk.greeted, theme=walk.theme)
    # The practice fleet of the tour is looked for there; forked, it loads no modules.
    programs = FOLDER / "bin"
    programs.mkdir(exist_ok=True)
    write_shell_command(programs / "robot-bridge")
    path = os.pathsep.join((str(programs), os.environ["PATH"]))
    settings = {"HOME": str(home)}
    qgis = start_qgis(processes, profile, "reporter_session.py", plan, display, path=path, settings=settings)
    next(follow(processes, qgis, Path(plan["journal"]), OPENING_S))
    return Window(Path(plan["socket"]))


def main() -> int:
    parser = argparse.ArgumentParser(prog="walkthrough", description=__doc__.splitlines()[0])
    names = [walk.name for walk in WALKS]
    parser.add_argument("walks", nargs="*", metavar="walk", help=" or ".join(names))
    default = FOLDER / "pictures"
    parser.add_argument(
        "--pictures", type=Path, default=default, metavar="FOLDER", help="where the pictures go"
    )
    arguments = parser.parse_args()
    if unknown := set(arguments.walks) - set(names):
        parser.error(f"there is no walk {', '.join(sorted(unknown))}; there are {', '.join(names)}")

    def walked() -> None:
        for walk in WALKS:
            if walk.name in (arguments.walks or names):
                run(walk, arguments.pictures.resolve())

    return ended("walkthrough", walked, f"logs: {FOLDER / 'logs'}, screen: {FAILED}")


if __name__ == "__main__":
    sys.exit(main())
