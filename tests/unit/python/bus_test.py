# SPDX-License-Identifier: Apache-2.0
"""Other machines by name, where the network has no multicast."""

import os
import socket
import unittest

import tree  # noqa: F401

import rds_map  # noqa: E402

DOMAIN = 170 + os.getpid() % 60
FIRST_PORT = 7410 + 250 * DOMAIN  # where a domain's first participant hears of others (RTPS 9.6.1.1)


class Peers(unittest.TestCase):
    def test_hear_of_a_participant(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
            peer.bind(("127.0.0.2", FIRST_PORT))
            peer.settimeout(30)
            bus = rds_map.Bus(DOMAIN, peers="localhost,127.0.0.2")  # noqa: F841
            self.assertEqual(peer.recv(2000)[:4], b"RTPS")

    def test_a_name_that_nobody_has_is_refused_in_a_sentence(self):
        with self.assertRaisesRegex(ValueError, r"^peer 'no-such-host\.invalid': .+"):
            rds_map.Bus(DOMAIN, peers="127.0.0.1,no-such-host.invalid")


if __name__ == "__main__":
    unittest.main()
