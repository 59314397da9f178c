# SPDX-License-Identifier: Apache-2.0
"""page_client.py PORT: takes what the page takes, and prints on SIGTERM what it had as JSON: frames of each kind, when those of the camera came [s], voxels, sum of their keys.

Stands for a program of another machine, so it takes the processor when nobody else wants it.
"""

import array
import json
import os
import signal
import struct
import sys
import time

from web_socket import WebSocket

MAP, TRACKING = 2, 3


class Map:
    def __init__(self):
        self.chunks = {}
        self.generation = None
        self.revision = 0
        self.complete = False

    def apply(self, frame):
        generation, _, self.revision, count, complete = struct.unpack_from("<QdQII", frame, 8)
        if generation != self.generation:
            self.chunks.clear()
        self.generation, self.complete = generation, bool(complete)
        at = 40
        for _ in range(count):
            x, y, z, _, voxels, _ = struct.unpack_from("<HHHHII", frame, at)
            self.chunks[x, y, z] = frame[at + 16 : at + 16 + 8 * voxels]
            at += 16 + 8 * voxels
        assert at == len(frame)

    def figures(self):
        voxels = key_sum = 0
        for at, chunk in self.chunks.items():
            places = array.array("H", chunk)[::4]
            voxels += len(places)
            key_sum += sum((p & 31) + (p >> 5 & 31) + (p >> 10) for p in places) + 32 * sum(at) * len(places)
        return {"voxels": voxels, "keySum": key_sum, "revision": self.revision, "complete": self.complete}


def main():
    os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
    page = WebSocket(int(sys.argv[1]))
    page.send('{"picture": true}')
    kinds = {}
    tracked_s = []
    shown = Map()

    def end(*_):
        print(json.dumps({"kinds": kinds, "trackedS": tracked_s, **shown.figures()}), flush=True)
        sys.exit(0)

    signal.signal(signal.SIGTERM, end)
    print("ready", flush=True)
    while True:
        frame = page.receive()
        assert frame[:3] == b"RV\x01", frame[:8]
        kinds[frame[3]] = kinds.get(frame[3], 0) + 1
        if frame[3] == MAP:
            shown.apply(frame)
        elif frame[3] == TRACKING:
            tracked_s.append(time.monotonic())


main()
