"""Names of the ROS types that are read and written, by the settings that name their topics."""

from __future__ import annotations

from .effects import Action

ODOMETRY = "nav_msgs/msg/Odometry"
POSE = "geometry_msgs/msg/PoseStamped"
POSE_WITH_COVARIANCE = "geometry_msgs/msg/PoseWithCovarianceStamped"
FIX = "sensor_msgs/msg/NavSatFix"
TF = "tf2_msgs/msg/TFMessage"
IMU = "sensor_msgs/msg/Imu"
BATTERY = "sensor_msgs/msg/BatteryState"
DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
GRID = "nav_msgs/msg/OccupancyGrid"
FILTER_INFO = "nav2_msgs/msg/CostmapFilterInfo"
GET_MAP = "nav_msgs/srv/GetMap"
PATH = "nav_msgs/msg/Path"
TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
GOAL_STATUSES = "action_msgs/msg/GoalStatusArray"
CANCEL_GOAL = "action_msgs/srv/CancelGoal"
TRIGGER = "std_srvs/srv/Trigger"

READ: dict[str, tuple[str, ...]] = {
    "position": (ODOMETRY, POSE, POSE_WITH_COVARIANCE, FIX, TF),
    "imu": (IMU,),
    "tf": (TF,),
    "tf_static": (TF,),
    "battery": (BATTERY,),
    "diagnostics": (DIAGNOSTICS,),
    "image": (COMPRESSED_IMAGE, IMAGE),
}
WRITTEN: dict[str, tuple[str, ...]] = {
    "goal_pose": (POSE,),
    "path": (PATH,),
    "initial_pose": (POSE_WITH_COVARIANCE,),
    "cmd_vel": (TWIST, TWIST_STAMPED),
}
LATCHED = {
    "map": GRID,
    "keepout_mask": GRID,
    "keepout_info": FILTER_INFO,
    "speed_mask": GRID,
    "speed_info": FILTER_INFO,
}
"""What is published once, for those too that listen later."""
ACTIONS = {
    Action.TO_POSE: "navigate_to_pose",
    Action.THROUGH_POSES: "navigate_through_poses",
    Action.FOLLOW_PATH: "follow_path",
    Action.WAYPOINTS: "follow_waypoints",
}
SERVICES = ("stop", "place_cone")
"""of type Trigger."""


def action_type(action: Action) -> str:
    """Return the full name of an action's type."""
    return f"nav2_msgs/action/{action.value}"
