#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A client of the bus that none of our code is part of: PyPI package cyclonedds (tested with 11.0.1).

    external_client.py --domain 0 --seconds 10 [--loopback] [--topic rds/odometry ...]

subscribes the topics and writes one JSON line per message to standard output: {"topic", "type", "received_ns", "message"};
at the end one line {"counts": {topic: number}}. Sequences longer than 64 elements are written as {"length", "sum"}.
Exit status 0 if every topic brought at least one message, 1 if not.
"""

import argparse
import dataclasses
import json
import os
import sys
import time
import types

LOOPBACK = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/>
</Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>60</MaxAutoParticipantIndex><Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""
# Set before the import: cyclonedds reads it when its first domain opens.
if "--loopback" in sys.argv:
    os.environ["CYCLONEDDS_URI"] = LOOPBACK

from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.idl import IdlStruct  # noqa: E402
from cyclonedds.idl.annotations import final  # noqa: E402
from cyclonedds.idl.types import array, float64, int8, int32, sequence, uint32  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from cyclonedds.util import duration  # noqa: E402


def message(ros_name):
    """Declares a class as the ROS 2 message `package/Name`."""
    package, name = ros_name.split("/")

    def declare(cls):
        members = {"__annotations__": cls.__annotations__, "__module__": cls.__module__}
        struct = types.new_class(name, (IdlStruct,), {"typename": f"{package}::msg::dds_::{name}_"},
                                 lambda namespace: namespace.update(members))
        return final(dataclasses.dataclass(struct))
    return declare


@message("builtin_interfaces/Time")
class Time:
    sec: int32
    nanosec: uint32


@message("std_msgs/Header")
class Header:
    stamp: Time
    frame_id: str


@message("geometry_msgs/Point")
class Point:
    x: float64
    y: float64
    z: float64


@message("geometry_msgs/Vector3")
class Vector3:
    x: float64
    y: float64
    z: float64


@message("geometry_msgs/Quaternion")
class Quaternion:
    x: float64
    y: float64
    z: float64
    w: float64


@message("geometry_msgs/Pose")
class Pose:
    position: Point
    orientation: Quaternion


@message("geometry_msgs/PoseWithCovariance")
class PoseWithCovariance:
    pose: Pose
    covariance: array[float64, 36]


@message("geometry_msgs/Twist")
class Twist:
    linear: Vector3
    angular: Vector3


@message("geometry_msgs/TwistWithCovariance")
class TwistWithCovariance:
    twist: Twist
    covariance: array[float64, 36]


@message("nav_msgs/Odometry")
class Odometry:
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


@message("geometry_msgs/Transform")
class Transform:
    translation: Vector3
    rotation: Quaternion


@message("geometry_msgs/TransformStamped")
class TransformStamped:
    header: Header
    child_frame_id: str
    transform: Transform


@message("tf2_msgs/TFMessage")
class TFMessage:
    transforms: sequence[TransformStamped]


@message("vision_msgs/ObjectHypothesis")
class ObjectHypothesis:
    class_id: str
    score: float64


@message("vision_msgs/ObjectHypothesisWithPose")
class ObjectHypothesisWithPose:
    hypothesis: ObjectHypothesis
    pose: PoseWithCovariance


@message("vision_msgs/BoundingBox3D")
class BoundingBox3D:
    center: Pose
    size: Vector3


@message("vision_msgs/Detection3D")
class Detection3D:
    header: Header
    results: sequence[ObjectHypothesisWithPose]
    bbox: BoundingBox3D
    id: str


@message("vision_msgs/Detection3DArray")
class Detection3DArray:
    header: Header
    detections: sequence[Detection3D]


@message("octomap_msgs/Octomap")
class Octomap:
    header: Header
    binary: bool
    id: str
    resolution: float64
    data: sequence[int8]


TRANSIENT_LOCAL = True
TOPICS = {  # name: (type, durability, history depth), as in the table of topics
    "rds/odometry": (Odometry, not TRANSIENT_LOCAL, 10),
    "tf": (TFMessage, not TRANSIENT_LOCAL, 100),
    "rds/boxes": (Detection3DArray, not TRANSIENT_LOCAL, 10),
    "rds/map/full": (Octomap, TRANSIENT_LOCAL, 1),
}


def make_reader(participant, name):
    kind, latched, depth = TOPICS[name]
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)),
              Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
              Policy.History.KeepLast(depth), Policy.DataRepresentation(use_cdrv0_representation=True))
    return DataReader(participant, Topic(participant, "rt/" + name, kind, qos=qos), qos=qos)


def to_json(value):
    if dataclasses.is_dataclass(value):
        return {f.name: to_json(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, (list, tuple, bytes)):
        return {"length": len(value), "sum": sum(value)} if len(value) > 64 else [to_json(v) for v in value]
    return value


def collect(readers, seconds):
    counts = dict.fromkeys(readers, 0)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for name, reader in readers.items():
            for sample in reader.take(N=100):
                if not dataclasses.is_dataclass(sample):
                    continue  # a change of state without data
                counts[name] += 1
                line = {"topic": name, "type": TOPICS[name][0].__idl_typename__, "received_ns": time.time_ns(),
                        "message": to_json(sample)}
                print(json.dumps(line), flush=True)
        time.sleep(0.005)
    return counts


def main():
    parser = argparse.ArgumentParser(description="Writes what it hears on the bus as JSON lines.")
    parser.add_argument("--domain", type=int, default=int(os.environ.get("ROS_DOMAIN_ID", "0")))
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--loopback", action="store_true", help="this machine only, as `rds run` does")
    parser.add_argument("--topic", action="append", choices=sorted(TOPICS), help="default: all")
    args = parser.parse_args()
    participant = DomainParticipant(args.domain)
    readers = {name: make_reader(participant, name) for name in args.topic or TOPICS}
    counts = collect(readers, args.seconds)
    print(json.dumps({"counts": counts}))
    return 0 if all(counts.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
