# SPDX-License-Identifier: Apache-2.0
"""ROS 2 programs ask our nodes by services: ros_services_test.py FOLDER_OF_PROGRAMS RECORDING

Parameters, state, grid and commands, by rclpy of Jazzy and of Kilted at once, of tracker and mapper on Fast DDS, while a camera plays RECORDING (there is no
wheel of rmw_cyclonedds: node_services_test asks in its form). Needs .venv-jazzy and .venv-kilted in the project's root (tools/setup.sh --ros); skips without.
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
RECORDING = sys.argv.pop(1)
DISTRIBUTIONS = ("jazzy", "kilted")
TRACKER, MAPPER = "/robot1/rds_tracker", "/robot1/rds_mapper"
OF_EVERY_NODE = {"list_parameters": "ListParameters", "get_parameters": "GetParameters", "get_parameter_types": "GetParameterTypes",
                 "describe_parameters": "DescribeParameters", "set_parameters": "SetParameters", "set_parameters_atomically": "SetParametersAtomically"}

LIVE = {TRACKER: ["frames.publish_tf", "keyframe.movable_interval_s", "keyframe.static_interval_s", "log_level"],
        MAPPER: ["boxes_timeout_s", "full_map_every", "grid.max_height_m", "grid.min_height_m", "log_level"]}
LIFECYCLE = {"get_state": "GetState", "change_state": "ChangeState", "get_available_states": "GetAvailableStates",
             "get_available_transitions": "GetAvailableTransitions", "get_transition_graph": "GetAvailableTransitions"}


def python_of(distribution):
    return ROOT / f".venv-{distribution}" / "bin" / "python"


def services_of(node):
    services = {f"{node}/{name}": [f"rcl_interfaces/srv/{kind}"] for name, kind in OF_EVERY_NODE.items()}
    services |= {f"{node}/{name}": [f"lifecycle_msgs/srv/{kind}"] for name, kind in LIFECYCLE.items()}
    services |= {f"{node}/pause": ["std_srvs/srv/SetBool"], f"{node}/reset": ["std_srvs/srv/Trigger"]}
    if node == MAPPER:
        services |= {f"{node}/map": ["nav_msgs/srv/GetMap"], "/robot1/octomap_binary": ["octomap_msgs/srv/GetOctomap"],
                     "/robot1/octomap_full": ["octomap_msgs/srv/GetOctomap"]}
    else:
        services |= {f"{node}/{name}_map": [f"rds_msgs/srv/{name.title()}Map"] for name in ("save", "load")}
    return services


class RosServices(unittest.TestCase):
    def setUp(self):
        for distribution in DISTRIBUTIONS:
            if not python_of(distribution).exists():
                self.skipTest(f"no .venv-{distribution} (tools/setup.sh --ros)")
        self.processes = contextlib.ExitStack()
        self.addCleanup(self.processes.close)
        folder = self.processes.enter_context(tempfile.TemporaryDirectory())
        self.domain = str(180 + os.getpid() % 20)
        self.environment = {**os.environ, "RDS_MAPS_DIR": folder}

    def start(self, program, *arguments):
        peer = self.processes.enter_context(Peer(PROGRAMS / program, *arguments, "--bus", "fastdds", "--domain", self.domain, "--namespace", "robot1",
                                                 environment=self.environment))
        self.processes.callback(lambda: peer.lives() and peer.send(signal.SIGTERM))
        return peer

    def wait_for_a_map(self):
        for _ in range(60):
            shown = subprocess.run([PROGRAMS / "rds", "topic", "echo", "rds/map/info", "--count", "1", "--timeout", "2", "--domain", self.domain, "--namespace", "robot1"],
                                   capture_output=True, text=True)
            if shown.stdout and json.loads(shown.stdout.splitlines()[0])["occupied_count"] > 1000:
                return
        self.fail("no map: " + shown.stderr)

    def ask(self, distribution, *what):
        environment = {"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/"), "ROS_DOMAIN_ID": self.domain}
        return subprocess.Popen([python_of(distribution), "-B", FOLDER / "ros_services.py", TRACKER, MAPPER, *what], env=environment, stdout=subprocess.PIPE, text=True)

    def check_parameters(self, told):
        for node, name, value, description in ((TRACKER, "extraction.features", 800, "wanted per picture"), (TRACKER, "extraction.scale_factor", 1.2, "between levels"),
                                               (TRACKER, "camera.preset", "rds", None), (TRACKER, "dynamics", True, None),
                                               (TRACKER, "frame_prefix", "robot1/", "before the names of the robot's frames"),
                                               (MAPPER, "expect_boxes", False, None), (MAPPER, "octree.resolution_m", 0.05, None)):
            with self.subTest(name):
                self.assertEqual(told[node]["values"][name], value)
                self.assertIs(type(told[node]["values"][name]), type(value))
                if description:
                    self.assertEqual(told[node]["descriptions"][name], description)
        for node in (TRACKER, MAPPER):
            self.assertGreater(len(told[node]["values"]), 25)
            self.assertTrue(told[node]["types_agree"])
            self.assertEqual(told[node]["live"], LIVE[node])
            for successful, reason in told[node]["refusals"]:
                self.assertFalse(successful)
                self.assertIn("is read at the start", reason)
            self.assertEqual(told[node]["state"], "active")

    def check_graph(self, told):
        for node in (TRACKER, MAPPER):
            self.assertEqual(told[node]["services"], services_of(node))

    def check_map_and_commands(self, told):
        self.assertEqual(told["grid"]["frame"], "robot1/map")
        self.assertGreater(told["grid"]["occupied"], 0)
        self.assertGreaterEqual(told["grid"]["width"] * told["grid"]["height"], told["grid"]["occupied"])
        self.assertEqual(told["commands"], ["paused", "resumed"])

    def check_set(self, told, height):
        taken, bounds, kind, constant, level = told["results"]
        self.assertEqual([taken[0], level[0]], [True, True])
        self.assertRegex(bounds[1], "grid.max_height_m: -1000, expected")
        self.assertEqual(kind, [False, "'full_map_every' is of type integer, not string"])
        self.assertRegex(constant[1], "is read at the start")
        self.assertEqual(told["together"][0], False)
        self.assertRegex(told["together"][1], "full_map_every: 0, expected 1")
        self.assertEqual(told["values"], [height, 1.8, "debug"])
        self.assertEqual(told["events"], [["grid.min_height_m", height], ["log_level", "debug"]])
        self.assertEqual(told["logged"], [[20, "log_level is debug now"]])

    def check_lifecycle(self, told):
        self.assertEqual(told["states"], ["unknown", "unconfigured", "inactive", "active", "finalized", "configuring", "cleaningup", "shuttingdown", "activating",
                                          "deactivating", "errorprocessing"])
        self.assertEqual(told["graph"], ["configure", "cleanup", "activate", "deactivate", "shutdown", "shutdown", "shutdown"])
        self.assertEqual(told["at_first"], ["active", ["deactivate", "shutdown"]])
        self.assertEqual(told["refused"], 4 * [[False, "active"]])
        self.assertEqual(told["inactive"], ["cleanup", "activate", "shutdown"])
        self.assertEqual(told["refused_inactive"], [False, "inactive"])
        self.assertEqual(told["done"], [[True, "inactive"], [True, "unconfigured"], [True, "inactive"], [True, "active"]])
        self.assertEqual(told["by_pause"], [[True, "inactive"], [True, "active"]])
        steps = [("active", "deactivate", "deactivating", "inactive"), ("inactive", "cleanup", "cleaningup", "unconfigured"),
                 ("unconfigured", "configure", "configuring", "inactive"), ("inactive", "activate", "activating", "active")]
        events = [event for start, label, during, goal in steps for event in ([start, label, during], [during, "transition_success", goal])]
        self.assertEqual(told["events"], [*events, ["active", "deactivate", "inactive"], ["inactive", "activate", "active"]])

    def test_of_jazzy_and_kilted_at_once(self):
        own = ("--frame-prefix", "robot1/", "--ros-args")
        tracker = self.start("rds-tracker", *own, "-p", "extraction.features:=800", "--")
        self.start("rds-mapper", *own, "-p", "expect_boxes:=false", "--")
        self.start("rds", "play", RECORDING)
        self.wait_for_a_map()
        numbers = [str(len(services_of(node))) for node in (TRACKER, MAPPER)]
        askers = {distribution: self.ask(distribution, "look", *numbers) for distribution in DISTRIBUTIONS}
        answers = {distribution: asker.communicate()[0] for distribution, asker in askers.items()}
        for distribution, answer in answers.items():
            with self.subTest(distribution):
                told = json.loads(answer)
                self.check_parameters(told)
                self.check_graph(told)
                self.check_map_and_commands(told)
        for distribution, height in (("jazzy", 1.5), ("kilted", 0.1)):
            with self.subTest(distribution):
                told = json.loads(self.ask(distribution, "set", str(height)).communicate()[0])
                self.check_set(told, height)
                before, after = told["occupied"]
                self.assertTrue(after < before if height > 1 else after > before, told["occupied"])
        for distribution in DISTRIBUTIONS:
            with self.subTest(distribution):
                self.check_lifecycle(json.loads(self.ask(distribution, "lifecycle").communicate()[0]))
        self.assertEqual(self.ask("kilted", "reset").communicate()[0], "true\n")
        self.assertEqual(self.ask("jazzy", "shutdown").communicate()[0], "true\n")
        self.assertEqual(tracker.process.wait(20), 0)

    def test_a_managed_node_is_brought_up(self):
        self.start("rds-tracker", "--managed")
        self.assertEqual(json.loads(self.ask("jazzy", "managed").communicate()[0]), ["unconfigured", [True, "inactive"], [True, "active"]])


if __name__ == "__main__":
    unittest.main()
