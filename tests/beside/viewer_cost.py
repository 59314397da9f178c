#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""viewer_cost.py FOLDER_OF_PROGRAMS RECORDING VENDOR [PAIRS]: twenty clients of the viewer, five of them stopped for 30 s.

Runs at the recorded speed, with and without the viewer in turns: the other clients' rate before, meanwhile and after, the viewer's memory, the tracker's p99.
"""

import json
import pathlib
import signal
import statistics
import subprocess
import sys
import time

from tracker_run import Comparison, TrackerRun, free_port

CLIENTS, STOPPED, STOPPED_S = 20, 5, 30
MOST_MB = 300
MOST_RATIO = 1.05
CAMERA_HZ = 15  # of the recording
LEAST_SHARE = 0.98
PAGE_CLIENT = pathlib.Path(__file__).resolve().parents[1] / "viewer/page_client.py"


def peak_mb(run):
    """Of the viewer."""
    for pid in pathlib.Path(f"/proc/{run.process.pid}/task/{run.process.pid}/children").read_text().split():
        process = pathlib.Path(f"/proc/{pid}")
        if "rds-viewer" in (process / "cmdline").read_text():
            return int((process / "status").read_text().split("VmHWM:")[1].split()[0]) / 1e3
    raise AssertionError("no viewer")


def rates(clients, begin_s, end_s):
    """Frames of the camera a second, that each client had."""
    return [sum(begin_s <= t < end_s for t in client["trackedS"]) / (end_s - begin_s) for client in clients]


def with_viewer(programs, recording, vendor):
    """Times of the tracker's frames [ms], the slowest rate of another client meanwhile [1/s], the viewer's memory [MB]."""
    port = free_port()
    with TrackerRun(programs, recording, vendor, "1.0", f"--view={port}") as run:
        run.wait_for("the page: ")
        clients = [subprocess.Popen([sys.executable, "-B", PAGE_CLIENT, str(port)], stdout=subprocess.PIPE, text=True) for _ in range(CLIENTS)]
        try:
            run.wait_for("frame ")
            stopped_s = time.monotonic()
            for client in clients[:STOPPED]:
                client.send_signal(signal.SIGSTOP)
            time.sleep(STOPPED_S)
            for client in clients[:STOPPED]:
                client.send_signal(signal.SIGCONT)
            again_s = time.monotonic()
            run.wait_for_last_frame()
            end_s = time.monotonic()
            memory_mb = peak_mb(run)
            told = []
            for client in clients:
                client.send_signal(signal.SIGTERM)
                told.append(json.loads(client.stdout.read().removeprefix("ready\n")))
        finally:
            for client in clients:
                client.kill()
                client.wait()
        times_ms = run.finish()
    others = told[STOPPED:]
    first_s = min(t for client in others for t in client["trackedS"])
    parts = [statistics.median(rates(others, *part)) for part in ((first_s, stopped_s), (stopped_s, again_s), (again_s, end_s))]
    slowest = min(rates(others, stopped_s, again_s))
    print(f"  others' rate before {parts[0]:.1f}, meanwhile {parts[1]:.2f} (slowest {slowest:.2f}), after {parts[2]:.1f} frames/s; the viewer's peak {memory_mb:.0f} MB", flush=True)
    return times_ms, slowest, memory_mb


def main():
    programs, recording, vendor = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    comparison = Comparison(0.99)
    for _ in range(int(sys.argv[4]) if len(sys.argv) > 4 else 4):
        with TrackerRun(programs, recording, vendor, "1.0") as run:
            comparison.add("alone", run.finish())
        times_ms, slowest, memory_mb = with_viewer(programs, recording, vendor)
        comparison.add("beside", times_ms)
        assert memory_mb <= MOST_MB, "the viewer's memory"
        assert slowest >= LEAST_SHARE * CAMERA_HZ, "clients wait for others that are stopped"
    assert comparison.ratio() <= MOST_RATIO, "the viewer costs the tracker time"


main()
