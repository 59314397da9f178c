# SPDX-License-Identifier: Apache-2.0
"""The map and the robot as they are now. Nothing runs in the background: messages are taken while you wait for them."""

import collections
import dataclasses
import time

from cyclonedds.util import duration

from rds_map.bus import Bus
from rds_map.cdr import MalformedMessage, decode
from rds_map.follower import Follower
from rds_map.messages import MapInfo, Octomap, OctreeDelta, PredictedBoxes, TrackingState
from rds_map.robot import Robot, boxes_of, pose_of


class _Live:
    def __init__(self, bus, readers):
        self._bus = bus  # its entities live as long as it
        self._readers = readers  # and what takes their messages
        self._waits = bus.wait_set(readers)

    def _take_all(self):
        """What waits. @return whether something has changed."""
        changed = False
        for reader, take in self._readers.items():
            for data in reader.take():
                changed |= self._take(reader, take, data)
        return changed

    def _take(self, reader, take, data):
        try:
            return take(decode(reader.message, data))
        except MalformedMessage as fault:
            self._reject(reader.name, fault)
            return False

    def _wait(self, timeout_s):
        """Until something changes. @return whether it did in time."""
        deadline = time.monotonic() + timeout_s
        while not self._take_all():
            left = deadline - time.monotonic()
            if left <= 0:
                return False
            self._waits.wait(duration(nanoseconds=int(left * 1e9)))
        return True


class LiveMap(_Live):
    """The map of one mapper. Iterate over it to have each newer revision; who is slow has the newest alone."""

    def __init__(self, bus=None):
        bus = bus or Bus()
        self._follower = Follower()
        super().__init__(bus, {
            bus.reader("rds/map/info", MapInfo, 100, latched=True): self._follower.take_info,
            bus.reader("rds/map/full", Octomap, 1, latched=True): self._follower.take_full,
            bus.reader("rds/map/delta", OctreeDelta, 64): self._follower.take_delta,
        })

    @property
    def rejected(self):
        """Malformed messages that were dropped, by topic."""
        return self._follower.rejected

    @property
    def last_fault(self):
        return self._follower.last_fault

    def wait(self, timeout_s=10.0):
        """@return Voxels that are newer than the last; None if there were none in time."""
        return self._follower.voxels if self._wait(timeout_s) else None

    def now(self):
        """@return the newest Voxels; None before the first map."""
        self._take_all()
        return self._follower.voxels

    def __iter__(self):
        while True:
            voxels = self.wait(3600)
            if voxels is not None:
                yield voxels

    def _reject(self, topic, fault):
        self._follower.reject(topic, fault)


class LiveRobot(_Live):
    """Pose of the camera, and what moves, as of the newest frame."""

    def __init__(self, bus=None):
        bus = bus or Bus()
        self._robot = Robot()
        self.rejected = collections.Counter()  # malformed messages that were dropped, by topic
        self.last_fault = ""
        super().__init__(bus, {
            bus.reader("rds/predicted_boxes", PredictedBoxes, 10): self._take_boxes,
            bus.reader("rds/tracking_state", TrackingState, 10): self._take_state,
        })

    def wait(self, timeout_s=10.0):
        """@return Robot as of a newer frame; None if there was none in time."""
        return self._robot if self._wait(timeout_s) else None

    def now(self):
        """@return Robot"""
        self._take_all()
        return self._robot

    def _take_boxes(self, predicted):
        self._robot = dataclasses.replace(self._robot, boxes=boxes_of(predicted))
        return True

    def _take_state(self, state):
        self._robot = dataclasses.replace(self._robot, pose=pose_of(state))
        return True

    def _reject(self, topic, fault):
        self.rejected[topic] += 1
        self.last_fault = f"{topic}: {fault}"
