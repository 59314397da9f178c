# SPDX-License-Identifier: Apache-2.0
"""Who comes late has the last messages, in order, none twice: between us and PyPI's eclipse-zenoh, both ways.

    zenoh_latched_test.py PATH_OF_bus_peer PYTHON...

Each PYTHON has another version of eclipse-zenoh (zenoh_requirements.txt, zenoh_requirements_1.5.txt).
"""

import contextlib
import functools
import os
import pathlib
import subprocess
import sys
import time
import unittest

import peer_process

PEER, *PYTHONS = (argument for argument in sys.argv[1:] if not argument.startswith("-"))
FOLDER = pathlib.Path(__file__).resolve().parent
DOMAIN = 10 + os.getpid() % 180
DEPTH = 3


def is_there(python):
    return os.path.exists(python) and subprocess.run([python, "-c", "import zenoh.ext"], capture_output=True, check=False).returncode == 0


def ours(mode, domain, *depth):
    return peer_process.Peer(PEER, mode, "zenoh", domain, *depth)


def theirs(python, mode, domain, depth):
    return peer_process.Peer(python, "-B", FOLDER / "zenoh_latched.py", mode, domain, depth)


class LateJoin(unittest.TestCase):
    def check(self, teller, readers):
        """@param readers  of each how many of the messages before it came it asks for, at most, and what starts it."""
        def join(stack, expected):
            joined = [(stack.enter_context(start()), expected[-depth:]) for depth, start in readers]
            for reader, first in joined:
                self.assertTrue(reader.wait_for(lambda lines, first=first: len(lines) >= len(first)), (reader.lines, first))
            return joined

        numbers = [str(i) for i in range(8)]
        with contextlib.ExitStack() as stack:
            stack.enter_context(teller)
            teller.tell(numbers[:1])
            early = join(stack, numbers[:1])
            teller.tell(numbers[1:6])
            for reader, _ in early:
                self.assertTrue(reader.wait_for(lambda lines: lines[-1] == numbers[5]), reader.lines)
            late = join(stack, numbers[6 - DEPTH:6])
            teller.tell(numbers[6:])
            for reader, first in early + late:
                self.assertTrue(reader.wait_for(lambda lines: lines[-1] == numbers[-1]), reader.lines)
            time.sleep(1)  # heartbeats come, and what is wrongly asked for again
            for reader, first in early + late:
                self.assertEqual(reader.lines, numbers[numbers.index(first[0]):])

    def test_they_come_late(self):
        readers = [(depth, functools.partial(theirs, python, "late", DOMAIN, depth)) for python in PYTHONS for depth in (2, 100)]
        self.check(ours("teller", DOMAIN, DEPTH), readers)

    def test_we_come_late(self):
        for number, python in enumerate(PYTHONS, 1):
            with self.subTest(python):
                self.check(theirs(python, "teller", DOMAIN + number, DEPTH), [(100, functools.partial(ours, "late", DOMAIN + number))])


if __name__ == "__main__":
    if not all(map(is_there, PYTHONS)):
        print("no Python packages of zenoh_requirements.txt and zenoh_requirements_1.5.txt (tools/setup.sh --ros)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"])
