# SPDX-License-Identifier: Apache-2.0
"""The messages that are read, as idl/ defines them; their fields are the whole of what decode() has to know."""

import dataclasses
import types

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, float32, float64, int8, int32, sequence, uint8, uint16, uint32, uint64

__all__ = ["MapInfo", "Octomap", "OctreeDelta", "PredictedBoxes", "TrackingState"]


def _as_bytes(cls, data, has_header=True, use_version_2=None):
    """In place of IdlStruct.deserialize(): a reader hands a sample over as it is on the wire."""
    return types.SimpleNamespace(data=bytes(data))


def _message(ros_name):
    """Declares a class as the ROS 2 message `package/Name`."""
    package, name = ros_name.split("/")

    def declare(cls):
        members = {"__annotations__": cls.__annotations__, "__module__": cls.__module__}
        struct = types.new_class(name, (IdlStruct,), {"typename": f"{package}::msg::dds_::{name}_"},
                                 lambda namespace: namespace.update(members))
        struct.deserialize = classmethod(_as_bytes)
        return final(dataclasses.dataclass(struct))
    return declare


@_message("builtin_interfaces/Time")
class Time:
    sec: int32
    nanosec: uint32


@_message("std_msgs/Header")
class Header:
    stamp: Time
    frame_id: str


@_message("geometry_msgs/Point")
class Point:
    x: float64
    y: float64
    z: float64


@_message("geometry_msgs/Quaternion")
class Quaternion:
    x: float64
    y: float64
    z: float64
    w: float64


@_message("geometry_msgs/Pose")
class Pose:
    position: Point
    orientation: Quaternion


@_message("octomap_msgs/Octomap")
class Octomap:
    header: Header
    binary: bool
    id: str
    resolution: float64
    data: sequence[int8]


@_message("rds_msgs/MapInfo")
class MapInfo:
    header: Header
    instance: uint64
    describes_full: bool
    map_epoch: uint64
    map_id: uint64
    revision: uint64
    resolution: float64
    node_count: uint64
    occupied_count: uint64
    bounds_min: array[float64, 3]
    bounds_max: array[float64, 3]
    labels: sequence[str]
    label_keys: sequence[uint16]
    label_values: sequence[uint16]
    keyframes_integrated: uint64
    last_keyframe_id: uint64
    keyframes_waiting: uint64


@_message("rds_msgs/OctreeDelta")
class OctreeDelta:
    header: Header
    instance: uint64
    map_epoch: uint64
    map_id: uint64
    base_revision: uint64
    revision: uint64
    keyframe_id: uint64
    resolution: float64
    keys: sequence[uint16]
    log_odds: sequence[float32]
    labels: sequence[uint16]
    colors: sequence[uint8]
    deleted_keys: sequence[uint16]


@_message("rds_msgs/TrackingState")
class TrackingState:
    header: Header
    instance: uint64
    map_epoch: uint64
    frame_index: uint64
    state: uint8
    features: uint32
    dynamic_features: uint32
    inliers: uint32
    is_keyframe: bool
    keyframe_id: uint64
    reference_keyframe_id: uint64
    map_from_camera: Pose
    reference_from_camera: Pose
    extract_us: uint32
    predict_us: uint32
    track_us: uint32
    total_us: uint32
    frames_dropped: uint64
    box_sets_used: uint64


@_message("rds_msgs/PredictedBoxes")
class PredictedBoxes:
    header: Header
    instance: uint64
    map_epoch: uint64
    frame_index: uint64
    ids: sequence[uint64]
    labels: sequence[str]
    scores: sequence[float32]
    boxes: sequence[float32]
    minimums: sequence[float64]
    maximums: sequence[float64]
    velocities: sequence[float64]
    covariance_traces: sequence[float64]
    ages: sequence[float64]
