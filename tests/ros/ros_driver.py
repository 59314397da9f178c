# SPDX-License-Identifier: Apache-2.0
"""ros_driver.py HABIT SECONDS [--ros-args …]: an ordinary ROS 2 node that publishes an RGB-D camera's pictures of a wall, 30 a second, as drivers do.

HABIT: reliable, best_effort (sensor-data QoS), compressed (PNG and compressedDepth alone), no_info, no_depth, renamed (another topic),
unknown_encoding, bgra8. Writes when it begins, in seconds since 1970, and how many it has published.
"""

import itertools
import struct
import sys
import time
import zlib

import numpy
import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

WIDTH, HEIGHT = 640, 480
FRAME = "camera_color_optical_frame"


def png(pixels):
    """Of 8-bit RGB or 16-bit grey."""
    color, depth = (2, 8) if pixels.ndim == 3 else (0, 16)
    rows = pixels.astype(">u2" if depth == 16 else "u1").reshape(HEIGHT, -1).view("u1").reshape(HEIGHT, -1)
    data = zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows), 1)

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", WIDTH, HEIGHT, depth, color, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def image(pixels, encoding, header):
    message = Image(header=header, height=HEIGHT, width=WIDTH, encoding=encoding, step=pixels.strides[0])
    message.data.frombytes(pixels.tobytes())
    return message


def main():
    habit, seconds = sys.argv[1], float(sys.argv[2])
    rclpy.init(args=sys.argv)
    node = rclpy.create_node("camera")
    qos = qos_profile_sensor_data if habit == "best_effort" else 5
    color_topic = "camera/rgb/image_raw" if habit == "renamed" else "camera/color/image_raw"
    depth_topic = "camera/aligned_depth_to_color/image_raw"
    info = node.create_publisher(CameraInfo, "camera/color/camera_info", qos) if habit != "no_info" else None
    if habit == "compressed":
        color = node.create_publisher(CompressedImage, color_topic + "/compressed", qos)
        depth = node.create_publisher(CompressedImage, depth_topic + "/compressedDepth", qos)
    else:
        color = node.create_publisher(Image, color_topic, qos)
        depth = node.create_publisher(Image, depth_topic, qos) if habit != "no_depth" else None
    blocks = numpy.random.default_rng(1).integers(0, 256, (HEIGHT // 8, WIDTH // 8, 3), dtype=numpy.uint8)
    wall = numpy.ascontiguousarray(blocks.repeat(8, 0).repeat(8, 1))
    far = numpy.full((HEIGHT, WIDTH), 2000, numpy.uint16)
    packed = (png(wall), bytes(12) + png(far))
    bgra = numpy.ascontiguousarray(numpy.dstack([wall[:, :, ::-1], numpy.full((HEIGHT, WIDTH), 255, numpy.uint8)]))
    print(time.time(), flush=True)
    start = time.monotonic()
    for number in itertools.count():
        if time.monotonic() - start > seconds:
            break
        header = Image().header
        header.frame_id = FRAME
        header.stamp = node.get_clock().now().to_msg()
        if info:
            info.publish(CameraInfo(header=header, height=HEIGHT, width=WIDTH, distortion_model="plumb_bob", d=[0.0] * 5,
                                    k=[525.0, 0.0, 319.5, 0.0, 525.0, 239.5, 0.0, 0.0, 1.0]))
        if habit == "compressed":
            for publisher, kind, data in ((color, "rgb8; png compressed bgr8", packed[0]), (depth, "16UC1; compressedDepth png", packed[1])):
                message = CompressedImage(header=header, format=kind)
                message.data.frombytes(data)
                publisher.publish(message)
        else:
            color.publish(image(bgra, "bgra8", header) if habit == "bgra8" else image(wall, "nv21" if habit == "unknown_encoding" else "rgb8", header))
            if depth:
                depth.publish(image(far, "16UC1", header))
        time.sleep(max(0.0, start + (number + 1) / 30 - time.monotonic()))
    print(number, flush=True)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
