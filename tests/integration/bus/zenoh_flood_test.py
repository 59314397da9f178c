# SPDX-License-Identifier: Apache-2.0
"""A program on Zenoh that others flood lives, hears the others, and does not grow: zenoh_flood_test.py PATH_OF_bus_peer PYTHON

PYTHON has the packages of zenoh_requirements.txt; skips without. RDS_SOAK=1: a minute each in place of seconds.
"""

import functools
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import peer_process

PYTHON = sys.argv.pop(2)
PEER = sys.argv.pop(1)
FOLDER = pathlib.Path(__file__).resolve().parent
DOMAINS = itertools.count(10 + os.getpid() % 180)
SOAK = "RDS_SOAK" in os.environ
SECONDS = 60 if SOAK else 1.5
GAPS_SECONDS = max(SECONDS, 3)  # 1.5 GB where it was tried: twice what may be held
SETTINGS = "{transport: {link: {rx: {max_message_size: %d}}}}" % (8 << 20)
Flooding = functools.partial(peer_process.Peer, PYTHON, "-B", FOLDER / "zenoh_flood.py")


def can_import(*modules):
    command = [PYTHON, "-c", "import " + ", ".join(modules)]
    return os.path.exists(PYTHON) and subprocess.run(command, capture_output=True, check=False).returncode == 0


def megabytes(peer, name):
    """VmRSS: what a process has in memory now; VmHWM: the most that it has had."""
    with open(f"/proc/{peer.process.pid}/status", encoding="utf-8") as status:
        return next(int(line.split()[1]) for line in status if line.startswith(name)) / 1024


def newest(meter):
    return json.loads(meter.lines[-1])


@unittest.skipUnless(can_import("zenoh"), "no Python packages of zenoh_requirements.txt (tools/setup.sh --ros)")
class Flood(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        settings = pathlib.Path(folder, "settings.json5")
        settings.write_text(SETTINGS, encoding="utf-8")
        self.peer = functools.partial(peer_process.Peer, PEER, environment={**os.environ, "ZENOH_CONFIG": str(settings)})

    def hears_more(self, meter, count=3):
        heard = newest(meter)["number"]["messages"]
        return meter.wait_for(lambda lines: json.loads(lines[-1])["number"]["messages"] >= heard + count)

    def flood(self, attack, limit_mb, seconds=SECONDS):
        """@return how many messages of each topic the program that was flooded has dropped, and how many questions it has asked."""
        domain = next(DOMAINS)
        with self.peer("keeper", "zenoh", domain, 1_000_000), self.peer("meter", "zenoh", domain) as meter:
            self.assertTrue(meter.wait_for(lambda lines: lines))
            self.assertTrue(self.hears_more(meter))
            before, start = megabytes(meter, "VmRSS"), newest(meter)
            with Flooding(attack, domain, seconds) as stranger:
                self.assertTrue(stranger.wait_for(lambda lines: lines, seconds + 60))
                sent = json.loads(stranger.lines[0])
            self.assertTrue(meter.lives())
            self.assertTrue(self.hears_more(meter))
            grown, kept, end = megabytes(meter, "VmHWM") - before, megabytes(meter, "VmRSS") - before, newest(meter)
        print(f"{attack}: {sent}, {start} -> {end}; {before:.0f} MiB, at most {grown:.0f} more, {kept:.0f} kept", file=sys.stderr)
        self.assertGreater(sent["sent"], 0)
        self.assertLess(grown, limit_mb)
        return {topic: end[topic]["dropped"] - start[topic]["dropped"] for topic in end}, sent["asked"]

    def test_more_tokens_than_anyone_needs(self):
        self.flood("tokens", 100)

    def test_writers_that_there_are_not(self):
        dropped, asked = self.flood("sources", 25)
        self.assertGreater(dropped["number"], 100)
        self.assertLessEqual(asked, 1000 * (1 + (SECONDS + 10) // 10))  # each is open for ten seconds

    def test_gaps_that_nobody_fills(self):
        dropped, _ = self.flood("gaps", 800, GAPS_SECONDS)
        self.assertGreater(dropped["number"], 100)

    def test_messages_of_the_largest_size(self):
        dropped, _ = self.flood("large", 150)
        self.assertGreater(dropped["picture"], 10)


if __name__ == "__main__":
    unittest.main()
