# SPDX-License-Identifier: Apache-2.0
"""Programs on Zenoh that are not ours hear us, and we hear them.

    zenoh_client_test.py PATH_OF_external_client_source PATH_OF_bus_peer PYTHON

PYTHON has the packages of zenoh_requirements.txt; skips without.
"""

import functools
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
DOMAIN = str(10 + os.getpid() % 14)  # below those that rds run takes

Peer = functools.partial(peer_process.Peer, PEER)
Stranger = functools.partial(peer_process.Peer, PYTHON, "-B", FOLDER / "zenoh_stranger.py")


def can_import(*modules):
    command = [PYTHON, "-c", "import " + ", ".join(modules)]
    return os.path.exists(PYTHON) and subprocess.run(command, capture_output=True, check=False).returncode == 0


@unittest.skipUnless(can_import("zenoh", "zenoh_ros2_sdk"), "no Python packages of zenoh_requirements.txt (tools/setup.sh --ros)")
class Strangers(unittest.TestCase):
    def test_eclipse_zenoh_joins_late_and_has_the_map_once(self):
        with subprocess.Popen([SOURCE, "zenoh", DOMAIN, "8"]) as source:
            client = subprocess.run([PYTHON, "-B", FOLDER / "zenoh_client.py", DOMAIN, "4"], capture_output=True, text=True, check=False)
            self.assertEqual(source.wait(), 0)
        self.assertEqual(client.returncode, 0, client.stderr)
        maps = [json.loads(line) for line in client.stdout.splitlines()]
        self.assertEqual(maps, [{"frame": "map", "kind": "ColorOcTree", "resolution": 0.05, "bytes": 200000, "sum": 600000}])

    def test_the_sdk_hears_us(self):
        with Peer("talker", "zenoh", DOMAIN), Stranger("listen", "picture", DOMAIN, 30) as stranger:
            self.assertTrue(stranger.wait_for(lambda lines: len(lines) >= 5))
            numbers = [int(line.split()[1]) for line in stranger.lines[:5]]
            self.assertEqual(numbers, list(range(numbers[0], numbers[0] + 5)))
            stranger.process.terminate()

    def test_we_hear_the_sdk(self):
        with Peer("reader", "zenoh", DOMAIN) as reader, Stranger("talk", "picture", DOMAIN, 30) as stranger:
            self.assertTrue(reader.wait_for(lambda lines: len(lines) >= 5))
            numbers = [int(line) for line in reader.lines[:5]]
            self.assertEqual(numbers, list(range(numbers[0], numbers[0] + 5)))
            stranger.process.terminate()

    def test_the_sdk_calls_a_service(self):
        with Peer("server", "zenoh", DOMAIN), Stranger("call", "switch", DOMAIN, 30) as stranger:
            self.assertTrue(stranger.wait_for(lambda lines: len(lines) >= 2))
            self.assertEqual(stranger.lines[:2], ["(True, 'on')", "(False, 'off')"])


if __name__ == "__main__":
    unittest.main()
