# SPDX-License-Identifier: Apache-2.0
"""A bag that is played twice, with ROS' own clock: ros_clock_test.py FOLDER_OF_PROGRAMS

Our tracker and mapper, started with use_sim_time as all nodes of a launch file are, beside nodes of rclpy that play a camera by /clock, of which the time begins anew
with each pass: frames are tracked, and keyframes made, in both. Needs .venv-jazzy and .venv-kilted in the project's root (tools/setup.sh --ros); skips without.
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
from peer_process import Peer  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1))
SECONDS = 6
PASSES = 2
BEGIN_S = 1000  # of each pass, by /clock
TRACKED = (1, 2, 4)  # states with a pose


class RosClock(unittest.TestCase):
    def start(self, processes, *command, **options):
        peer = processes.enter_context(Peer(*command, **options))
        processes.callback(lambda: peer.lives() and peer.send(signal.SIGTERM))
        return peer

    def play(self, distribution, vendor, domain):
        """@return what the tracker says of each frame of the passes, and of which epochs the map is that the mapper tells of."""
        python = ROOT / f".venv-{distribution}" / "bin" / "python"
        if not python.exists():
            self.skipTest(f"no .venv-{distribution} (tools/setup.sh --ros)")
        bus = ("--bus", vendor, "--domain", domain)
        with contextlib.ExitStack() as processes:
            maps = processes.enter_context(tempfile.TemporaryDirectory())
            for service in ("rds-tracker", "rds-mapper"):
                self.start(processes, PROGRAMS / service, *bus, "--ros-args", "-p", "use_sim_time:=true", environment={**os.environ, "RDS_MAPS_DIR": maps})
            echo = self.start(processes, PROGRAMS / "rds", "topic", "echo", "rds/tracking_state", *bus)
            environment = {"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/"), "ROS_DOMAIN_ID": domain}
            subprocess.run([python, "-B", FOLDER / "ros_bag.py", str(PASSES), str(SECONDS)], env=environment, check=True, timeout=120)
            return [json.loads(line) for line in echo.lines]

    def check(self, states):
        stamps = [state["header"]["stamp"]["sec"] + state["header"]["stamp"]["nanosec"] * 1e-9 for state in states]
        begins = [0, *(i for i in range(1, len(stamps)) if stamps[i] < stamps[i - 1])]
        self.assertEqual(len(begins), PASSES)
        for begin, end in zip(begins, [*begins[1:], len(states)], strict=True):
            frames = states[begin:end]
            self.assertGreater(len(frames), 15 * SECONDS)  # of 30: a busy machine drops some while the camera finds itself in the map
            self.assertGreater(sum(state["state"] in TRACKED for state in frames), 0.8 * len(frames))
            self.assertEqual({state["map_epoch"] for state in frames}, {states[0]["map_epoch"]})
            seconds = {int(stamp - BEGIN_S) for stamp, state in zip(stamps[begin:end], frames, strict=True) if state["is_keyframe"]}
            self.assertLessEqual(set(range(1, SECONDS)), seconds, "of the pass, in which there is a keyframe")

    def test_keyframes_are_made_in_each_pass(self):
        for i, (distribution, vendor) in enumerate((("jazzy", "fastdds"), ("kilted", "cyclonedds"))):
            with self.subTest(f"{distribution} beside {vendor}"):
                self.check(self.play(distribution, vendor, str(20 + 20 * i + os.getpid() % 20)))


if __name__ == "__main__":
    unittest.main()
