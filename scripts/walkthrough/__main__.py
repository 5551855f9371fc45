"""Work QGIS Desktop under Xvfb by mouse and keyboard, as an operator does: the tour, then a real fleet.

PYTHONPATH=scripts python -m walkthrough [--pictures docs/images]
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from plugin_files import ROOT
from stage.errors import StageError
from stage.fleet import SITE, start_gateway, start_robots
from stage.processes import Processes, leave_on_signals
from stage.qgis import Profile, virtual_screen
from stage.session import follow, start_qgis

from robot_bridge.sites.publication import read_site

from .cone_target import send_cone
from .connecting import connect
from .film import Film
from .gateway import Gateway
from .operator_at_screen import OperatorAtScreen
from .replay import play_again
from .route import send_route
from .scene import Scene
from .screen import Screen
from .stopping import stop_and_clear
from .tour import take_tour
from .window import Window

FOLDER = Path(os.environ.get("FLEET_WALKTHROUGH_FOLDER") or ROOT / "build" / "walkthrough")
FAILED = FOLDER / "failed.png"
"""What was on the screen when a step did not happen."""
SIZE = (1280, 800)
SPEED = 2.5
"""m/s: fast enough that nobody waits long."""
OPENING_S = 120.0
ACTS = (take_tour, connect, send_cone, send_route, stop_and_clear, play_again)


def run(pictures: Path) -> None:
    """Play every act.

    :raises StageError: at the first step that does not happen, or does not look right.
    """
    FOLDER.mkdir(parents=True, exist_ok=True)
    for old in FOLDER.glob("fleet.db*"):
        old.unlink()
    with Processes(FOLDER / "logs") as processes:
        display = virtual_screen(processes, *SIZE)
        address = start_gateway(processes, FOLDER / "fleet.db")
        start_robots(processes, address, FOLDER / "fleet.db", SPEED)
        window = open_qgis(processes, display)
        screen = Screen(display)
        operator = OperatorAtScreen(screen, window, read_site(SITE).frame)
        operator.take_the_screen()
        scene = Scene(operator, Film(screen, operator, pictures), Gateway(address))
        try:
            for act in ACTS:
                act(scene)
                processes.require_running()
        except StageError:
            screen.photograph(FAILED)
            raise
        window.close()


def open_qgis(processes: Processes, display: str) -> Window:
    """Open QGIS with a new profile and return how to look at it."""
    plan = {"journal": str(FOLDER / "journal.jsonl"), "socket": str(FOLDER / "reporter")}
    Path(plan["socket"]).unlink(missing_ok=True)
    profile = Profile(FOLDER / "profile", link=False, greeted=False)
    # The practice fleet of the tour is looked for there.
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    qgis = start_qgis(processes, profile, "reporter_session.py", plan, display, path=path)
    next(follow(processes, qgis, Path(plan["journal"]), OPENING_S))
    return Window(Path(plan["socket"]))


def main() -> int:
    parser = argparse.ArgumentParser(prog="walkthrough", description=__doc__.splitlines()[0])
    default = FOLDER / "pictures"
    parser.add_argument(
        "--pictures", type=Path, default=default, metavar="FOLDER", help="where the pictures go"
    )
    pictures = parser.parse_args().pictures.resolve()
    leave_on_signals()
    try:
        run(pictures)
    except StageError as error:
        print(f"walkthrough: error: {error}\n(logs: {FOLDER / 'logs'}, screen: {FAILED})", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
