# SPDX-License-Identifier: Apache-2.0
"""The launch file, as ROS 2 runs it from where it is installed: launch_test.py BUILD

The package is installed into a folder, found there by ament_index_python, its programs started as launch_ros starts them, and an rclpy node looks
who is there. Needs .venv-jazzy (tools/setup.sh --ros); skips without.
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
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "integration" / "bus")]
import launch_file  # noqa: E402
from peer_process import Peer  # noqa: E402

BUILD = sys.argv.pop(1)
PYTHON = ROOT / ".venv-jazzy" / "bin" / "python"
NODES = ["rds_detector", "rds_loop_closer", "rds_mapper", "rds_tracker", "rds_transformer"]


class Launch(unittest.TestCase):
    def setUp(self):
        if not PYTHON.exists():
            self.skipTest("no .venv-jazzy (tools/setup.sh --ros)")
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)
        self.folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.prefix = self.folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", self.prefix, "--component", "services"], check=True, stdout=subprocess.DEVNULL)
        self.domain = str(160 + os.getpid() % 10)

    def ask_index(self, expression):
        """Of ament_index_python, with the installed prefix in its path."""
        code = f"import ament_index_python.packages as packages; print(packages.{expression})"
        return subprocess.run([PYTHON, "-c", code], env={**os.environ, "AMENT_PREFIX_PATH": str(self.prefix)}, check=True, capture_output=True,
                              text=True).stdout.strip()

    def start(self, arguments):
        peer = self.stack.enter_context(Peer(*arguments, environment={**os.environ, "ROS_DOMAIN_ID": self.domain, "RDS_MAPS_DIR": str(self.folder)}))
        self.stack.callback(lambda: peer.lives() and peer.send(signal.SIGTERM))
        return peer

    def graph(self):
        environment = {"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/"), "ROS_DOMAIN_ID": self.domain}
        said = subprocess.run([PYTHON, "-B", FOLDER / "ros_graph.py", str(len(NODES))], env=environment, check=True, capture_output=True, text=True).stdout
        return json.loads(said)

    def test_starts_five_nodes_in_their_namespace(self):
        self.assertEqual(self.ask_index("get_package_prefix('rds_slam')"), str(self.prefix))
        share = pathlib.Path(self.ask_index("get_package_share_directory('rds_slam')"))
        self.assertIn("<name>rds_slam</name>", (share / "package.xml").read_text(encoding="utf-8"))
        self.assertNotIn("@", (share / "package.xml").read_text(encoding="utf-8").split("<maintainer")[0])
        commands = launch_file.commands(share / "launch" / "rds_slam.launch.xml", lambda package: self.ask_index(f"get_package_prefix('{package}')"), self.folder,
                                        namespace="robot1", frame_prefix="robot1/", camera="xtion", depth="mine/depth")
        peers = [self.start(command) for command in commands]
        graph = self.graph()
        self.assertEqual(graph["nodes"], [f"/robot1/{name}" for name in NODES])
        read = {name: graph["by_node"][f"/robot1/{name}"]["subscribers"] for name in ("rds_tracker", "rds_transformer")}
        self.assertIn("/robot1/camera/rgb/image_raw", read["rds_tracker"])
        self.assertIn("/robot1/mine/depth", read["rds_tracker"])
        self.assertIn("/robot1/camera/rgb/camera_info", read["rds_transformer"])
        self.assertTrue(all(peer.lives() for peer in peers))


if __name__ == "__main__":
    unittest.main()
