#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints how many occupied voxels of each label the map has, each time it has changed: zenoh_labels.py idl/rds_msgs/msg [DOMAIN]

On the machine where the services run with --bus zenoh. Needs nothing of ours but the definition of one message, and
pip install eclipse-zenoh==1.10.2 rosbags
"""
import json
import pathlib
import sys

import numpy as np
import zenoh
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from zenoh.ext import HistoryConfig, declare_advanced_subscriber

POINTS, INFO = "sensor_msgs/msg/PointCloud2", "rds_msgs/msg/MapInfo"

domain = int(sys.argv[2]) if len(sys.argv) > 2 else 0
types = get_typestore(Stores.ROS2_JAZZY)
types.register(get_types_from_msg(pathlib.Path(sys.argv[1], "MapInfo.msg").read_text(encoding="utf-8"), INFO))


def key(topic, kind):
    """Where rmw_zenoh's form puts a topic."""
    return f"{topic}/{kind.replace('/', '::').replace('msg::', 'msg::dds_::')}_/{types.hash_rihs01(kind)}"


def follow(session, topic, kind):
    """The newest message, kept for who comes late."""
    last = HistoryConfig(detect_late_publishers=True, max_samples=1)
    return declare_advanced_subscriber(session, f"{domain}/{key(topic, kind)}", zenoh.handlers.RingChannel(1), history=last)


settings = {"scouting": {"multicast": {"address": f"224.0.0.224:{7000 + domain}", "interface": "127.0.0.1"}},
            "listen": {"endpoints": ["tcp/127.0.0.1:0"]}}
with zenoh.open(zenoh.Config.from_json5(json.dumps(settings))) as session:
    infos, clouds = follow(session, "rds/map/info", INFO), follow(session, "rds/map/points", POINTS)
    # The mapper writes the points while a token says that somebody reads them.
    token = session.liveliness().declare_token(f"@ros2_lv/{domain}/{session.zid()}/0/1/MS/%/%/labels/{key('%rds%map%points', POINTS)}/:1:,1:,:,:,,")
    info = infos.recv()
    for sample in clouds:
        info = infos.try_recv() or info
        names = types.deserialize_cdr(info.payload.to_bytes(), INFO).labels
        cloud = types.deserialize_cdr(sample.payload.to_bytes(), POINTS)
        rows = cloud.data.view(np.uint32).reshape(cloud.width, 5)  # x, y, z, rgb, label
        labels, counts = np.unique(rows[:, 4], return_counts=True)
        print(json.dumps({names[label] or "no object": int(count) for label, count in zip(labels, counts)}), flush=True)
