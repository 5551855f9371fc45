"""A ROS 2 robot for tests and demonstrations: a real rclpy node that drives where Nav2's actions send it.

Run by the Python of :mod:`.ros_peer`, which knows nothing of this project. Each thing that happens is one
line of JSON. What it is to do wrong is asked for by ``--odd``.
"""

from __future__ import annotations

import argparse
import json
import math
import threading
import time
from functools import partial
from typing import Any

import rclpy
from action_msgs.srv import CancelGoal  # noqa: F401 - its type support is loaded before threads begin
from geometry_msgs.msg import PoseStamped, Twist
from nav2_msgs.action import FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose
from nav2_msgs.msg import CostmapFilterInfo, WaypointStatus
from nav_msgs.msg import OccupancyGrid, Odometry
from nav_msgs.srv import GetMap
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import BatteryState, CompressedImage, Image
from std_srvs.srv import Trigger

ODD = (
    "nan",
    "rejects",
    "stubborn",
    "fails",
    "gives-up",
    "old-clock",
    "other-frame",
    "no-actions",
    "deaf-stop",
    "silent",
    "misses",
    "late-goals",
)
ACTIONS: dict[str, tuple[Any, Any]] = {
    "navigate_to_pose": (NavigateToPose, lambda goal: [goal.pose]),
    "navigate_through_poses": (NavigateThroughPoses, lambda goal: goal.poses.goals),
    "follow_path": (FollowPath, lambda goal: goal.path.poses),
    "follow_waypoints": (FollowWaypoints, lambda goal: goal.poses),
}
TICK = 0.2
"""seconds between looks at a goal: each costs a robot that drives, and all who listen to it."""
GIVES_UP_AT = 22.0
"""metres."""
LATE = 1.5
"""seconds in which a robot thinks about a goal, and a cancel that comes meanwhile finds none."""
MASK_PLACES = {"road": (20.0, 8.0), "excavation": (95.0, 151.0)}
"""Metres in the map frame, whose grid begins at 0, 0."""


def say(event: str, **more: object) -> None:
    """Print what has happened."""
    # With its end in one piece: several threads say something.
    print(json.dumps({"event": event, **more}) + "\n", end="", flush=True)


