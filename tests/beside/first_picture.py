#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""first_picture.py FOLDER_OF_PROGRAMS RECORDING [TIMES]: how soon the page shows the map of a run that is under way, on both vendors.

Prints medians in ms: until the page asks for the map, has it, has its files, and shows it; and how long of this WebGL's beginning and the drawing take, by the
processor in a machine without a graphics card. Fails where the median is above 1 s. Needs tools/setup.sh --viewer.
"""
import json
import pathlib
import statistics
import subprocess
import sys

from tracker_run import TrackerRun, free_port

OPENING = pathlib.Path(__file__).resolve().parents[1] / "viewer/opening.mjs"
PARTS = {"times": ("asked", "connected", "map", "files", "shown"), "waits": ("context", "draw")}
MOST_MS = 1000


def openings(programs, recording, vendor, times):
    port = free_port()
    with TrackerRun(programs, recording, vendor, "1.0", f"--view={port}", "--view-keep") as run:
        run.wait_for("frame ")
        command = ["node", OPENING, f"http://127.0.0.1:{port}/", str(times)]
        said = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, cwd=OPENING.parent).stdout
        return [json.loads(line) for line in said.splitlines()]


def main():
    programs, recording = pathlib.Path(sys.argv[1]), sys.argv[2]
    times = int(sys.argv[3]) if len(sys.argv) > 3 else 9
    medians = {}
    for vendor in ("fastdds", "cyclonedds"):
        told = openings(programs, recording, vendor, times)
        medians[vendor] = {part: statistics.median(one[kind][part] for one in told) for kind, parts in PARTS.items() for part in parts}
        print(vendor, medians[vendor], "each:", [one["times"]["shown"] for one in told], flush=True)
    assert all(of["shown"] <= MOST_MS for of in medians.values()), "the first picture is late"


main()
