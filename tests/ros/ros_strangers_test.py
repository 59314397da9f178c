# SPDX-License-Identifier: Apache-2.0
"""ROS 2 programs come, go and die beside ours: ros_strangers_test.py PATH_OF_bus_peer

Needs .venv-jazzy and .venv-kilted in the project's root (tools/setup.sh --ros); skips without.
RDS_STRANGERS_MINUTES  for how long programs of each distribution come and go; without it, once.
"""

import contextlib
import os
import pathlib
import signal
import sys
import time
import unittest

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path.insert(0, str(FOLDER.parent / "integration" / "bus"))
from peer_process import VENDORS, Peer  # noqa: E402

BUS_PEER = sys.argv.pop(1)
SOAK_S = 60 * float(os.environ.get("RDS_STRANGERS_MINUTES", "0"))


class RosStrangers(unittest.TestCase):
    def setUp(self):
        processes = contextlib.ExitStack()
        self.addCleanup(processes.close)
        self.start = lambda *command, **options: processes.enter_context(Peer(*command, **options))

    def start_strangers(self, distribution, names, domain):
        python = ROOT / f".venv-{distribution}" / "bin" / "python"
        if not python.exists():
            self.skipTest(f"no .venv-{distribution} (tools/setup.sh --ros)")
        environment = {"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/"), "ROS_DOMAIN_ID": str(domain)}
        return {name: self.start(python, "-B", FOLDER / "ros_stranger.py", name, environment=environment) for name in names}

    def meet(self, distribution, domain):
        talkers = {vendor: self.start(BUS_PEER, "--network", "talker", vendor, domain) for vendor in VENDORS}
        readers = {vendor: self.start(BUS_PEER, "--network", "reader", vendor, domain) for vendor in VENDORS}
        ours = [*talkers.values(), *readers.values()]

        def all_hear(listeners, speakers):
            for listener in listeners:
                seen = len(listener.lines)
                for speaker in speakers:
                    self.assertTrue(listener.wait_for(lambda lines: any(line.startswith(speaker + " ") for line in lines[seen:])), speaker)
            self.assertTrue(all(peer.lives() for peer in ours), "one of ours has ended")

        all_hear(readers.values(), VENDORS)
        end = time.monotonic() + SOAK_S
        self.come_and_go(distribution, domain, readers, all_hear)
        while time.monotonic() < end:
            self.come_and_go(distribution, domain, readers, all_hear)

    def come_and_go(self, distribution, domain, readers, all_hear):
        """Four come; two are killed, one leaves; two more come, and those still there are killed."""
        first = self.start_strangers(distribution, ("first", "second", "third", "fourth"), domain)
        all_hear([*readers.values(), *first.values()], [*VENDORS, *first])
        first["first"].send(signal.SIGKILL)
        first["second"].send(signal.SIGKILL)
        first["third"].process.stdin.close()
        first["third"].process.wait(60)
        later = self.start_strangers(distribution, ("fifth", "sixth"), domain)
        all_hear([*readers.values(), *later.values()], [*VENDORS, "fourth", *later])
        for stranger in (first["fourth"], *later.values()):
            stranger.send(signal.SIGKILL)
        all_hear(readers.values(), VENDORS)

    def test_jazzy(self):
        self.meet("jazzy", 10 + os.getpid() % 45)

    def test_kilted(self):
        self.meet("kilted", 55 + os.getpid() % 45)


if __name__ == "__main__":
    unittest.main()