class Robot(Node):
    """Stands until a goal comes, then drives straight to it, or from point to point of a path."""

    def __init__(self, options: argparse.Namespace) -> None:
        super().__init__("robot", namespace=options.name)
        self.options = options
        self.x, self.y, self.theta, self.v = options.x, options.y, 0.0, 0.0
        self.points: list[tuple[float, float]] = []
        self.braked = False
        """Whether it stands because its stop service was called; its goal is open until somebody ends it."""
        self.driving = threading.Lock()
        self.moved_at = time.monotonic()
        self.newest: object = None
        self.battery_at = 0
        """The second in which it said last how full its battery is."""
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        fast = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.is_led = "deaf-stop" in options.odd
        if "silent" not in options.odd:
            self.odom = self.create_publisher(Odometry, "odom", fast)
            self.battery = self.create_publisher(BatteryState, "battery_state", 10)
            # One timer for all that comes again: a look at all timers, topics and servers is dear.
            self.create_timer(1.0 / options.rate, self.report)
        self.create_subscription(OccupancyGrid, "map", self.map_came, latched)
        for name in ("keepout", "speed"):
            self.create_subscription(OccupancyGrid, f"{name}_mask", partial(self.mask_came, name), latched)
            self.create_subscription(CostmapFilterInfo, f"{name}_info", self.filter_came, latched)
        if options.image:
            kind = Image if options.image == "raw" else CompressedImage
            self.camera = self.create_publisher(kind, "camera", fast)
            self.create_timer(0.2, self.report_image)
        if "no-actions" in options.odd:
            self.create_subscription(PoseStamped, "goal_pose", self.goal_came, 10)
        else:
            for name in options.actions or ("navigate_to_pose", "follow_path"):
                self.serve(ACTIONS[name][0], name, ACTIONS[name][1])
        if "deaf-stop" not in options.odd:
            self.create_subscription(Twist, "cmd_vel", self.twist_came, 10)
            self.create_service(Trigger, "stop", self.stop_called)
        self.create_service(Trigger, "place_cone", self.cone_called)
        if options.asks_map:
            self.map_client = self.create_client(GetMap, "get_map")
            self.create_timer(0.5, self.ask_map)

    def serve(self, kind: Any, name: str, points_of: Any):
        """Offer an action whose goals are driven."""
        ActionServer(
            self,
            kind,
            name,
            lambda goal: self.execute(kind, goal, points_of(goal.request)),
            goal_callback=self.goal_asked,
            cancel_callback=self.cancel_asked,
            callback_group=ReentrantCallbackGroup() if "late-goals" in self.options.odd else None,
        )

    def goal_asked(self, goal: Any):
        """Take a goal on, or not."""
        refuses = "rejects" in self.options.odd
        say("goal asked", refuses=refuses)
        if "late-goals" in self.options.odd:
            time.sleep(LATE)
        return GoalResponse.REJECT if refuses else GoalResponse.ACCEPT

    def cancel_asked(self, goal: Any):
        """Give a goal up, or not."""
        refuses = "stubborn" in self.options.odd
        say("cancel asked", refuses=refuses)
        return CancelResponse.REJECT if refuses else CancelResponse.ACCEPT

    def execute(self, kind: Any, goal: Any, poses: Any):
        """Drive a goal to its end, as Nav2 does: a newer one takes its place."""
        self.newest = goal
        self.drive()  # what it drove until now is no part of this
        self.braked = False
        self.points = [(pose.pose.position.x, pose.pose.position.y) for pose in poses]
        say("goal", kind=kind.__name__, id=bytes(goal.goal_id.uuid).hex(), points=self.points)
        result = kind.Result()
        while rclpy.ok():
            if "fails" in self.options.odd or ("gives-up" in self.options.odd and self.x > GIVES_UP_AT):
                result.error_code, result.error_msg = 9003, "a test asked for it"
                goal.abort()
                break
            if goal.is_cancel_requested:
                if self.newest is goal:
                    self.points, self.v = [], 0.0
                goal.canceled()
                break
            if self.newest is not goal:
                goal.abort()
                break
            misses = kind is FollowWaypoints and "misses" in self.options.odd
            # It leaves out the last point: where it stands nobody takes for the end of the route.
            if len(self.points) <= int(misses):
                if misses:
                    result.missed_waypoints = [WaypointStatus(waypoint_index=2)]
                goal.succeed()
                break
            goal.publish_feedback(self.feedback(kind))
            time.sleep(TICK)
            self.drive()
        say("goal ended", id=bytes(goal.goal_id.uuid).hex(), status=int(goal.status))
        return result

    def feedback(self, kind: Any):
        """Return how far it is yet."""
        told = kind.Feedback()
        left = math.hypot(self.points[-1][0] - self.x, self.points[-1][1] - self.y) if self.points else 0.0
        if kind is FollowPath:
            told.distance_to_goal = left
        elif kind is not FollowWaypoints:
            told.distance_remaining = left
        return told

    def drive(self):
        """Go on for as long as has passed, which is more than a tick on a busy machine."""
        with self.driving:
            now = time.monotonic()
            left, self.moved_at = self.options.speed * (now - self.moved_at), now
            points = ahead = [] if self.braked else self.points
            self.v = self.options.speed if points else 0.0
            while ahead and left > 0:
                x, y = ahead[0]
                away = math.hypot(x - self.x, y - self.y)
                if away <= left:
                    self.x, self.y, ahead = x, y, ahead[1:]
                else:
                    self.theta = math.atan2(y - self.y, x - self.x)
                    self.x += left * math.cos(self.theta)
                    self.y += left * math.sin(self.theta)
                left -= away
            if self.points is points:  # else there is another goal by now, or none
                self.points = ahead

    def report(self):
        """Say where it is, and how full its battery is."""
        self.drive()
        self.find_leader()
        told = Odometry()
        told.header.frame_id = "elsewhere" if "other-frame" in self.options.odd else "map"
        told.child_frame_id = "base_link"
        told.header.stamp = self.get_clock().now().to_msg()
        if "old-clock" in self.options.odd:
            told.header.stamp.sec -= 86_400
        told.pose.pose.position.x = math.nan if "nan" in self.options.odd else self.x
        told.pose.pose.position.y = self.y
        told.pose.pose.orientation.z, told.pose.pose.orientation.w = (
            math.sin(self.theta / 2),
            math.cos(self.theta / 2),
        )
        told.twist.twist.linear.x = self.v
        self.odom.publish(told)
        if told.header.stamp.sec != self.battery_at:
            self.battery_at = told.header.stamp.sec
            self.battery.publish(BatteryState(percentage=0.75))

    def report_image(self):
        """Say what it sees: two red pixels and a blue one, or bytes that begin as a JPEG does."""
        if self.options.image == "raw":
            told = Image(height=1, width=3, encoding="bgr8", step=9, data=[0, 0, 255, 0, 0, 255, 255, 0, 0])
        else:
            begin = b"\xff\xd8\xff\xe0" if self.options.image == "jpeg" else b"depth"
            told = CompressedImage(format=self.options.image, data=begin + bytes(100))
        told.header.frame_id = "front_camera"
        told.header.stamp = self.get_clock().now().to_msg()
        self.camera.publish(told)

    def map_came(self, grid: Any):
        """Note a map."""
        say("map", columns=grid.info.width, rows=grid.info.height, frame=grid.header.frame_id)

    def ask_map(self):
        """Ask for the map by its service, again and again."""
        if self.map_client.service_is_ready():
            self.map_client.call_async(GetMap.Request()).add_done_callback(self.map_answered)

    def map_answered(self, asked: Any):
        """Note a map that was asked for."""
        grid = asked.result().map
        say("map answered", columns=grid.info.width, cells=list(grid.data))

    def mask_came(self, name: str, grid: Any):
        """Note a mask of a costmap filter, and what is at some places."""
        info = grid.info
        cells = {
            place: grid.data[int(y / info.resolution) * info.width + int(x / info.resolution)]
            for place, (x, y) in MASK_PLACES.items()
        }
        say("mask", name=name, columns=info.width, rows=info.height, cells=cells)

    def filter_came(self, info: Any):
        """Note what a mask is for."""
        say("filter", type=info.type, mask=info.filter_mask_topic, multiplier=info.multiplier)

    def goal_came(self, pose: Any):
        """Drive to a target that came on a topic."""
        self.drive()
        self.braked = False
        self.points = [(pose.pose.position.x, pose.pose.position.y)]
        say("goal pose", points=self.points)

    def find_leader(self):
        """Say once that somebody may tell it its speed: what is said before that it does not hear."""
        if not self.is_led and self.count_publishers("cmd_vel"):
            say("led")
            self.is_led = True

    def twist_came(self, twist: Any):
        """Stand when told so."""
        if twist.linear.x == 0.0 and twist.angular.z == 0.0:
            say("zero twist")

    def stop_called(self, _: Any, answer: Any):
        """Stop, and leave the goal open, as the brake of a robot does that Nav2 drives."""
        refuses = "stubborn" in self.options.odd
        say("stop", refuses=refuses)
        self.braked = self.braked or not refuses
        answer.success, answer.message = not refuses, "the brake is stuck" if refuses else ""
        return answer

    def cone_called(self, _: Any, answer: Any):
        """Place a cone."""
        say("cone", x=self.x, y=self.y)
        answer.success = True
        return answer


def main() -> None:
    """Run one robot until the program is ended."""
    parser = argparse.ArgumentParser()
    parser.add_argument("name")
    parser.add_argument("--x", type=float, default=20.0)
    parser.add_argument("--y", type=float, default=8.0)
    parser.add_argument("--speed", type=float, default=2.0)
    parser.add_argument("--rate", type=float, default=5.0)
    parser.add_argument("--odd", action="append", default=[], choices=ODD)
    parser.add_argument("--asks-map", action="store_true")
    parser.add_argument("--image", choices=["raw", "jpeg", "depth"])
    parser.add_argument("--actions", action="append", choices=list(ACTIONS))
    options = parser.parse_args()
    rclpy.init()
    executor = MultiThreadedExecutor(8)
    executor.add_node(Robot(options))
    say("up")
    executor.spin()


if __name__ == "__main__":
    main()
