# SPDX-License-Identifier: Apache-2.0
"""A secured domain on Zenoh against programs that are not ours, which no check of ours holds back: zenoh_secured_test.py PATH_OF_bus_peer
PATH_OF_rds PYTHON

PYTHON has the packages of zenoh_requirements.txt; skips without.
"""

import itertools
import json
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import peer_process

PYTHON = sys.argv.pop(3)
RDS = sys.argv.pop(2)
PEER = sys.argv.pop(1)
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parents[2] / "cmake"))
import idl_model  # noqa: E402

STRUCTS = idl_model.load([FOLDER.parents[2] / "idl" / "ros2", FOLDER.parents[2] / "idl"])
DOMAINS = itertools.count(10 + os.getpid() % 150)
SECONDS = 4


def key(domain, topic, ros_name):
    struct_ = STRUCTS[ros_name]
    return f"{domain}/{topic}/{struct_.dds_name}/{idl_model.type_hash(struct_, STRUCTS)}"


def a_command():
    """CDR of a rds_msgs/msg/Command: pause, to the tracker."""
    def text(value):
        return struct.pack("<I", len(value) + 1) + value.encode() + b"\0"
    body = struct.pack("<iI", 0, 0) + text("")
    body += bytes(-len(body) % 8) + struct.pack("<Q", 7)
    for value in ("rds-tracker", "pause", ""):
        body += bytes(-len(body) % 4) + text(value)
    return (b"\0\1\0\0" + body).hex()


def tls(folder, identity):
    return {"root_ca_certificate": f"{folder}/ca.pem", "enable_mtls": True, "verify_name_on_connect": False,
            "listen_certificate": f"{folder}/{identity}/cert.pem", "listen_private_key": f"{folder}/{identity}/key.pem",
            "connect_certificate": f"{folder}/{identity}/cert.pem", "connect_private_key": f"{folder}/{identity}/key.pem"}


def config(domain, folder=None, identity=None, **more):
    """A peer on this machine, as ours are; with a certificate if there is a folder."""
    link = "tls" if folder else "tcp"
    settings = {"listen": {"endpoints": [f"{link}/127.0.0.1:0"]},
                "scouting": {"multicast": {"address": f"224.0.0.224:{7000 + domain}", "interface": "127.0.0.1"}}} | more
    if folder:
        settings["transport"] = {"link": {"tls": tls(folder, identity)}}
    return settings


class Intruder:
    def __init__(self, domain, settings, put=None, payload="", listen="**", seconds=SECONDS):
        todo = {"config": settings, "put": put, "payload": payload, "listen": listen, "domain": domain, "seconds": seconds}
        self.process = subprocess.Popen([PYTHON, "-B", FOLDER / "zenoh_intruder.py", json.dumps(todo)], stdout=subprocess.PIPE, text=True)

    def report(self):
        output, _ = self.process.communicate(timeout=90)
        return json.loads(output)


def can_import(*modules):
    command = [PYTHON, "-c", "import " + ", ".join(modules)]
    return os.path.exists(PYTHON) and subprocess.run(command, capture_output=True, check=False).returncode == 0


