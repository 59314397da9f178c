# SPDX-License-Identifier: Apache-2.0
"""Where rds_map is, and messages to feed it with. Leaves with 77 where there is no cyclonedds."""

import pathlib
import struct
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "docs/examples/python")]
try:
    import cyclonedds.idl  # noqa: F401
except ImportError:
    print("no Python package cyclonedds (set RDS_PYTHON)")
    sys.exit(77)

from rds_map import messages  # noqa: E402
from rds_map.cdr import decode  # noqa: E402

HEADER = messages.Header(messages.Time(10, 500), "map")
NO_BOUNDS = [0.0, 0.0, 0.0]


def node(log_odds, color, children=0):
    return struct.pack("<f4B", log_odds, *color, children)


def path_to(key, leaf_depth=16):
    """The inner nodes above one voxel, in the order of the payload."""
    nodes = b""
    for level in range(leaf_depth):
        bit = 15 - level
        octant = sum((key[axis] >> bit & 1) << axis for axis in range(3))
        nodes += node(0.0, (0, 0, 0), 1 << octant)
    return nodes


def through_the_wire(message):
    """As it is decoded from what cyclonedds itself writes."""
    return decode(type(message), message.serialize(use_version_2=False))


def delta(base, revision, voxels=(), deleted=(), map_id=7, **changes):
    """@param voxels  (key, log-odds, label, color) each."""
    fields = {"header": HEADER, "instance": 1, "map_epoch": 3, "map_id": map_id, "base_revision": base, "revision": revision,
              "keyframe_id": 0, "resolution": 0.05,
              "keys": [value for key, *_ in voxels for value in key],
              "log_odds": [log_odds for _, log_odds, _, _ in voxels],
              "labels": [label for _, _, label, _ in voxels],
              "colors": [value for *_, color in voxels for value in color],
              "deleted_keys": [value for key in deleted for value in key]}
    return through_the_wire(messages.OctreeDelta(**(fields | changes)))


def full(payload, sec=10, **changes):
    fields = {"header": messages.Header(messages.Time(sec, 500), "map"), "binary": False, "id": "ColorOcTree", "resolution": 0.05,
              "data": [byte - 256 if byte > 127 else byte for byte in payload]}
    return through_the_wire(messages.Octomap(**(fields | changes)))


def info(revision, nodes, sec=10, map_id=7, **changes):
    fields = {"header": messages.Header(messages.Time(sec, 500), "map"), "instance": 1, "describes_full": True, "map_epoch": 3,
              "map_id": map_id, "revision": revision, "resolution": 0.05, "node_count": nodes, "occupied_count": 0,
              "bounds_min": NO_BOUNDS, "bounds_max": NO_BOUNDS, "labels": ["", "chair", "cup"], "label_keys": [],
              "label_values": [], "keyframes_integrated": 1, "last_keyframe_id": 0, "keyframes_waiting": 0}
    return through_the_wire(messages.MapInfo(**(fields | changes)))
