#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the semantic map over Zenoh with PyPI's eclipse-zenoh alone: zenoh_client.py DOMAIN SECONDS

On the machine where the services run with --bus zenoh. Prints a line of JSON for each full map; the last one comes at once.
"""
import json
import struct
import sys
import time

import zenoh
from zenoh.ext import HistoryConfig, RecoveryConfig, declare_advanced_subscriber


def text(data, at):
    """A CDR string and the offset after it."""
    (size,) = struct.unpack_from("<I", data, at)
    return data[at + 4:at + 3 + size].decode(), at + 4 + size


def on_map(sample):
    data = sample.payload.to_bytes()[4:]  # after the encapsulation header
    frame, at = text(data, 8)             # after the stamp
    kind, at = text(data, at + 1 + -(at + 1) % 4)
    at += -at % 8
    resolution, size = struct.unpack_from("<dI", data, at)
    octree = data[at + 12:at + 12 + size]
    print(json.dumps({"frame": frame, "kind": kind, "resolution": resolution, "bytes": len(octree), "sum": sum(octree)}), flush=True)


domain, seconds = int(sys.argv[1]), float(sys.argv[2])
settings = {"scouting": {"multicast": {"address": f"224.0.0.224:{7000 + domain}", "interface": "127.0.0.1"}},
            "listen": {"endpoints": ["tcp/127.0.0.1:0"]}}
with zenoh.open(zenoh.Config.from_json5(json.dumps(settings))) as session:
    subscriber = declare_advanced_subscriber(
        session, f"{domain}/rds/map/full/octomap_msgs::msg::dds_::Octomap_/*", on_map, recovery=RecoveryConfig(heartbeat=True),
        history=HistoryConfig(detect_late_publishers=True, max_samples=1), subscriber_detection=True)
    time.sleep(seconds)
