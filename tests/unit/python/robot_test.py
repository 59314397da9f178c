# SPDX-License-Identifier: Apache-2.0
"""Poses and boxes of the tracker's messages, and what the example stop.py makes of them."""

import unittest

import numpy as np
import tree  # first: it says where the others are

import stop  # noqa: I001
from rds_map import Robot, messages
from rds_map.cdr import MalformedMessage
from rds_map.robot import TRACKING, boxes_of, pose_of

HALF = np.sqrt(0.5)


def state(quaternion=(0.0, HALF, 0.0, HALF), position=(1.0, 0.0, 2.0), value=TRACKING):
    """A camera that looks along x of the map, if nothing else is said."""
    pose = messages.Pose(messages.Point(*position), messages.Quaternion(*quaternion))
    return tree.through_the_wire(messages.TrackingState(tree.HEADER, 1, 1, 0, value, 0, 0, 0, False, 0, 0, pose, pose, 0, 0, 0, 0, 0, 0))


def boxes(low, high, label="person", **changes):
    fields = {"header": tree.HEADER, "instance": 1, "map_epoch": 1, "frame_index": 0, "ids": [4], "labels": [label], "scores": [1.0],
              "boxes": [0.0] * 4, "minimums": list(low), "maximums": list(high), "velocities": [0.0] * 3,
              "covariance_traces": [0.0], "ages": [0.0]}
    return tree.through_the_wire(messages.PredictedBoxes(**(fields | changes)))


class RobotTest(unittest.TestCase):
    def test_a_pose_turns_points_into_the_cameras_frame(self):
        pose = pose_of(state())
        np.testing.assert_allclose(pose.to_camera(np.array([[3.0, 0.5, 2.0]])), [[0, 0.5, 2]], atol=1e-12)

    def test_a_lost_camera_has_no_pose(self):
        self.assertIsNone(pose_of(state(value=3)))

    def test_refuses_a_pose_that_is_none(self):
        for spoiled in [{"quaternion": (0.0, 0.0, 0.0, 0.0)}, {"position": (np.nan, 0.0, 0.0)}]:
            with self.assertRaises(MalformedMessage):
                pose_of(state(**spoiled))

    def test_refuses_boxes_that_do_not_fit(self):
        for spoiled in [{"labels": []}, {"minimums": [1.0]}, {"maximums": [np.inf] * 3}, {"ids": [1, 2]}]:
            with self.assertRaises(MalformedMessage):
                boxes_of(boxes((0, 0, 0), (1, 1, 1), **spoiled))

    def test_stops_for_a_person_ahead_and_near_alone(self):
        camera = pose_of(state())  # at x = 1, z = 2 of the map
        for low, high, label, must_stop in [((1.8, -1.0, 1.7), (2.3, 0.8, 2.2), "person", True),
                                            ((1.8, -1.0, 1.7), (2.3, 0.8, 2.2), "chair", False),
                                            ((2.1, -1.0, 1.7), (2.6, 0.8, 2.2), "person", False),  # 1.1 m ahead
                                            ((1.5, -1.0, 2.5), (2.0, 0.8, 3.0), "person", False),  # beside
                                            ((0.1, -1.0, 1.7), (0.6, 0.8, 2.2), "person", False)]:  # behind
            robot = Robot(camera, boxes_of(boxes(low, high, label)))
            self.assertEqual(stop.must_stop(robot), must_stop, (low, label))

    def test_stops_where_nobody_can_tell(self):
        people = boxes_of(boxes((5, 0, 0), (6, 1, 1)))
        self.assertTrue(stop.must_stop(None))
        self.assertTrue(stop.must_stop(Robot(None, people)))
        self.assertTrue(stop.must_stop(Robot(pose_of(state()), None)))
        self.assertFalse(stop.must_stop(Robot(pose_of(state()), people)))


if __name__ == "__main__":
    unittest.main()
