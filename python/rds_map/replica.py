# SPDX-License-Identifier: Apache-2.0
"""A reader's copy of the map: full map plus deltas give the mapper's voxels, value by value. Knows no bus."""

import dataclasses
import enum

import numpy as np

from rds_map import labels as label_colors
from rds_map.cdr import MalformedMessage
from rds_map.payload import voxels_of
from rds_map.voxels import Voxels

MOST_LOG_ODDS = 100
SAME_RESOLUTION_M = 1e-9


class Answer(enum.Enum):
    APPLIED = enum.auto()
    OLD = enum.auto()  # the copy is there already, or beyond
    GAP = enum.auto()  # a delta was missed: the next full map closes it
    OTHER_MAP = enum.auto()  # of an earlier epoch, or of a mapper that began anew: its full map is needed


def _codes(keys):
    return keys.astype(np.uint64) @ np.array([1 << 32, 1 << 16, 1], np.uint64)


def _rows(array, name, columns, rows=None):
    if array.size % columns != 0 or (rows is not None and array.size != columns * rows):
        raise MalformedMessage(f"{array.size} values in {name}, expected {columns} a voxel" +
                               ("" if rows is None else f" of {rows}"))
    return array.reshape(-1, columns)


def _checked_resolution(resolution):
    if not 1e-4 < resolution < 1e3:
        raise MalformedMessage(f"a resolution of {resolution} m")
    return resolution


def _locate(codes, wanted):
    """Where each wanted code is among ascending ones, and whether it is there."""
    place = np.searchsorted(codes, wanted)
    there = np.zeros(len(wanted), bool)
    inside = place < len(codes)
    there[inside] = codes[place[inside]] == wanted[inside]
    return place, there


def _ordered(voxels):
    """By key; of a voxel that is there twice the last is meant."""
    codes = _codes(voxels.keys)
    _, last = np.unique(codes[::-1], return_index=True)
    chosen = len(codes) - 1 - last
    return _with(voxels, *(getattr(voxels, name)[chosen] for name in _COLUMNS))


_COLUMNS = ("keys", "log_odds", "colors", "labels")


def _with(voxels, *columns):
    for column in columns:
        column.flags.writeable = False
    return dataclasses.replace(voxels, **dict(zip(_COLUMNS, columns)))


class Replica:
    """Holds the newest voxels; an update that is refused changes nothing."""

    def __init__(self):
        self.voxels = None  # until the first full map, or the delta that begins a map

    def _is_of(self, update):
        return self.voxels is not None and (update.map_epoch, update.map_id) == (self.voxels.map_epoch, self.voxels.map_id)

    def _check_resolution(self, resolution):
        if abs(resolution - self.voxels.resolution) > SAME_RESOLUTION_M:
            raise MalformedMessage(f"voxels of {resolution} m in a map of {self.voxels.resolution} m")

    def apply_full(self, full, info):
        """@param full  Octomap. @param info  the MapInfo that describes it. @return Answer @raises MalformedMessage"""
        if full.binary or full.id != "ColorOcTree":
            raise MalformedMessage(f"a tree of type '{full.id}', binary = {full.binary}: expected a full ColorOcTree")
        label_keys = _rows(info.label_keys, "label_keys", 3, info.label_values.size)
        _checked_resolution(full.resolution)
        if self._is_of(info):
            self._check_resolution(full.resolution)
            if info.revision <= self.voxels.revision:
                return Answer.OLD
        keys, values = voxels_of(full.data.tobytes())
        labels = label_colors.labels_of_colors(values["color"], info.labels)
        labels[values["log_odds"] < 0] = 0
        voxels = _ordered(Voxels(full.resolution, info.map_epoch, info.map_id, info.revision, keys,
                                 values["log_odds"].astype(np.float32), values["color"], labels, tuple(info.labels) or ("",)))
        place, there = _locate(_codes(voxels.keys), _codes(label_keys))
        labels = voxels.labels.copy()
        labels[place[there]] = info.label_values[there]
        self.voxels = _with(voxels, voxels.keys, voxels.log_odds, voxels.colors, labels)
        return Answer.APPLIED

    def apply_delta(self, delta):
        """@param delta  OctreeDelta. @return Answer @raises MalformedMessage"""
        changed = self._checked(delta)
        deleted = _codes(_rows(delta.deleted_keys, "deleted_keys", 3))
        if self._is_of(delta):
            self._check_resolution(delta.resolution)
            if delta.revision <= self.voxels.revision:
                return Answer.OLD
            if delta.base_revision != self.voxels.revision:
                return Answer.GAP
            before = self.voxels
        elif delta.base_revision == 0:  # the first of its map
            before = _with(changed, *(getattr(changed, name)[:0] for name in _COLUMNS))
        else:
            return Answer.GAP if self.voxels is None else Answer.OTHER_MAP
        self.voxels = dataclasses.replace(_merged(before, changed, deleted), revision=delta.revision)
        return Answer.APPLIED

    def tell_labels(self, map_id, labels):
        """The label table as it is told beside the deltas; another map's is left. @return whether it is another one now."""
        if self.voxels is None or self.voxels.map_id != map_id or tuple(labels) in ((), self.voxels.label_names):
            return False
        self.voxels = dataclasses.replace(self.voxels, label_names=tuple(labels))
        return True

    def _checked(self, delta):
        count = delta.log_odds.size
        if not (np.abs(delta.log_odds) <= MOST_LOG_ODDS).all():
            raise MalformedMessage("log-odds that are not finite or too large")
        if delta.revision <= delta.base_revision:
            raise MalformedMessage(f"revision {delta.revision} after {delta.base_revision}")
        return _ordered(Voxels(_checked_resolution(delta.resolution), delta.map_epoch, delta.map_id, delta.revision,
                               _rows(delta.keys, "keys", 3, count), delta.log_odds,
                               _rows(delta.colors, "colors", 3, count), _rows(delta.labels, "labels", 1, count)[:, 0]))


def _merged(before, changed, deleted):
    """`before` with the values of `changed`, without the deleted ones."""
    codes = _codes(before.keys)
    place, there = _locate(codes, _codes(changed.keys))
    kept = np.ones(len(codes) + np.count_nonzero(~there), bool)
    columns = []
    for name in _COLUMNS:
        old, new = getattr(before, name).copy(), getattr(changed, name)
        old[place[there]] = new[there]
        columns.append(np.insert(old, place[~there], new[~there], axis=0))
    place, there = _locate(_codes(columns[0]), deleted)
    kept[place[there]] = False
    return _with(before, *(column[kept] for column in columns))
