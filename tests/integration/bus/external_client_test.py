# SPDX-License-Identifier: Apache-2.0
"""A client that none of our code is part of reads our topics, whichever vendor wrote them.

    external_client_test.py PATH_OF_external_client_source

Needs a Python with PyPI's cyclonedds 11: this one, or the one RDS_PYTHON names; skips without.
"""

import json
import os
import pathlib
import subprocess
import sys
import unittest

FOLDER = pathlib.Path(__file__).resolve().parent
PYTHON = os.environ.get("RDS_PYTHON", sys.executable)
SOURCE = sys.argv.pop(1)
DOMAIN = str(10 + os.getpid() % 14)  # below those that rds run takes


def can_import_cyclonedds():
    return subprocess.run([PYTHON, "-c", "import cyclonedds.idl"], capture_output=True, check=False).returncode == 0


@unittest.skipUnless(can_import_cyclonedds(), "no Python package cyclonedds (set RDS_PYTHON)")
class ExternalClient(unittest.TestCase):
    def hear(self, vendor):
        with subprocess.Popen([SOURCE, vendor, DOMAIN, "8"]) as source:
            client = subprocess.run([PYTHON, "-B", FOLDER / "external_client.py", "--domain", DOMAIN, "--seconds", "5", "--loopback"],
                                    capture_output=True, text=True, check=False)
            self.assertEqual(source.wait(), 0)
        self.assertEqual(client.returncode, 0, client.stdout[-2000:] + client.stderr)
        return [json.loads(line) for line in client.stdout.splitlines()[:-1]]

    def check(self, vendor):
        lines = self.hear(vendor)
        numbers = [m["message"]["pose"]["pose"]["position"]["x"] for m in lines if m["topic"] == "rds/odometry"]
        self.assertEqual(numbers, [numbers[0] + i for i in range(len(numbers))], "odometry was lost or out of order")
        maps = [m["message"] for m in lines if m["topic"] == "rds/map/full"]
        self.assertEqual([m["data"] for m in maps], [{"length": 200000, "sum": 600000}])
        box = next(m["message"] for m in lines if m["topic"] == "rds/boxes")["detections"][0]
        self.assertEqual(box["results"][0]["hypothesis"]["class_id"], "person")
        self.assertEqual(box["bbox"]["size"], {"x": 1.0, "y": 2.0, "z": 2.0})

    def test_hears_fast_dds(self):
        self.check("fastdds")

    def test_hears_cyclone_dds(self):
        self.check("cyclonedds")


if __name__ == "__main__":
    unittest.main()
