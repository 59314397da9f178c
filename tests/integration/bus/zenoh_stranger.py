# SPDX-License-Identifier: Apache-2.0
"""A node of ROS 2 on Zenoh made of PyPI's zenoh-ros2-sdk: zenoh_stranger.py talk|listen|call|look TOPIC DOMAIN SECONDS

talk: publishes ten numbers a second, on `picture` as frame_id of pictures of .9 MB all of whose bytes are the number, else as std_msgs/String.
listen: prints the number of each that it hears, of pictures "torn" if they are made of several. call: calls a service (std_srvs/srv/SetBool) with
true and false and prints the answers. look: prints in JSON whom it sees, and what PyPI's pamoja-ros2 makes of the same names.
"""
import dataclasses
import json
import os
import sys
import time

mode, topic, domain, seconds = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
# In place of the router that rmw_zenoh's nodes find each other by: this machine's multicast, as our programs do.
os.environ["ZENOH_CONFIG_OVERRIDE"] = ";".join([
    "connect/endpoints=[]", "scouting/multicast/enabled=true", f'scouting/multicast/address="224.0.0.224:{7000 + domain}"',
    'scouting/multicast/interface="127.0.0.1"', 'listen/endpoints=["tcp/127.0.0.1:0"]'])

import numpy as np  # noqa: E402
import zenoh_ros2_sdk as sdk  # noqa: E402
from pamoja import ros2 as pamoja  # noqa: E402
from zenoh_ros2_sdk.qos import QosProfile  # noqa: E402
from zenoh_ros2_sdk.utils import get_type_hash  # noqa: E402

PARTS = {"std_msgs/msg/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
         "builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec\n"}
IMAGE = """std_msgs/Header header
uint32 height
uint32 width
string encoding
uint8 is_bigendian
uint32 step
uint8[] data
"""
DEFINITIONS = {"sensor_msgs/msg/Image": (IMAGE, PARTS), "std_msgs/msg/String": ("string data\n", {})}


def own_hash(kind):
    """As the SDK computes it of the definition: ours has to be the same, else nothing is exchanged."""
    definition, parts = DEFINITIONS[kind]
    return get_type_hash(kind, definition, parts)


def endpoint(make, kind, *arguments, **more):
    definition, parts = DEFINITIONS[kind]
    whole = definition + "".join(f"{80 * '='}\nMSG: {name.replace('/msg/', '/')}\n{part}" for name, part in parts.items())
    return make(f"/{topic}", kind, *arguments, msg_definition=whole, type_hash=own_hash(kind), domain_id=domain, node_name="stranger", **more)


def picture_of(types, number):
    header = types["std_msgs/msg/Header"](stamp=types["builtin_interfaces/msg/Time"](sec=1, nanosec=2), frame_id=str(number))
    return {"header": header, "height": 480, "width": 640, "encoding": "rgb8", "is_bigendian": 0, "step": 1920,
            "data": np.full(480 * 1920, number % 256, np.uint8)}


def talk():
    publisher = endpoint(sdk.ROS2Publisher, KIND)
    types = publisher.session_mgr.store.types
    end = time.monotonic() + seconds
    number = 0
    while time.monotonic() < end:
        publisher.publish(**(picture_of(types, number) if topic == "picture" else {"data": str(number)}))
        number += 1
        time.sleep(0.1)


def say(message):
    if topic != "picture":
        print(message.data, flush=True)
    else:
        print(message.header.frame_id if (message.data == message.data[0]).all() else "torn", len(message.data), flush=True)


def listen():
    while sdk.get_topic_info(f"/{topic}", domain) is None:  # whom it does not see yet it asks for nothing
        time.sleep(0.1)
    subscriber = endpoint(sdk.ROS2Subscriber, KIND, say, **({} if topic == "picture" else {"qos": ":1:,100:,:,:,,"}))
    time.sleep(seconds)
    subscriber.close()


def call():
    # Jazzy's std_srvs/srv/SetBool.json
    client = sdk.ROS2ServiceClient(f"/{topic}", "std_srvs/srv/SetBool", "bool data", "bool success\nstring message", node_name="stranger",
                                   domain_id=domain, type_hash="RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a", timeout=2)
    end = time.monotonic() + seconds
    for data in (True, False):
        answer = None
        while answer is None and time.monotonic() < end:  # it may not have found the service yet
            answer = client.call(data=data)
        print(answer and (bool(answer.success), answer.message), flush=True)
    client.close()


def judged(name, kind, type_hash):
    return {"key": pamoja.entity_key(domain, name, kind, type_hash), "digest": bytes(pamoja.type_hash_digest(type_hash) or b"").hex(),
            "in_token": f"{pamoja.percent_mangle(name)}/{pamoja.dds_type_name(kind)}"}


def look():
    session = sdk.ZenohSession.get_instance()
    heard = set()
    subscriber = session.session.declare_subscriber(f"{domain}/**", lambda sample: heard.add(str(sample.key_expr)))
    time.sleep(seconds)
    subscriber.undeclare()
    tokens = [str(reply.ok.key_expr) for reply in session.liveliness.get(f"@ros2_lv/{domain}/**", timeout=2) if reply.ok]
    report = {"heard": sorted(heard), "tokens": tokens, "hashes": {kind: own_hash(kind) for kind in DEFINITIONS},
              "services": dict(sdk.get_service_names_and_types(domain)), "topics": {}}
    for name, kinds in sdk.get_topic_names_and_types(domain):
        writer, = sdk.get_topic_info(name, domain, verbose=True).publishers
        qos = QosProfile.decode(writer.qos)
        report["topics"][name] = dataclasses.asdict(writer) | {
            "kinds": kinds, "pamoja": judged(name, kinds[0], writer.type_hash),
            "qos": [qos.reliability.name, qos.durability.name, qos.history_kind.name, qos.history_depth]}
    print(json.dumps(report), flush=True)


KIND = "sensor_msgs/msg/Image" if topic == "picture" else "std_msgs/msg/String"
{"talk": talk, "listen": listen, "call": call, "look": look}[mode]()
