# SPDX-License-Identifier: Apache-2.0
"""Two robots in one domain, as ROS 2 sees them: ros_graph_test.py FOLDER_OF_PROGRAMS

Every node, and every endpoint with its node, type, type hash and QoS, from rclpy of Jazzy and of Kilted, on both vendors; then a camera of each robot,
one with sensor-data QoS, one with compressed pictures alone, and nothing of one robot comes to the other. Needs .venv-jazzy and .venv-kilted in the project's root (tools/setup.sh --ros); skips without.
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
sys.path.insert(0, str(ROOT / "cmake"))
import idl_model  # noqa: E402
from peer_process import VENDORS, Peer  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1))
SERVICES = ("tracker", "detector", "transformer", "mapper", "loop-closer")
DISTRIBUTIONS = ("jazzy", "kilted")
STRUCTS = idl_model.load([ROOT / "idl" / "ros2", ROOT / "idl"])
OWN_TF = ["-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]  # both cameras are of one name
ROBOTS = {"robot1": ["--namespace", "robot1", "--frame-prefix", "robot1/", "--ros-args", *OWN_TF],
          "robot2": ["--ros-args", "-r", "__ns:=/robot2", "-p", "frame_prefix:=robot2/", *OWN_TF]}  # as a launch file starts them
GLOBAL = ("/diagnostics", "/parameter_events", "/rosout")
# Reliable and latched, as the table of topics says.
QOS = {"rds/odometry": (True, False), "rds/trajectory": (True, True), "tf": (True, False), "rds/boxes": (True, True), "rds/map/full": (True, True), "rds/map/grid": (True, True),
       "rds/map/grid_updates": (True, False),
       "rds/services": (True, True), "rds/transfer/requests": (False, False), "/diagnostics": (True, False), "/parameter_events": (True, False), "/rosout": (True, True)}


def python_of(distribution):
    return ROOT / f".venv-{distribution}" / "bin" / "python"


def node_name(robot, service):
    return f"/{robot}/rds_{service.replace('-', '_')}"


class RosGraph(unittest.TestCase):
    def setUp(self):
        for distribution in DISTRIBUTIONS:
            if not python_of(distribution).exists():
                self.skipTest(f"no .venv-{distribution} (tools/setup.sh --ros)")
        processes = contextlib.ExitStack()
        self.addCleanup(processes.close)
        self.folder = pathlib.Path(processes.enter_context(tempfile.TemporaryDirectory()))
        self.processes = processes

    def start(self, *command, environment=None):
        environment = environment or {**os.environ, "RDS_MAPS_DIR": str(self.folder)}
        peer = self.processes.enter_context(Peer(*command, environment=environment))
        self.processes.callback(lambda: peer.lives() and peer.send(signal.SIGTERM))
        return peer

    def rds(self, *words):
        return subprocess.run([str(PROGRAMS / "rds"), *map(str, words), *self.bus], capture_output=True, text=True)

    def messages(self, topic, count, *bus):
        shown = self.rds("topic", "echo", topic, "--count", count, "--timeout", 30, *bus)
        self.assertEqual(shown.returncode, 0, shown.stderr)
        return [json.loads(line) for line in shown.stdout.splitlines()]

    def ros_environment(self):
        return {"PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "/"), "ROS_DOMAIN_ID": str(self.domain)}

    def look(self, distribution):
        return subprocess.Popen([str(python_of(distribution)), "-B", str(FOLDER / "ros_graph.py"), str(len(ROBOTS) * len(SERVICES))],
                                env=self.ros_environment(), stdout=subprocess.PIPE, text=True)

    def check_graph(self, graph, ours):
        self.assertEqual(graph["nodes"], sorted(node_name(robot, service) for robot in ROBOTS for service in SERVICES))
        kinds = {"publishers": "publishers", "subscribers": "subscribers"}
        for topic in ours:
            seen = graph["topics"].get("/" + topic["topic"])
            self.assertIsNotNone(seen, topic["topic"])
            for kind in kinds:
                self.assertEqual(len([e for e in seen[kind] if e["node"] != "/looker"]), topic[kind], (topic["topic"], kind))
        by_node = {node: {kind: set() for kind in kinds} for node in graph["nodes"]}
        for name, topic in graph["topics"].items():
            for kind in kinds:
                for endpoint in topic[kind]:
                    if endpoint["node"] == "/looker":
                        continue
                    self.assertIn(endpoint["node"], by_node, name)
                    self.assertTrue(name in GLOBAL or name.startswith(endpoint["node"].rsplit("/", 1)[0] + "/"), name)
                    self.assertEqual(endpoint["hash"], idl_model.type_hash(STRUCTS[endpoint["type"]], STRUCTS), name)
                    by_node[endpoint["node"]][kind].add(name)
        self.assertEqual({node: {kind: set(topics) for kind, topics in kinds_of.items()} for node, kinds_of in graph["by_node"].items()}, by_node)
        for robot in ROBOTS:
            for name, (reliable, latched) in QOS.items():
                full = name if name.startswith("/") else f"/{robot}/{name}"
                for endpoint in (e for e in graph["topics"][full]["publishers"] if e["node"] != "/looker"):
                    self.assertEqual((endpoint["reliable"], endpoint["latched"]), (reliable, latched), full)

    def check_hashes_of_wheels(self, distribution, graph):
        """Those of the messages that rclpy itself has."""
        seen = 0
        for topic in graph["topics"].values():
            for endpoint in topic["publishers"] + topic["subscribers"]:
                package, _, name = endpoint["type"].split("/")
                description = ROOT / f".venv-{distribution}" / "share" / package / "msg" / f"{name}.json"
                if endpoint["node"] != "/looker" and description.exists():
                    hashes = {h["type_name"]: h["hash_string"] for h in json.loads(description.read_text())["type_hashes"]}
                    self.assertEqual(endpoint["hash"], hashes[endpoint["type"]])
                    seen += 1
        self.assertGreater(seen, 5)

    def check_robots_apart(self):
        instances = {}
        for robot in ROBOTS:
            status = self.rds("status", "--json", "--wait", 30, "--namespace", robot)
            self.assertEqual(status.returncode, 0, status.stdout + status.stderr)  # each service once, and active
            lacks = {s["service"]: s["transfer"] and s["transfer"]["lacking"] for s in json.loads(status.stdout)["services"]}
            self.assertEqual(lacks["rds-mapper"], 0)
            odometry = self.messages("rds/odometry", 3, "--namespace", robot)
            self.assertEqual({m["header"]["frame_id"] for m in odometry}, {f"{robot}/odom"})
            states = self.messages("rds/tracking_state", 3, "--namespace", robot)
            instances[robot] = {m["instance"] for m in states}
            self.assertEqual(len(instances[robot]), 1)
            frames = {t["header"]["frame_id"] for m in self.messages("tf", 10, "--namespace", robot) for t in m["transforms"]}
            self.assertEqual(frames, {f"{robot}/map", f"{robot}/odom"})
        self.assertNotEqual(instances["robot1"], instances["robot2"])
        checkpoints = {str(file.relative_to(self.folder)) for file in self.folder.rglob("*.db")}
        for robot in ROBOTS:
            self.assertIn(f"checkpoints/domain-{self.domain}/{robot}/tracker.db", checkpoints)

    def list_topics(self):
        """As rds tells them, once it has found all services: on a busy machine that takes a while."""
        for _ in range(10):
            topics = json.loads(self.rds("topic", "list", "--json", "--timeout", 2).stdout)
            if sum(t["publishers"] for t in topics if t["topic"].endswith("diagnostics")) == len(ROBOTS) * len(SERVICES):
                break
        return topics

    def two_robots(self, vendor, domain):
        self.domain = domain
        self.bus = ("--bus", vendor, "--domain", str(domain))
        for names in ROBOTS.values():
            for service in SERVICES:
                self.start(PROGRAMS / f"rds-{service}", *self.bus, *names)
        lookers = {distribution: self.look(distribution) for distribution in DISTRIBUTIONS}
        seen = {distribution: json.loads(looker.communicate()[0]) for distribution, looker in lookers.items()}
        listed = self.list_topics()
        for distribution, graph in seen.items():
            with self.subTest(f"{distribution} beside {vendor}"):
                self.check_graph(graph, listed)
                self.check_hashes_of_wheels(distribution, graph)
        for robot, distribution, habit in (("robot1", "jazzy", "best_effort"), ("robot2", "kilted", "compressed")):
            self.start(python_of(distribution), "-B", FOLDER / "ros_driver.py", habit, 120, "--ros-args", "-r", f"__ns:=/{robot}",
                       environment=self.ros_environment())
        self.check_robots_apart()

    def test_beside_fast_dds(self):
        self.two_robots("fastdds", 100 + os.getpid() % 40)

    def test_beside_cyclone_dds(self):
        self.two_robots("cyclonedds", 140 + os.getpid() % 40)


if __name__ == "__main__":
    unittest.main()
