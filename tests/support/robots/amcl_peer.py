"""Nav2's AMCL without a ROS installation: its Python bindings in an environment of their own.

Made once in a cache folder and kept. They are a peer to measure by: nothing of the project needs them.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.support.peers import cached, run_peer

PACKAGES = ("amcl==0.1.2", "numpy==1.26.4")
DRIVE = Path(__file__).with_name("amcl_drive.py")


def amcl_python() -> Path:
    """Return the Python in which amcl can be imported; made when it is not there.

    :raises StageError: when it cannot be made: no network, or another Python than there are wheels for.
    """
    name = "-".join(["amcl-peer", *PACKAGES, "py{}.{}".format(*sys.version_info[:2])])
    return cached(name, _make) / "bin" / "python"


def _make(folder: Path) -> None:
    run_peer(sys.executable, "-m", "venv", folder)
    run_peer(folder / "bin" / "python", "-m", "pip", "install", "--quiet", "--no-input", *PACKAGES)
