# SPDX-License-Identifier: Apache-2.0
"""Makes a Replica follow the topics of one mapper, as services/mapper/reader/topic_updates.cpp does. Knows no bus."""

import collections

from rds_map.cdr import MalformedMessage
from rds_map.payload import NODE
from rds_map.replica import Answer, Replica

MOST_WAITING = 256  # deltas; and descriptions of full maps


def stamp_ns(header):
    return header.stamp.sec * 1_000_000_000 + header.stamp.nanosec


class Follower:
    """Deltas that come before what they build on wait for it; a gap is closed by the next full map.

    take_*() say whether the voxels have changed. What is malformed is dropped: `rejected` counts it by topic,
    `last_fault` says what was wrong.
    """

    def __init__(self):
        self.replica = Replica()
        self.rejected = collections.Counter()
        self.last_fault = ""
        self._full = None  # that has not been applied
        self._infos = {}  # of full maps, by stamp
        self._waiting = {}  # deltas, by map id and base revision

    @property
    def voxels(self):
        return self.replica.voxels

    def reject(self, topic, fault):
        self.rejected[topic] += 1
        self.last_fault = f"{topic}: {fault}"

    def take_full(self, full):
        self._full = full
        return self._apply_full()

    def take_info(self, info):
        # Another mapper may give the stamp of an earlier one's map again: what is told of that one is over.
        self._infos = {stamp: told for stamp, told in self._infos.items() if told.map_id == info.map_id}
        changed = self.replica.tell_labels(info.map_id, info.labels)
        if info.describes_full:
            self._infos[stamp_ns(info.header)] = info
            _bound(self._infos)
            changed |= self._apply_full()
        return changed

    def take_delta(self, delta):
        if delta.base_revision == 0:  # the first of a map needs nothing before it
            changed = self._try("rds/map/delta", self.replica.apply_delta, delta)
        else:
            self._waiting[delta.map_id, delta.base_revision] = delta
            _bound(self._waiting)
            changed = False
        return self._apply_waiting() or changed

    def _apply_full(self):
        info = self._full and self._infos.get(stamp_ns(self._full.header))
        if not info or info.node_count * NODE.itemsize != self._full.data.size:
            return False
        del self._infos[stamp_ns(self._full.header)]
        full, self._full = self._full, None
        changed = self._try("rds/map/full", self.replica.apply_full, full, info)
        return self._apply_waiting() or changed

    def _apply_waiting(self):
        changed = False
        while self.voxels is not None:
            delta = self._waiting.pop((self.voxels.map_id, self.voxels.revision), None)
            if delta is None or not self._try("rds/map/delta", self.replica.apply_delta, delta):
                break
            changed = True
        return changed

    def _try(self, topic, apply, *message):
        try:
            return apply(*message) is Answer.APPLIED
        except MalformedMessage as fault:
            self.reject(topic, fault)
            return False


def _bound(waiting):
    """The lowest go first, which are the oldest."""
    while len(waiting) > MOST_WAITING:
        del waiting[min(waiting)]
