#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""large_map.py FOLDER_OF_PROGRAMS FOLDER_FOR_PICTURES [VOXELS]: how a large map gets to the page, and how fast that is drawn.

Tells rds-viewer a floor of furnished rooms in the mapper's place, over DDS, and prints figures of the page in Chromium on one line of JSON.
A measurement, no test; needs the Python of .venv, and tools/setup.sh --viewer.
"""
import json
import math
import os
import pathlib
import socket
import subprocess
import sys
import time

import numpy as np
from cyclonedds.core import Policy, Qos
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parents[1] / "python"))
from rds_map import Bus, messages  # noqa: E402

DOMAIN = 89
ROOM = (100, 80, 50)  # voxels along, across and up
SIDE_M = 0.05
MIDDLE = 32768
TONES = np.array([[170, 160, 145], [70, 120, 170], [150, 100, 60], [110, 140, 100], [160, 90, 100]])  # by label
AT_ONCE = 50000  # voxels of a message
STEPS = 20  # changes as of a keyframe: what is within 1.5 m of a place
TIME = messages.Time(0, 0)


def box(low, high):
    """N×3: the surface of a box, or a plane where it is one voxel thick."""
    grid = np.stack(np.meshgrid(*[np.arange(a, b) for a, b in zip(low, high)], indexing="ij"), -1).reshape(-1, 3)
    return grid[((grid == low) | (grid == np.subtract(high, 1))).any(axis=1)]


def room(number):
    """Floor, two walls with doors, four pieces of furniture: N×3 voxels, N labels."""
    x, y, z = ROOM
    walls = [box((0, 0, 1), (x, 1, z)), box((0, 0, 1), (1, y, z))]
    walls = [wall[(np.abs(wall[:, 0] + wall[:, 1] - 45) > 9) | (wall[:, 2] > 40)] for wall in walls]
    rng = np.random.default_rng(number)
    pieces = [box((at := (12 + 22 * k, int(rng.integers(12, 55)), 1)), np.add(at, (14, 18, int(rng.integers(10, 35))))) for k in range(4)]
    parts = [box((0, 0, 0), (x, y, 1)), *walls, *pieces]
    return np.concatenate(parts), np.repeat([0, 0, 0, 1, 2, 3, 4], [len(part) for part in parts])


def floor(voxels):
    """Keys N×3, labels N, of at least so many voxels, room by room."""
    found, rooms = [], 0
    across = math.ceil(math.sqrt(voxels / len(room(0)[0])))
    while sum(len(labels) for _, labels in found) < voxels:
        keys, labels = room(rooms)
        found.append((keys + MIDDLE + [ROOM[0] * (rooms % across), ROOM[1] * (rooms // across), -24], labels))
        rooms += 1
    return np.concatenate([keys for keys, _ in found]), np.concatenate([labels for _, labels in found])


class Mapper:
    """Stands for rds-mapper."""

    def __init__(self):
        self.bus = Bus(DOMAIN, loopback=True)
        self.info = self.writer("rds/map/info", messages.MapInfo)
        self.delta = self.writer("rds/map/delta", messages.OctreeDelta)
        self.revision = 0

    def writer(self, name, message):
        qos = Qos(Policy.Reliability.Reliable(duration(seconds=10)), Policy.Durability.TransientLocal, Policy.History.KeepAll,
                  Policy.DataRepresentation(use_cdrv0_representation=True))
        return DataWriter(self.bus._participant, Topic(self.bus._participant, "rt/" + name, message, qos=qos), qos=qos)

    def tell_labels(self, names):
        header = messages.Header(TIME, "map")
        self.info.write(messages.MapInfo(header, 1, False, 1, 1, 0, SIDE_M, 0, 0, [0.0] * 3, [0.0] * 3, names, [], [], 0, 0, 0))

    def tell(self, keys, labels, seed):
        colors = TONES[labels] + np.random.default_rng(seed).integers(-15, 15, (len(keys), 1))
        self.revision += 1
        self.delta.write(messages.OctreeDelta(messages.Header(TIME, "map"), 1, 1, 1, self.revision - 1, self.revision, self.revision, SIDE_M,
                                              keys.ravel().tolist(), [2.0] * len(keys), labels.tolist(), colors.ravel().tolist(), []))


class Page:
    def __init__(self, url, pictures):
        self.process = subprocess.Popen(["node", "page.mjs", url, pictures], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=FOLDER)
        self.first_picture_ms = json.loads(self.process.stdout.readline())["firstPictureMs"]

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())


def seconds_until_shown(page, revision):
    began = time.monotonic()
    page.ask(f"eval new Promise(shown => {{ const look = () => rds.stats.revision >= {revision} && rds.stats.complete ? shown(1) : setTimeout(look, 5); look(); }})")
    return time.monotonic() - began


def measure(programs, pictures, voxels):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    viewer = subprocess.Popen([programs / "rds-viewer", "--domain", str(DOMAIN), "--loopback", "--listen", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        mapper = Mapper()
        while not mapper.delta.get_matched_subscriptions():
            time.sleep(0.2)
        keys, labels = floor(voxels)
        mapper.tell_labels(["", "chair", "table", "sofa", "bed"])
        for at in range(0, len(keys), AT_ONCE):
            mapper.tell(keys[at:at + AT_ONCE], labels[at:at + AT_ONCE], at)
        time.sleep(10)  # until the viewer has it
        page = Page(f"http://127.0.0.1:{port}/", pictures)
        told = {"first_picture_s": page.first_picture_ms / 1e3, "whole_map_s": page.first_picture_ms / 1e3 + seconds_until_shown(page, mapper.revision)}
        told["voxels"] = page.ask("stats")["voxels"]
        page.ask("shot large 1280 720")
        told["pictures_per_s"] = {"whole": page.ask("turn 10")}
        page.ask("eval rds.view.orbit.fromText('7,6,0,6,1.1,-2')")
        told["pictures_per_s"]["in a room"] = page.ask("turn 10")
        page.ask("shot large_room 1280 720")
        waits = []
        for step in range(STEPS):
            near = np.linalg.norm(keys - keys[len(keys) // STEPS * step], axis=1) < 1.5 / SIDE_M
            mapper.tell(keys[near], labels[near], step)
            waits.append(seconds_until_shown(page, mapper.revision))
        told["change_s"] = {"median": float(np.median(waits)), "most": max(waits)}
        told["viewer_mb"] = int(pathlib.Path(f"/proc/{viewer.pid}/status").read_text().split("VmHWM:")[1].split()[0]) / 1e3
        told["errors"] = page.ask("stats")["errors"]
        page.process.stdin.close()
        return told
    finally:
        viewer.terminate()


if __name__ == "__main__":
    os.makedirs(sys.argv[2], exist_ok=True)
    print(json.dumps(measure(pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 1_000_000)))
