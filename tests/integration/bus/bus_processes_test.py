# SPDX-License-Identifier: Apache-2.0
"""Processes on the bus that freeze, die and come back: bus_processes_test.py PATH_OF_bus_peer"""

import functools
import itertools
import json
import os
import signal
import sys
import unittest

import peer_process
from peer_process import VENDORS

Peer = functools.partial(peer_process.Peer, sys.argv.pop(1))
DOMAINS = itertools.count(10 + os.getpid() % 180)


class Processes(unittest.TestCase):
    def test_a_frozen_reader_delays_nobody_and_catches_up(self):
        for writer_vendor, reader_vendor in itertools.product(VENDORS, VENDORS):
            domain = next(DOMAINS)
            with self.subTest(f"{writer_vendor} to {reader_vendor}"), \
                 Peer("reader", reader_vendor, domain) as healthy, Peer("reader", reader_vendor, domain) as frozen, \
                 Peer("writer", writer_vendor, domain, 2, 150) as writer:
                self.assertTrue(frozen.wait_for(lambda lines: len(lines) >= 3))
                frozen.send(signal.SIGSTOP)
                self.assertTrue(writer.wait_for(lambda lines: len(lines) == 1))
                report = json.loads(writer.lines[0])
                self.assertEqual(report["refused"], 0)
                self.assertLess(report["write"]["slowest_ms"], 2000)  # a writer that waits for the reader takes for ever
                self.assertTrue(healthy.wait_for(lambda lines: lines and lines[-1] == "149"), healthy.lines[-3:])
                frozen.send(signal.SIGCONT)
                self.assertTrue(frozen.wait_for(lambda lines: lines[-1] == "149"), frozen.lines[-3:])

    def test_a_killed_reader_is_replaced(self):
        for writer_vendor, reader_vendor in itertools.product(VENDORS, VENDORS):
            domain = next(DOMAINS)
            with self.subTest(f"{writer_vendor} to {reader_vendor}"), Peer("writer", writer_vendor, domain, 1, 300) as writer:
                with Peer("reader", reader_vendor, domain) as first:
                    self.assertTrue(first.wait_for(lambda lines: len(lines) >= 3))
                    first.send(signal.SIGKILL)
                with Peer("reader", reader_vendor, domain) as second:
                    self.assertTrue(second.wait_for(lambda lines: len(lines) >= 3))
                    self.assertTrue(second.wait_for(lambda lines: lines[-1] == "299"))
                self.assertTrue(writer.wait_for(lambda lines: len(lines) == 1))
                self.assertEqual(json.loads(writer.lines[0])["refused"], 0)

    def test_thirty_participants_find_each_other(self):
        domain = next(DOMAINS)
        peers = []
        try:
            peers = [Peer("census", VENDORS[i % 2], domain, 30) for i in range(30)]
            for peer in peers:
                self.assertTrue(peer.wait_for(lambda lines: len(lines) == 1))
            seconds = sorted(json.loads(peer.lines[0])["seconds"] for peer in peers)
            print(f"thirty participants: median {seconds[15]:.1f} s, last {seconds[-1]:.1f} s", file=sys.stderr)
        finally:
            for peer in peers:
                peer.__exit__()


if __name__ == "__main__":
    unittest.main()
