# SPDX-License-Identifier: Apache-2.0
"""page_client.py PORT: takes what the page takes, and prints on SIGTERM what it had as JSON: frames of each kind, voxels, sum of their keys."""

import array
import json
import signal
import struct
import sys

from web_socket import WebSocket


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
            places = array.array("H", frame[at + 16 : at + 16 + 8 * voxels])[::4]
            self.chunks[x, y, z] = (voxels, sum((p & 31) + (p >> 5 & 31) + (p >> 10) for p in places) + 32 * (x + y + z) * voxels)
            at += 16 + 8 * voxels
        assert at == len(frame)

    def figures(self):
        return {"voxels": sum(c[0] for c in self.chunks.values()), "keySum": sum(c[1] for c in self.chunks.values()), "revision": self.revision, "complete": self.complete}


def main():
    page = WebSocket(int(sys.argv[1]))
    kinds = {}
    shown = Map()

    def end(*_):
        print(json.dumps({"kinds": kinds, **shown.figures()}), flush=True)
        sys.exit(0)

    signal.signal(signal.SIGTERM, end)
    print("ready", flush=True)
    while True:
        frame = page.receive()
        assert frame[:3] == b"RV\x01", frame[:8]
        kinds[frame[3]] = kinds.get(frame[3], 0) + 1
        if frame[3] == 2:
            shown.apply(frame)


main()
