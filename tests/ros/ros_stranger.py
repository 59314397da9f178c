# SPDX-License-Identifier: Apache-2.0
"""ros_stranger.py NAME: an ordinary ROS 2 node that publishes and hears /picture, and hears a camera, until its standard input closes.

Writes the frame_id of each picture it hears, one per line; its own are named "NAME NUMBER", a camera's "camera STAMP".
"""

import itertools
import sys
import threading

import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image


def main():
    name = sys.argv[1]
    rclpy.init()
    node = rclpy.create_node(name)
    publisher = node.create_publisher(Image, "picture", 5)
    node.create_subscription(Image, "picture", lambda picture: print(picture.header.frame_id, flush=True), 5)
    node.create_subscription(Image, "camera/color/image_raw", lambda picture: print("camera", picture.header.stamp.sec, flush=True), qos_profile_sensor_data)
    numbers = itertools.count()

    def publish():
        picture = Image()
        picture.header.frame_id = f"{name} {next(numbers)}"
        publisher.publish(picture)

    node.create_timer(0.1, publish)
    closed = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), closed.set()), daemon=True).start()
    while not closed.is_set():
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