@unittest.skipUnless(can_import("zenoh"), "no Python packages of zenoh_requirements.txt (tools/setup.sh --ros)")
class Secured(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder, cls.foreign = (f"{cls.place.name}/{name}" for name in ("secured", "foreign"))
        for folder in (cls.folder, cls.foreign):
            subprocess.run([RDS, "secure", "init", folder, "--camera-topics", "picture", "number"], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def setUp(self):
        self.domain = next(DOMAINS)
        self.command = key(self.domain, "rds/command", "rds_msgs/msg/Command")

    def service(self, environment=None):
        """Hears the commands as the tracker would."""
        service = peer_process.Peer(RDS, "topic", "echo", "rds/command", "--bus", "zenoh", "--domain", self.domain, "--secure", self.folder, "--identity",
                                    "tracker", *([] if environment else ["--loopback"]), "--timeout", 60, environment=environment)
        self.addCleanup(service.process.kill)
        return service

    def commands_heard(self, settings, environment=None):
        """How many commands the tracker heard of one with these settings; and what that one reports."""
        with self.service(environment) as service:
            time.sleep(1.5)
            report = Intruder(self.domain, settings, put=self.command, payload=a_command()).report()
            heard = sum("pause" in line for line in service.lines)
            service.send(signal.SIGTERM)
        return heard, report

    def test_an_operator_commands(self):
        heard, report = self.commands_heard(config(self.domain, self.folder, "operator"))
        self.assertGreater(heard, 0)
        self.assertGreater(report["tokens"], 0)

    def test_a_service_does_not_command(self):
        for identity in ("mapper", "reader", "camera"):
            with self.subTest(identity):
                heard, report = self.commands_heard(config(self.domain, self.folder, identity))
                self.assertGreater(report["tokens"], 0, "it is there")
                self.assertEqual(heard, 0)

    def test_a_stranger_does_nothing(self):
        foreign = config(self.domain, self.foreign, "operator")
        plain = config(self.domain)
        half = config(self.domain, self.folder, "operator")  # encrypted, but without a certificate of its own
        half["transport"]["link"]["tls"] = {"root_ca_certificate": f"{self.folder}/ca.pem", "verify_name_on_connect": False}
        half["listen"]["endpoints"] = []
        for name, settings in (("no certificate", plain), ("another authority's", foreign), ("encrypted only", half)):
            with self.subTest(name):
                heard, report = self.commands_heard(settings)
                self.assertEqual(heard, 0)
                self.assertEqual((report["heard"], report["tokens"]), (0, 0), report)

    def test_only_who_may_reads(self):
        with peer_process.Peer(PEER, "--secure", self.folder, "camera", "talker", "zenoh", self.domain):
            pictures = key(self.domain, "picture", "sensor_msgs/msg/Image")
            readers = {name: Intruder(self.domain, config(self.domain, self.folder, name), listen=pictures) for name in ("tracker", "reader")}
            heard = {name: reader.report()["heard"] for name, reader in readers.items()}
        self.assertGreater(heard["tracker"], 0)
        self.assertEqual(heard["reader"], 0)

    def test_ours_hear_each_other_late_joiners_too(self):
        secured = ("--secure", self.folder)
        with peer_process.Peer(PEER, *secured, "camera", "keeper", "zenoh", self.domain, 30):
            time.sleep(2)
            with peer_process.Peer(PEER, *secured, "tracker", "late", "zenoh", self.domain) as reader:
                self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "29"), reader.lines)
                self.assertEqual(reader.lines, [str(i) for i in range(30)])

    def test_a_router_passes_on_what_each_may(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        dial = {"mode": "client", "connect": {"endpoints": [f"tls/127.0.0.1:{port}"]}, "scouting": {"multicast": {"enabled": False}}}
        over = pathlib.Path(self.place.name) / "dial.json5"
        over.write_text(json.dumps(dial | {"listen": {"endpoints": []}}))
        with peer_process.Peer(RDS, "router", "--listen", f"127.0.0.1:{port}", "--secure", self.folder) as router:
            self.addCleanup(router.process.kill)
            time.sleep(1)
            for identity, foreign, passes in (("operator", False, True), ("mapper", False, False), ("operator", True, False)):
                with self.subTest(identity, foreign=foreign):
                    settings = config(self.domain, self.foreign if foreign else self.folder, identity, **dial)
                    settings.pop("listen")
                    heard, report = self.commands_heard(settings, os.environ | {"ZENOH_CONFIG": str(over)})
                    self.assertEqual(heard > 0, passes, report)
                    self.assertEqual(report["opened"], not foreign, report)
                    self.assertTrue(router.lives(), router.process.returncode)
            router.send(signal.SIGTERM)

    def test_a_certificate_of_another_authority_is_one_sentence_on_each_side(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        said = pathlib.Path(self.place.name) / "said"
        with said.open("w") as stderr:
            router = subprocess.Popen([RDS, "router", "--listen", f"127.0.0.1:{port}", "--secure", self.folder], stderr=stderr)
        self.addCleanup(router.kill)
        time.sleep(1)
        command = [RDS, "topic", "list", "--bus", "zenoh", "--domain", str(self.domain), "--secure", self.foreign, "--peers", f"tls/127.0.0.1:{port}"]
        refused = subprocess.run(command, capture_output=True, text=True, check=False)
        router.terminate()
        self.assertEqual((router.wait(20), refused.returncode), (0, 1))
        self.assertEqual(refused.stderr.count("its certificate is of another authority"), 1, refused.stderr)
        self.assertEqual(said.read_text().count("takes our certificate for one of another authority"), 1, said.read_text())

    def test_what_is_wrong_is_one_sentence(self):
        def refusal(*arguments, secured=self.folder):
            command = [RDS, "topic", "list", "--bus", "zenoh", "--domain", str(self.domain), "--secure", secured, *arguments]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            return result.stderr
        self.assertIn("expected tls/", refusal("--peers", "tcp/127.0.0.1:7447"))
        with tempfile.TemporaryDirectory() as place:
            subprocess.run(["cp", "-r", self.folder, f"{place}/old"], check=True)
            os.remove(f"{place}/old/access.p7s")
            self.assertIn("access.p7s: no such file", refusal(secured=f"{place}/old"))
            subprocess.run(["cp", f"{self.foreign}/access.p7s", f"{place}/old/access.p7s"], check=True)
            self.assertIn("access.p7s: is damaged or was signed by another authority", refusal(secured=f"{place}/old"))


if __name__ == "__main__":
    unittest.main()
