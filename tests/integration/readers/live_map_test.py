# SPDX-License-Identifier: Apache-2.0
"""rds_map beside `rds run`: its arrays are the map that the run leaves, value by value, from the start and for who comes late.

    live_map_test.py BUILD RECORDING

Needs PyPI's cyclonedds; without it, exit status 77.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

RECORDING, BUILD = pathlib.Path(sys.argv.pop(2)), pathlib.Path(sys.argv.pop(1))
ROOT = pathlib.Path(__file__).resolve().parents[3]
RDS = BUILD / "bin/rds"
DOMAIN = 24 + os.getpid() % 8  # below those that rds run takes
EXAMPLES = {"near.py": [sys.executable, "-B", ROOT / "docs/examples/python/near.py", "--domain", str(DOMAIN), "--loopback"],
            "stop.py": [sys.executable, "-B", ROOT / "docs/examples/python/stop.py", "--domain", str(DOMAIN), "--loopback"],
            "near.cpp": [BUILD / "examples/example_near", "--loopback"],
            "stop.cpp": [BUILD / "examples/example_stop", "--loopback"]}

sys.path.insert(0, str(ROOT / "python"))
try:
    import rds_map
except ImportError:
    print("no Python package cyclonedds (set RDS_PYTHON)")
    sys.exit(77)
from rds_map.payload import voxels_of  # noqa: E402


def rds(*arguments):
    return subprocess.run([RDS, *arguments], check=True, capture_output=True, text=True).stdout


def told_by(text):
    """`name  value` lines as a dictionary."""
    return dict(line.split(None, 1) for line in text.splitlines())


class Follow:
    """A run with two readers, one from the start and one from its middle on, and the examples beside it."""

    def __init__(self, out, vendor):
        self.out = pathlib.Path(out)
        environment = os.environ | {"ROS_DOMAIN_ID": str(DOMAIN), "PYTHONPATH": str(ROOT / "python")}
        bus = rds_map.Bus(DOMAIN, loopback=True)
        self.early, self.late = rds_map.LiveMap(bus), None
        self.robot = rds_map.LiveRobot(bus)
        self.poses = 0
        self.examples = {name: subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
                         for name, command in EXAMPLES.items()}
        run = subprocess.Popen([RDS, "run", RECORDING, "--out", out, "--domain", str(DOMAIN), "--bus", vendor, "--frames", "100"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while run.poll() is None:
            self.look(bus)
        time.sleep(0.2)
        self.look(bus)
        self.status, self.said = run.returncode, run.communicate()[1]
        for example in self.examples.values():
            example.kill()
        self.examples = {name: example.communicate()[0].splitlines() for name, example in self.examples.items()}

    def look(self, bus):
        voxels = self.early.wait(0.1) or self.early.now()
        if self.late is None and voxels is not None and voxels.revision >= 4:
            self.late = rds_map.LiveMap(bus)
        if self.late is not None:
            self.late.now()
        self.poses += self.robot.now().pose is not None


class LiveMapTest(unittest.TestCase):
    def follow(self, vendor):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        followed = Follow(place.name + "/out", vendor)
        self.assertEqual(followed.status, 0, followed.said)
        self.assertGreater(followed.poses, 0)
        return followed

    def check_is_the_tree(self, voxels, tree_file):
        header, payload = tree_file.read_bytes().split(b"\ndata\n", 1)
        keys, values = voxels_of(payload)
        order = np.lexsort(keys.T[::-1])
        self.assertEqual(float(re.search(rb"res (\S+)", header)[1]), voxels.resolution)
        np.testing.assert_array_equal(voxels.keys, keys[order])
        np.testing.assert_array_equal(voxels.log_odds, values["log_odds"][order])
        np.testing.assert_array_equal(voxels.colors, values["color"][order])

    def check_is_what_our_tools_say(self, voxels, out):
        said = told_by(rds("map", "info", "--map", out))
        occupied = voxels.centers[voxels.occupied]
        self.assertEqual(int(said["occupied_voxels"]), len(occupied))
        self.assertEqual(int(said["free_voxels"]), np.count_nonzero(~voxels.occupied))
        rds("map", "export", "--map", out, out / "map.ply")
        points = np.frombuffer((out / "map.ply").read_bytes().split(b"end_header\n", 1)[1], [("at", "<f4", 3), ("rgb", "u1", 3)])
        np.testing.assert_array_equal(np.sort(points["at"], axis=0), np.sort(occupied.astype(np.float32), axis=0))
        np.testing.assert_array_equal(points["rgb"].sum(axis=0), voxels.colors[voxels.occupied].sum(axis=0, dtype=np.uint64))

    def check_examples(self, said):
        for name in ("near.py", "near.cpp"):
            self.assertRegex(said[name][-1], r"^revision \d+: \d+ voxels within 2 m", name)
        for name in ("stop.py", "stop.cpp"):
            self.assertEqual(set(said[name]), {"stop", "go"}, name)  # stop before the first frame and after the last

    def check(self, vendor):
        followed = self.follow(vendor)
        early, late = followed.early.now(), followed.late.now()
        self.assertFalse(followed.early.rejected + followed.late.rejected, followed.early.last_fault + followed.late.last_fault)
        self.assertGreater(len(early), 10000)
        self.check_is_the_tree(early, followed.out / "map.ot")
        self.check_is_what_our_tools_say(early, followed.out)
        for name in ("revision", "map_id", "label_names"):
            self.assertEqual(getattr(late, name), getattr(early, name))
        for name in ("keys", "log_odds", "colors", "labels"):  # labels: told by deltas, or by a full map's colours
            np.testing.assert_array_equal(getattr(late, name), getattr(early, name), name)
        self.assertGreater(np.count_nonzero(early.labels), 0)
        self.check_examples(followed.examples)

    def test_follows_fast_dds(self):
        self.check("fastdds")

    def test_follows_cyclone_dds(self):
        self.check("cyclonedds")


if __name__ == "__main__":
    unittest.main()
