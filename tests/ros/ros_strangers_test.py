# SPDX-License-Identifier: Apache-2.0
"""ROS 2 programs come, go and die beside ours: ros_strangers_test.py FOLDER_OF_PROGRAMS RECORDING

Beside writers and readers of both vendors, and beside the five services of each while a camera plays RECORDING.
Needs .venv-jazzy and .venv-kilted in the project's root (tools/setup.sh --ros); skips without.
RDS_STRANGERS_MINUTES  for how long programs of each distribution come and go; without it, once.
"""

import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path.insert(0, str(FOLDER.parent / "integration" / "bus"))
from peer_process import VENDORS, Peer  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1))
RECORDING = sys.argv.pop(1)
BUS_PEER = PROGRAMS / "bus_peer"
SERVICES = ("tracker", "detector", "transformer", "mapper", "loop-closer")
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
        self.come_and_go_on(distribution, domain, VENDORS, readers, [*talkers.values(), *readers.values()])

    def meet_services(self, distribution, domain, vendor):
        """They see a camera's pictures, as a driver's neighbours would, and talk among themselves."""
        bus = ("--bus", vendor, "--domain", domain)
        with contextlib.ExitStack() as processes:
            maps = processes.enter_context(tempfile.TemporaryDirectory())

            def start(*command):
                peer = processes.enter_context(Peer(*command, environment={**os.environ, "RDS_MAPS_DIR": maps}))
                processes.callback(lambda: peer.lives() and peer.send(signal.SIGTERM))
                return peer

            def all_are_well():
                status = subprocess.run([*map(str, (PROGRAMS / "rds", "status", "--wait", 30, *bus))], capture_output=True, text=True)
                self.assertEqual(status.returncode, 0, status.stdout + status.stderr)

            ours = [start(PROGRAMS / f"rds-{service}", *bus) for service in SERVICES]
            ours.append(start(PROGRAMS / "rds", "play", RECORDING, "--loop", *bus))
            all_are_well()
            self.come_and_go_on(distribution, domain, ("camera",), {}, ours)
            all_are_well()

    def come_and_go_on(self, distribution, domain, speakers_of_ours, readers, ours):
        def all_hear(listeners, speakers):
            for listener in listeners:
                seen = len(listener.lines)
                for speaker in speakers:
                    self.assertTrue(listener.wait_for(lambda lines: any(line.startswith(speaker + " ") for line in lines[seen:])), speaker)
            self.assertEqual([peer.process.args for peer in ours if not peer.lives()], [], "ended")

        all_hear(readers.values(), speakers_of_ours)
        end = time.monotonic() + SOAK_S
        self.come_and_go(distribution, domain, speakers_of_ours, readers, all_hear)
        while time.monotonic() < end:
            self.come_and_go(distribution, domain, speakers_of_ours, readers, all_hear)

    def come_and_go(self, distribution, domain, speakers_of_ours, readers, all_hear):
        """Four come; two are killed, one leaves; two more come, and those still there are killed."""
        first = self.start_strangers(distribution, ("first", "second", "third", "fourth"), domain)
        all_hear([*readers.values(), *first.values()], [*speakers_of_ours, *first])
        first["first"].send(signal.SIGKILL)
        first["second"].send(signal.SIGKILL)
        first["third"].process.stdin.close()
        first["third"].process.wait(60)
        later = self.start_strangers(distribution, ("fifth", "sixth"), domain)
        all_hear([*readers.values(), *later.values()], [*speakers_of_ours, "fourth", *later])
        for stranger in (first["fourth"], *later.values()):
            stranger.send(signal.SIGKILL)
        all_hear(readers.values(), speakers_of_ours)

    def test_jazzy(self):
        self.meet("jazzy", 10 + os.getpid() % 45)

    def test_kilted(self):
        self.meet("kilted", 55 + os.getpid() % 45)

    def test_jazzy_beside_services(self):
        for i, vendor in enumerate(VENDORS):
            with self.subTest(vendor):
                self.meet_services("jazzy", 100 + 20 * i + os.getpid() % 20, vendor)

    def test_kilted_beside_services(self):
        for i, vendor in enumerate(VENDORS):
            with self.subTest(vendor):
                self.meet_services("kilted", 140 + 20 * i + os.getpid() % 20, vendor)


if __name__ == "__main__":
    unittest.main()
