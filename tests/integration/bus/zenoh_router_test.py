# SPDX-License-Identifier: Apache-2.0
"""Programs that meet through a router alone, as machines do that do not reach each other: zenoh_router_test.py PATH_OF_bus_peer PATH_OF_rds"""

import functools
import itertools
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import peer_process
import slow_link

RDS = sys.argv.pop(2)
PEER = sys.argv.pop(1)
DOMAINS = itertools.count(10 + os.getpid() % 180)


def free_port():
    with socket.socket() as socket_:
        socket_.bind(("127.0.0.1", 0))
        return socket_.getsockname()[1]


def init_syn(version):
    """The first message of a peer of Zenoh, with its length before it."""
    message = bytes([1, version, 0x31]) + bytes(range(1, 5))  # InitSyn; a peer, with an identifier of 4 bytes
    return len(message).to_bytes(2, "little") + message


class Router(unittest.TestCase):
    """Each peer is a client of its router: it dials out, and nobody can dial it. Unless a test says otherwise."""

    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.domain = next(DOMAINS)
        self.port = free_port()
        self.peer = self.peers_of(self.port)

    def client(self, port):
        """The environment of a client of the router at this port."""
        settings = pathlib.Path(self.place.name) / f"{port}.json5"
        settings.write_text(json.dumps({"mode": "client", "connect": {"endpoints": [f"tcp/127.0.0.1:{port}"]}, "listen": {"endpoints": []},
                                        "scouting": {"multicast": {"enabled": False}}}))
        return os.environ | {"ZENOH_CONFIG": str(settings)}

    def peers_of(self, port):
        return functools.partial(peer_process.Peer, PEER, environment=self.client(port))

    def router(self, port=None, *options):
        router = peer_process.Peer(RDS, "router", "--listen", f"127.0.0.1:{port or self.port}", *options)
        self.addCleanup(router.process.kill)
        return router

    def end(self, router):
        router.send(signal.SIGTERM)
        self.assertEqual(router.process.wait(10), 0)
        router.process.stdin.close()
        router.process.stdout.close()

    def test_two_that_dial_it_hear_each_other(self):
        router = self.router()
        with self.peer("keeper", "zenoh", self.domain, 30) as keeper, self.peer("late", "zenoh", self.domain) as reader:
            self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "29"), reader.lines)
            self.assertEqual(reader.lines, [str(i) for i in range(30)])
            self.assertTrue(keeper.lives())
        self.end(router)

    def test_pictures_come_whole(self):
        router = self.router()
        with self.peer("reader", "zenoh", self.domain) as reader, self.peer("writer", "zenoh", self.domain, 1, 60) as writer:
            self.assertTrue(writer.wait_for(lambda lines: len(lines) == 1))
            self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "59"), reader.lines[-3:])
            self.assertEqual(reader.lines, sorted(reader.lines, key=int))
        self.end(router)

    def test_two_routers_in_a_row(self):
        second = free_port()
        routers = [self.router(), self.router(second, "--connect", f"127.0.0.1:{self.port}")]
        with self.peer("keeper", "zenoh", self.domain, 30) as _, self.peers_of(second)("late", "zenoh", self.domain) as reader:
            self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "29"), reader.lines)
            self.assertEqual(reader.lines, [str(i) for i in range(30)])
        for router in routers:
            self.end(router)

    def test_what_comes_while_a_reader_asks_for_what_was_before_waits(self):
        second, far = free_port(), free_port()
        routers = [self.router(), self.router(second, "--connect", f"127.0.0.1:{far}")]
        with self.peers_of(second)("late", "zenoh", self.domain) as reader, self.peer("keeper", "zenoh", self.domain, 80) as _:
            time.sleep(1)
            with slow_link.SlowLink(far, self.port, .2):  # two messages for each step there and back
                self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "79"), reader.lines)
                self.assertEqual(reader.lines, [str(i) for i in range(80)])
                for router in routers:
                    self.end(router)

    def test_killed_and_started_again(self):
        with self.router() as router, self.peer("keeper", "zenoh", self.domain, 120) as _, self.peer("late", "zenoh", self.domain) as first:
            self.assertTrue(first.wait_for(lambda lines: len(lines) >= 20))
            router.send(signal.SIGKILL)
            router.process.wait(10)
            time.sleep(1)
            with self.peer("late", "zenoh", self.domain) as second:  # while there is none
                time.sleep(3)
                again = self.router()
                for reader in (first, second):
                    self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "119"), reader.lines[-3:])
                with self.peer("late", "zenoh", self.domain) as third:  # after all
                    self.assertTrue(third.wait_for(lambda lines: lines and lines[-1] == "119"), third.lines[-3:])
                    time.sleep(1)
                    self.assertEqual(third.lines, [str(i) for i in range(20, 120)])
                self.assertEqual(first.lines, [str(i) for i in range(120)])
                # it hears from the moment on when it is connected again, and what was kept then: a hundred
                self.assertEqual(second.lines, [str(i) for i in range(int(second.lines[0]), 120)])
                self.assertLessEqual(int(second.lines[0]), 20)
                self.end(again)

    def test_peers_that_also_reach_each_other_hear_all_once(self):
        peers = functools.partial(peer_process.Peer, PEER, "--peers", f"tcp/127.0.0.1:{self.port}")
        with self.router() as router, peers("keeper", "zenoh", self.domain, 80) as _, peers("late", "zenoh", self.domain) as reader:
            self.assertTrue(reader.wait_for(lambda lines: len(lines) >= 20))
            router.send(signal.SIGKILL)
            self.assertTrue(reader.wait_for(lambda lines: lines and lines[-1] == "79"), reader.lines[-3:])
            self.assertEqual(reader.lines, [str(i) for i in range(80)])

    def asked_in_vain(self, environment=None, *options):
        """What a tool says that reaches nobody."""
        command = [RDS, "topic", "list", "--bus", "zenoh", "--domain", str(self.domain), "--timeout", "1", *options]
        result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=30)
        self.assertEqual(result.returncode, 1, result.stderr)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 2, lines)
        self.assertIn(f"tcp/127.0.0.1:{self.port} is not reached: Connection refused", lines[0])
        return lines[1]

    def test_no_router_is_one_sentence(self):
        self.assertIn("nobody was heard of", self.asked_in_vain(None, "--peers", f"tcp/127.0.0.1:{self.port}"))
        self.assertIn("Unable to connect to any of", self.asked_in_vain(self.client(self.port)))

    def test_a_router_that_comes_is_told(self):
        said = pathlib.Path(self.place.name) / "said"
        with said.open("w") as stderr:
            waiting = subprocess.Popen([RDS, "topic", "echo", "number", "--bus", "zenoh", "--domain", str(self.domain), "--peers",
                                        f"tcp/127.0.0.1:{self.port}"], stdout=subprocess.DEVNULL, stderr=stderr)
        time.sleep(1.5)
        router = self.router()
        time.sleep(4)
        waiting.terminate()
        waiting.wait(20)
        self.end(router)
        lines = said.read_text().splitlines()
        self.assertEqual([line for line in lines if line.endswith("is reached")], [f"rds: tcp/127.0.0.1:{self.port} is reached"], lines)
        self.assertEqual(sum("is not reached" in line for line in lines), 1, lines)

    def test_a_foreign_version_is_one_sentence(self):
        said = pathlib.Path(self.place.name) / "said"
        with said.open("w") as stderr:
            router = subprocess.Popen([RDS, "router", "--listen", f"127.0.0.1:{self.port}"], stderr=stderr)
        for _ in range(3):
            time.sleep(1)
            with socket.create_connection(("127.0.0.1", self.port)) as stranger:
                stranger.sendall(init_syn(version=8))
                self.assertEqual(len(stranger.recv(1)), 1)  # a message that closes
        router.terminate()
        self.assertEqual(router.wait(20), 0)
        self.assertEqual(sum("another version of Zenoh's protocol" in line for line in said.read_text().splitlines()), 1, said.read_text())

    def test_a_port_that_is_taken_is_one_sentence(self):
        router = self.router()
        time.sleep(1)
        result = subprocess.run([RDS, "router", "--listen", f"127.0.0.1:{self.port}"], capture_output=True, text=True, check=False, timeout=30)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.end(router)


if __name__ == "__main__":
    unittest.main()
