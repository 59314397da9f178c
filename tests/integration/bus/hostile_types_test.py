# SPDX-License-Identifier: Apache-2.0
"""Type descriptions that no library should be made to read: hostile_types_test.py PATH_OF_bus_peer"""

import functools
import itertools
import os
import struct
import sys
import unittest

import peer_process
import rtps_stranger
from peer_process import VENDORS

Peer = functools.partial(peer_process.Peer, sys.argv.pop(1))
DOMAINS = itertools.count(10 + os.getpid() % 180)
IMAGE = "sensor_msgs::msg::dds_::Image_"


def sized(data):
    return struct.pack("<I", len(data)) + data


def nested_sequences(levels, offset):
    """The identifier of a sequence of sequences of ... bytes, as XCDR2 encodes it at this offset."""
    assert offset % 2 == 0
    even, odd = b"\x80\xf3\0\0\1", b"\x80\xf3\0\0\0\1"  # kind, equivalence, (padding,) flags, bound
    return even + odd * (levels - 1) + b"\x02"


def lookup_request(levels):
    """A request of the type lookup service for one such type."""
    header = bytes(16) + struct.pack("<iI", 0, 1) + sized(b"\0") + bytes(3)
    sequence = sized(struct.pack("<I", 1) + nested_sequences(levels, len(header) + 28))
    member = struct.pack("<II", 0x4C536065, len(sequence)) + sequence
    return b"\x00\x07\x00\x00" + header + sized(struct.pack("<I", 0x018252D3) + sized(member))


class HostileTypes(unittest.TestCase):
    def meet(self, vendor, hostile_act, served):
        domain = next(DOMAINS)
        stranger = rtps_stranger.Stranger(domain)
        self.addCleanup(stranger.close)
        with Peer("talker", vendor, domain) as talker, Peer("reader", vendor, domain) as reader:
            self.assertTrue(reader.wait_for(lambda lines: len(lines) >= 3))
            stranger.announce()
            self.assertTrue(stranger.hears(b"RTPS"), "the stranger is not taken for a participant")
            hostile_act(stranger)
            if served:
                self.assertTrue(stranger.hears(vendor.encode()), "the stranger's reader is not served")
            seen = len(reader.lines)
            self.assertTrue(reader.wait_for(lambda lines: len(lines) >= seen + 20))
            self.assertTrue(talker.lives() and reader.lives())

    def test_a_nested_lookup_request(self):
        for vendor in VENDORS:
            with self.subTest(vendor):
                self.meet(vendor, lambda stranger: stranger.publish(rtps_stranger.TYPE_REQUEST_WRITER, lookup_request(300_000)), False)

    def test_type_information_that_is_none(self):
        for vendor in VENDORS:
            with self.subTest(vendor):
                self.meet(vendor, lambda stranger: stranger.subscribe("rt/picture", IMAGE, b"\xff" * 64), True)


if __name__ == "__main__":
    unittest.main()
