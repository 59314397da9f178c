# SPDX-License-Identifier: Apache-2.0
"""Programs on Zenoh that are not ours hear us, see us, and we hear them: PyPI's zenoh-ros2-sdk, and pamoja-ros2 as judge of names.

    zenoh_client_test.py PATH_OF_external_client_source PATH_OF_bus_peer PYTHON

PYTHON has the packages of zenoh_requirements.txt.
"""

import functools
import itertools
import json
import os
import pathlib
import subprocess
import sys
import unittest

import peer_process

PYTHON = sys.argv.pop(3)
PEER = sys.argv.pop(2)
SOURCE = sys.argv.pop(1)
FOLDER = pathlib.Path(__file__).resolve().parent
DOMAINS = itertools.count(10 + os.getpid() % 180)

Peer = functools.partial(peer_process.Peer, PEER)
Stranger = functools.partial(peer_process.Peer, PYTHON, "-B", FOLDER / "zenoh_stranger.py")


def can_import(*modules):
    command = [PYTHON, "-c", "import " + ", ".join(modules)]
    return os.path.exists(PYTHON) and subprocess.run(command, capture_output=True, check=False).returncode == 0


class Strangers(unittest.TestCase):
    def setUp(self):
        self.domain = next(DOMAINS)

    def check_numbers(self, peer, numbers_of=int):
        """The first five that it says follow each other."""
        self.assertTrue(peer.wait_for(lambda lines: len(lines) >= 5), peer.lines)
        numbers = [numbers_of(line) for line in peer.lines[:5]]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + 5)))

    def test_the_sdk_hears_our_pictures(self):
        with Stranger("listen", "picture", self.domain, 30) as stranger, Peer("writer", "zenoh", self.domain, 1, 10):
            self.check_numbers(stranger, lambda line: int(line.removesuffix(" 1500000")))
            stranger.process.terminate()

    def test_we_hear_the_sdk_s_pictures(self):
        with Peer("reader", "zenoh", self.domain) as reader, Stranger("talk", "picture", self.domain, 30) as stranger:
            self.check_numbers(reader)
            stranger.process.terminate()

    def test_the_sdk_hears_our_text_from_the_last_one_on(self):
        with Peer("teller", "zenoh", self.domain, 3) as teller:
            teller.tell("0123")
            with Stranger("listen", "number", self.domain, 30) as stranger:
                self.assertTrue(stranger.wait_for(lambda lines: len(lines) >= 1))
                teller.tell("4567")
                self.check_numbers(stranger)
                self.assertEqual(stranger.lines[0], "3")  # it asks for more, but has its Zenoh keep the newest answer alone
                stranger.process.terminate()

    def test_we_hear_the_sdk_s_text(self):
        with Peer("late", "zenoh", self.domain) as reader, Stranger("talk", "number", self.domain, 30) as stranger:
            self.check_numbers(reader)
            stranger.process.terminate()

    def test_the_sdk_calls_a_service(self):
        with Peer("server", "zenoh", self.domain), Stranger("call", "switch", self.domain, 30) as stranger:
            self.assertTrue(stranger.wait_for(lambda lines: len(lines) >= 2))
            self.assertEqual(stranger.lines[:2], ["(True, 'on')", "(False, 'off')"])


class Judges(unittest.TestCase):
    """What others see of our programs, and whether they would have named all of it alike."""

    @classmethod
    def setUpClass(cls):
        cls.domain = next(DOMAINS)
        with Peer("server", "zenoh", cls.domain), Peer("talker", "zenoh", cls.domain), Peer("teller", "zenoh", cls.domain, 3), \
             peer_process.Peer(SOURCE, "zenoh", cls.domain, 60) as source, Stranger("look", "all", cls.domain, 2) as stranger:
            assert stranger.wait_for(lambda lines: len(lines) == 1), "the stranger saw nothing"
            cls.seen = json.loads(stranger.lines[0])
            source.process.terminate()

    def test_the_sdk_sees_topics_and_services(self):
        kinds = {name: topic["kinds"] for name, topic in self.seen["topics"].items() if not name.startswith("/rosout")}
        self.assertEqual(kinds, {"/number": ["std_msgs/msg/String"], "/picture": ["sensor_msgs/msg/Image"], "/tf": ["tf2_msgs/msg/TFMessage"],
                                 "/rds/boxes": ["vision_msgs/msg/Detection3DArray"], "/rds/map/full": ["octomap_msgs/msg/Octomap"],
                                 "/rds/odometry": ["nav_msgs/msg/Odometry"]})
        self.assertEqual(self.seen["services"]["/switch"], ["std_srvs/srv/SetBool"])

    def test_the_sdk_sees_whose_they_are_and_their_qos(self):
        for name, node, qos in (("/number", "bus_peer", ["RELIABLE", "TRANSIENT_LOCAL", "KEEP_LAST", 3]),
                                ("/rds/odometry", "external_client_source", ["RELIABLE", "VOLATILE", "KEEP_LAST", 10])):
            topic = self.seen["topics"][name]
            self.assertEqual((topic["node_name"], topic["node_namespace"], topic["qos"]), (node, "/", qos))

    def test_the_sdk_computes_the_same_type_hashes(self):
        for name, kind in (("/number", "std_msgs/msg/String"), ("/picture", "sensor_msgs/msg/Image")):
            self.assertEqual(self.seen["topics"][name]["type_hash"], self.seen["hashes"][kind])

    def test_pamoja_makes_the_same_keys(self):
        live = {topic["pamoja"]["key"] for name, topic in self.seen["topics"].items() if name in ("/picture", "/tf", "/rds/boxes", "/rds/odometry")}
        self.assertEqual(len(live), 4)
        self.assertLessEqual(live, set(self.seen["heard"]))

    def test_pamoja_makes_the_same_parts_of_tokens(self):
        for name, topic in self.seen["topics"].items():
            self.assertEqual("RIHS01_" + topic["pamoja"]["digest"], topic["type_hash"], name)
            part = f"/{topic['node_name']}/{topic['pamoja']['in_token']}/{topic['type_hash']}/"
            self.assertEqual(sum(part in token for token in self.seen["tokens"]), 1, name)


if __name__ == "__main__":
    if not can_import("zenoh_ros2_sdk", "pamoja.ros2"):
        print("no Python packages of zenoh_requirements.txt (tools/setup.sh --ros)")
        sys.exit(77)
    unittest.main()
