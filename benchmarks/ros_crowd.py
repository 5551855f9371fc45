"""Many ROS 2 robots in one node, and rclpy's own subscriber to all of them.

``ros_crowd.py publish ROBOTS RATE`` or ``ros_crowd.py listen ROBOTS``, by the Python of
:mod:`tests.support.robots.ros_peer`. The listener is told windows as lines of JSON, and answers each with the
delays in ms, median and p99.
"""

from __future__ import annotations

import json
import sys
import threading
import time

import rclpy
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy

FAST = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def publish(robots: int, rate: float) -> None:
    """Publish Odometry of each robot, evenly, until killed."""
    node = rclpy.create_node("crowd")
    publishers = [node.create_publisher(Odometry, f"/ros_{n}/odom", FAST) for n in range(robots)]
    message = Odometry()
    message.header.frame_id = "map"
    message.pose.pose.orientation.w = 1.0
    message.twist.twist.linear.x = 1.0
    print("up", flush=True)
    begin, number, gap = time.monotonic(), 0, 1 / (robots * rate)
    while True:
        while begin + number * gap <= (now := time.monotonic()):
            robot = number % robots
            place = message.pose.pose.position
            place.x, place.y = 10.0 + robot % 30 + (number // robots) % 50 / rate, 20.0 + robot / 100
            stamp = time.time()
            message.header.stamp.sec = int(stamp)
            message.header.stamp.nanosec = int(stamp % 1 * 1e9)
            publishers[robot].publish(message)
            number += 1
        time.sleep(max(0.0, min(begin + number * gap - now, 0.01)))


def listen(robots: int) -> None:
    """Take in what all robots publish, and tell of each window that is asked for."""
    node = rclpy.create_node("listener")
    delays: list[tuple[float, float]] = []

    def hear(message: Odometry) -> None:
        stamp = message.header.stamp
        delays.append((time.monotonic(), time.time() - stamp.sec - stamp.nanosec / 1e9))

    for n in range(robots):
        node.create_subscription(Odometry, f"/ros_{n}/odom", hear, FAST)
    threading.Thread(target=answer, args=(delays,), daemon=True).start()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    print("up", flush=True)
    executor.spin()


def answer(delays: list[tuple[float, float]]) -> None:
    """Tell of the windows that come on standard input."""
    for line in sys.stdin:
        window = json.loads(line)
        time.sleep(max(0.0, window["begin"] + window["seconds"] - time.monotonic()))
        found = sorted(1e3 * delay for at, delay in list(delays) if at >= window["begin"])
        delays.clear()
        parts = [found[int(part * (len(found) - 1))] if found else None for part in (0.5, 0.99)]
        print(json.dumps({"heard": len(found), "delays": parts}), flush=True)


if __name__ == "__main__":
    rclpy.init()
    if sys.argv[1] == "publish":
        publish(int(sys.argv[2]), float(sys.argv[3]))
    else:
        listen(int(sys.argv[2]))
