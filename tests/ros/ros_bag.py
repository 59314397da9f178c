# SPDX-License-Identifier: Apache-2.0
"""ros_bag.py PASSES SECONDS: plays what a camera saw PASSES times, SECONDS of it (10 at most), as `ros2 bag play --clock --loop` does.

One ROS 2 node publishes /clock, from the same time on in each pass; another one has use_sim_time, and publishes the pictures of a wall behind a counter, which the camera moves
along, 30 a second, with the time of its clock. Ends a second after the last one.
"""

import sys
import time

import numpy
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image

WIDTH, HEIGHT = 640, 480
BEGIN_S = 1000
EDGE = 320  # row of the counter's
FAR_M, NEAR_M = 3, 1.5  # wall, counter
STEP_PX = 3  # of the wall in a picture: .5 m/s; the counter's is twice that
K = [525.0, 0.0, 319.5, 0.0, 525.0, 239.5, 0.0, 0.0, 1.0]


def image(pixels, encoding, header):
    message = Image(header=header, height=HEIGHT, width=WIDTH, encoding=encoding, step=pixels.strides[0])
    message.data.frombytes(pixels.tobytes())
    return message


class Camera:
    def __init__(self):
        self.node = rclpy.create_node("camera", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.color = self.node.create_publisher(Image, "camera/color/image_raw", 5)
        self.depth = self.node.create_publisher(Image, "camera/aligned_depth_to_color/image_raw", 5)
        self.info = self.node.create_publisher(CameraInfo, "camera/color/camera_info", 5)
        random = numpy.random.default_rng(1)
        sizes = (4, 8, 16, 32)  # of blocks [px]
        self.texture = sum(random.integers(0, 64, (HEIGHT // size, 4 * WIDTH // size, 3), dtype=numpy.uint8).repeat(size, 0).repeat(size, 1) for size in sizes)
        self.distance = numpy.full((HEIGHT, WIDTH), round(1000 * FAR_M), numpy.uint16)
        self.distance[EDGE:] = round(1000 * NEAR_M)

    def publish(self, number):
        header = Image().header
        header.frame_id = "camera_color_optical_frame"
        header.stamp = self.node.get_clock().now().to_msg()
        picture = numpy.empty((HEIGHT, WIDTH, 3), numpy.uint8)
        for rows, step in ((slice(0, EDGE), STEP_PX), (slice(EDGE, HEIGHT), round(STEP_PX * FAR_M / NEAR_M))):
            picture[rows] = self.texture[rows, number * step:number * step + WIDTH]
        self.info.publish(CameraInfo(header=header, height=HEIGHT, width=WIDTH, distortion_model="plumb_bob", d=[0.0] * 5, k=K))
        self.color.publish(image(picture, "rgb8", header))
        self.depth.publish(image(self.distance, "16UC1", header))


def play(camera, clock, executor, pictures):
    start = time.monotonic()
    for number in range(pictures):
        now_ns = int((BEGIN_S + number / 30) * 1e9)
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(now_ns, 10**9)
        clock.publish(message)
        while camera.node.get_clock().now().nanoseconds != now_ns:
            executor.spin_once(timeout_sec=0.01)
        camera.publish(number)
        time.sleep(max(0.0, start + (number + 1) / 30 - time.monotonic()))


def main():
    passes, pictures = int(sys.argv[1]), round(30 * float(sys.argv[2]))
    rclpy.init()
    player = rclpy.create_node("player")
    clock = player.create_publisher(Clock, "/clock", 10)
    camera = Camera()
    executor = SingleThreadedExecutor()
    executor.add_node(camera.node)
    while clock.get_subscription_count() == 0 or camera.color.get_subscription_count() == 0:
        executor.spin_once(timeout_sec=0.1)
    for _ in range(passes):
        play(camera, clock, executor, pictures)
    time.sleep(1)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
