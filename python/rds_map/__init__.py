# SPDX-License-Identifier: Apache-2.0
"""The live map of RDS-SLAM as NumPy arrays, by plain DDS."""

from rds_map.bus import Bus
from rds_map.live import LiveMap, LiveRobot
from rds_map.robot import Boxes, Pose, Robot
from rds_map.voxels import Voxels

__all__ = ["Boxes", "Bus", "LiveMap", "LiveRobot", "Pose", "Robot", "Voxels"]
