# SPDX-License-Identifier: Apache-2.0
"""Where the robot is and who passes, from the tracker's messages of each frame. Knows no bus."""

import dataclasses

import numpy as np

from rds_map.cdr import MalformedMessage

TRACKING, WEAK, RELOCALISED = 1, 2, 4


@dataclasses.dataclass(frozen=True)
class Pose:
    """Of the camera (x right, y down, z ahead) in the frame `map`."""

    rotation: np.ndarray  # 3×3, map_from_camera
    position: np.ndarray  # 3 [m]

    def to_camera(self, points_in_map):
        """@param points_in_map  N×3 [m]. @return the same points in the camera's frame."""
        return (points_in_map - self.position) @ self.rotation


@dataclasses.dataclass(frozen=True)
class Boxes:
    """What moves, or may, predicted into the newest frame: row i of each array is object i of N."""

    ids: np.ndarray  # N
    labels: tuple  # N str
    minimums: np.ndarray  # N×3 [m], frame `map`
    maximums: np.ndarray  # N×3 [m]
    velocities: np.ndarray  # N×3 [m/s]

    def corners_of(self, label):
        """8K×3 [m], frame `map`: of the K boxes with this label."""
        chosen = [i for i, name in enumerate(self.labels) if name == label]
        bits = np.unpackbits(np.arange(8, dtype=np.uint8)[:, None], axis=1, bitorder="little")[:, :3]
        low, high = self.minimums[chosen, None], self.maximums[chosen, None]
        return np.where(bits == 0, low, high).reshape(-1, 3)


@dataclasses.dataclass(frozen=True)
class Robot:
    """As of the newest frame."""

    pose: Pose | None = None  # None while the camera is lost
    boxes: Boxes | None = None  # None before the first


def pose_of(state):
    """@param state  TrackingState. @return Pose; None while the camera is lost. @raises MalformedMessage"""
    if state.state not in (TRACKING, WEAK, RELOCALISED):
        return None
    at, turned = state.map_from_camera.position, state.map_from_camera.orientation
    x, y, z, w = quaternion = np.array([turned.x, turned.y, turned.z, turned.w])
    position = np.array([at.x, at.y, at.z])
    if not (np.isfinite(position).all() and abs(quaternion @ quaternion - 1) < 1e-3):
        raise MalformedMessage("a pose whose quaternion has not the length 1, or that is not finite")
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return Pose(rotation, position)


def boxes_of(predicted):
    """@param predicted  PredictedBoxes. @return Boxes @raises MalformedMessage"""
    count = predicted.ids.size
    arrays = predicted.minimums, predicted.maximums, predicted.velocities
    if len(predicted.labels) != count or any(array.size != 3 * count for array in arrays):
        raise MalformedMessage(f"arrays that do not fit {count} objects")
    if not all(np.isfinite(array).all() for array in arrays):
        raise MalformedMessage("a box that is not finite")
    return Boxes(predicted.ids, tuple(predicted.labels), *(array.reshape(-1, 3) for array in arrays))
