# SPDX-License-Identifier: Apache-2.0
"""Somebody who comes late, or is joined late, made of PyPI's eclipse-zenoh as rmw_zenoh sets it up: zenoh_latched.py teller|late DOMAIN DEPTH

teller: publishes each line of its standard input as a std_msgs/String; late readers get the last DEPTH.
late: prints each that it gets, of those before it came the last DEPTH, until its standard input closes.
"""
import json
import struct
import sys
import time

import zenoh
from zenoh.ext import (CacheConfig, HistoryConfig, MissDetectionConfig, RecoveryConfig, declare_advanced_publisher,
                       declare_advanced_subscriber)

mode, domain, depth = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
# Jazzy's std_msgs/msg/String.json
KEY = f"{domain}/number/std_msgs::msg::dds_::String_/RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
settings = {"scouting": {"multicast": {"address": f"224.0.0.224:{7000 + domain}", "interface": "127.0.0.1"}},
            "listen": {"endpoints": ["tcp/127.0.0.1:0"]}, "timestamping": {"enabled": True}}


def tell(session):
    publisher = declare_advanced_publisher(session, KEY, cache=CacheConfig(max_samples=depth), publisher_detection=True,
                                           sample_miss_detection=MissDetectionConfig(sporadic_heartbeat=0.5))
    for number, line in enumerate(sys.stdin, 1):
        text = line.strip().encode() + b"\0"
        publisher.put(struct.pack("<4sI", b"\0\1", len(text)) + text,
                      attachment=struct.pack("<qqB16s", number, time.time_ns(), 16, b"teller"))


def hear(session):
    subscriber = declare_advanced_subscriber(
        session, KEY, lambda sample: print(sample.payload.to_bytes()[8:-1].decode(), flush=True), subscriber_detection=True,
        history=HistoryConfig(detect_late_publishers=True, max_samples=depth), recovery=RecoveryConfig(heartbeat=True))
    sys.stdin.read()
    subscriber.undeclare()


with zenoh.open(zenoh.Config.from_json5(json.dumps(settings))) as session:
    (tell if mode == "teller" else hear)(session)
