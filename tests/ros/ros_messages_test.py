# SPDX-License-Identifier: Apache-2.0
"""Our own messages as a ROS 2 workspace has them: ros_messages_test.py FOLDER_OF_PROGRAMS RECORDING

Types of Python and of C++ are made of the .msg and .srv files by the generators of Jazzy and of Kilted; a node of rclpy reads with them what the five services write
on each vendor, commands the tracker, and has the map saved and loaded. Needs .venv-jazzy and .venv-kilted (tools/setup.sh --ros); skips without.
"""

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path.insert(0, str(FOLDER.parent / "integration" / "bus"))
from peer_process import VENDORS, Peer  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1))
RECORDING = sys.argv.pop(1)
MAP = "kitchen"
SERVICES = ("tracker", "detector", "transformer", "mapper", "loop-closer")
MESSAGES = ROOT / "idl" / "rds_msgs"
FLOWING = {"Command", "CommandResult", "FrameFeatures", "KeyFrameFeatures", "KeyFrameImages", "KeyFramePoses", "MapInfo", "OctreeDelta", "PredictedBoxes",
           "ServiceStatus", "TrackingState", "TransferOffer"}


class RosMessages:
    """Of one ROS 2, DISTRIBUTION."""

    @classmethod
    def setUpClass(cls):
        cls.python = ROOT / f".venv-{cls.DISTRIBUTION}" / "bin" / "python"
        if not cls.python.exists():
            raise unittest.SkipTest(f"no .venv-{cls.DISTRIBUTION} (tools/setup.sh --ros)")
        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.package = pathlib.Path(cls.place.name) / "package"
        subprocess.run([cls.python, "-B", FOLDER / "rds_msgs_package.py", MESSAGES, cls.package], check=True, stdout=subprocess.DEVNULL,
                       env=os.environ | {"PYTHONHASHSEED": "0"})  # generators include in the order of a set: the same for ccache
        cls.hashes = {file.stem: json.loads(file.read_text())["type_hashes"][0]["hash_string"] for file in cls.package.glob("idl/rds_msgs/msg/*.json")}

    def start(self, processes, program, *arguments):
        peer = processes.enter_context(Peer(PROGRAMS / program, *arguments, environment={**os.environ, "RDS_MAPS_DIR": self.place.name}))
        processes.callback(lambda: peer.lives() and peer.send(signal.SIGTERM))

    def environment(self, **more):
        return {"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/"), "LD_LIBRARY_PATH": f"{self.package}:{self.python.parents[1] / 'lib'}", **more}

    def read_beside_services(self, bus, domain, *saved_map):
        with contextlib.ExitStack() as processes:
            for service in SERVICES:
                self.start(processes, f"rds-{service}", *bus)
            self.start(processes, "rds", "play", RECORDING, "--loop", *bus)
            read = subprocess.run([self.python, "-B", FOLDER / "ros_messages.py", self.package, str(len(FLOWING)), *saved_map],
                                  env=self.environment(ROS_DOMAIN_ID=domain), check=True, stdout=subprocess.PIPE, text=True)
        return json.loads(read.stdout)

    def check_saved_map(self, told):
        folder = pathlib.Path(self.place.name) / MAP
        self.assertEqual(told["save"], [True, f"saved as {MAP} in {folder}"])
        self.assertTrue((folder / "map.rds").exists())
        self.assertTrue(told["load"][0], told["load"])
        for service in ("rds-tracker", "rds-mapper", "rds-loop-closer"):
            self.assertIn(f"{service}: ", told["load"][1])
        self.assertFalse(told["load_another"][0])
        self.assertIn(f"{MAP}_2", told["load_another"][1])

    def check(self, vendor, domain):
        is_asked = vendor == "fastdds"  # there is no wheel of rmw_cyclonedds: node_services_test asks in its form
        told = self.read_beside_services(("--bus", vendor, "--domain", domain), domain, *([MAP] if is_asked else []))
        self.assertEqual(told["answers"], [[25, "rds-tracker", True]])
        self.assertLessEqual(FLOWING, set(told["hashes"]))
        self.assertEqual({name: [self.hashes[name]] for name in told["hashes"]}, told["hashes"])
        compared = subprocess.run([self.package / "ros_messages", self.package / "wire"], env=self.environment(), check=True, capture_output=True, text=True)
        self.assertEqual(dict(line.split() for line in compared.stdout.splitlines()), {f"{name}{of}": "1" for name in FLOWING for of in ("", ".python")})
        if is_asked:
            self.check_saved_map(told)

    def test_are_the_same_on_the_wire(self):
        for i, vendor in enumerate(VENDORS):
            with self.subTest(vendor):
                self.check(vendor, str(60 + 20 * i + os.getpid() % 20))

    def test_all_are_made(self):
        self.assertEqual(set(self.hashes), {file.stem for file in MESSAGES.glob("msg/*.msg")})
        parts = ("", "_Request", "_Response", "_Event")
        self.assertEqual({file.stem for file in self.package.glob("idl/rds_msgs/srv/*.json")}, {file.stem + part for file in MESSAGES.glob("srv/*.srv") for part in parts})


class OfJazzy(RosMessages, unittest.TestCase):
    DISTRIBUTION = "jazzy"


class OfKilted(RosMessages, unittest.TestCase):
    DISTRIBUTION = "kilted"


if __name__ == "__main__":
    unittest.main()
