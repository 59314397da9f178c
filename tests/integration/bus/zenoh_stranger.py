# SPDX-License-Identifier: Apache-2.0
"""A node of ROS 2 on Zenoh made of PyPI's zenoh-ros2-sdk: zenoh_stranger.py talk|listen|call TOPIC DOMAIN SECONDS

Publishes small pictures with numbers as frame_id, or prints the frame_id of each that it hears, or calls a service (std_srvs/srv/SetBool) with
true and false and prints the answers.
"""
import os
import sys
import time

mode, topic, domain, seconds = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
# In place of the router that rmw_zenoh's nodes find each other by: this machine's multicast, as our programs do.
os.environ["ZENOH_CONFIG_OVERRIDE"] = ";".join([
    "connect/endpoints=[]", "scouting/multicast/enabled=true", f'scouting/multicast/address="224.0.0.224:{7000 + domain}"',
    'scouting/multicast/interface="127.0.0.1"', 'listen/endpoints=["tcp/127.0.0.1:0"]'])

import numpy as np  # noqa: E402
from zenoh_ros2_sdk import ROS2Publisher, ROS2ServiceClient, ROS2Subscriber  # noqa: E402

HASH = "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"
DEFINITION = """std_msgs/Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""

if mode == "call":
    # Jazzy's std_srvs/srv/SetBool.json
    client = ROS2ServiceClient(f"/{topic}", "std_srvs/srv/SetBool", "bool data", "bool success\nstring message", node_name="stranger", domain_id=domain,
                               type_hash="RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a", timeout=2)
    end = time.monotonic() + seconds
    for data in (True, False):
        answer = None
        while answer is None and time.monotonic() < end:  # it may not have found the service yet
            answer = client.call(data=data)
        print(answer and (bool(answer.success), answer.message), flush=True)
    client.close()
elif mode == "talk":
    publisher = ROS2Publisher(f"/{topic}", "sensor_msgs/msg/Image", DEFINITION, type_hash=HASH, domain_id=domain, node_name="stranger")
    types = publisher.session_mgr.store.types
    end = time.monotonic() + seconds
    number = 0
    while time.monotonic() < end:
        header = types["std_msgs/msg/Header"](stamp=types["builtin_interfaces/msg/Time"](sec=1, nanosec=2), frame_id=str(number))
        publisher.publish(header=header, height=10, width=10, encoding="rgb8", is_bigendian=0, step=30, data=np.zeros(300, np.uint8))
        number += 1
        time.sleep(0.1)
else:
    subscriber = ROS2Subscriber(f"/{topic}", "sensor_msgs/msg/Image", lambda image: print(image.header.frame_id, flush=True), DEFINITION,
                                type_hash=HASH, domain_id=domain, node_name="stranger")
    time.sleep(seconds)
