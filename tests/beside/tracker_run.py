# SPDX-License-Identifier: Apache-2.0
"""`rds run` at a recording's speed, and how long its tracker took for each frame."""

import contextlib
import csv
import pathlib
import re
import signal
import socket
import statistics
import subprocess
import tempfile
import time

DOMAIN = "87"
LIMIT_S = 120


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def quantile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


class TrackerRun:
    """A context: the run has begun to play within it; finish() waits for its end."""

    def __init__(self, programs, recording, vendor, rate, *options):
        self.stack = contextlib.ExitStack()
        self.folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.log = self.folder / "run.log"
        self.command = [programs / "rds", "run", recording, "--out", self.folder / "out", "--rate", rate, "--bus", vendor, "--domain", DOMAIN, *options]

    def __enter__(self):
        log = self.stack.enter_context(open(self.log, "w"))
        self.process = subprocess.Popen([str(part) for part in self.command], stdout=log, stderr=log)
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(60)
        self.stack.close()

    def wait_for(self, pattern):
        """Until the run says so."""
        end = time.monotonic() + LIMIT_S
        while not re.search(pattern, self.log.read_text()):
            if time.monotonic() > end or self.process.poll() is not None:
                raise AssertionError(f"no \"{pattern}\" in {self.log.read_text()}")
            time.sleep(0.02)

    def wait_for_last_frame(self):
        self.wait_for(r"frame (\d+)/\1 ")

    def finish(self):
        """Times of the tracker's frames [ms]."""
        if self.process.wait(180) != 0:
            raise AssertionError(self.log.read_text())
        with open(self.folder / "out/frames.csv") as file:
            return [float(row["total_ms"]) for row in csv.DictReader(file)]


class Comparison:
    """Times without and with somebody beside, of runs that took turns."""

    def __init__(self, share):
        self.share = share
        self.of = {"alone": [], "beside": []}

    def add(self, kind, times_ms):
        told = quantile(times_ms, self.share)
        self.of[kind].append(told)
        print(f"  {kind}: {len(times_ms)} frames, median {statistics.median(times_ms):.2f} ms, p99 {quantile(times_ms, 0.99):.2f} ms", flush=True)

    def ratio(self):
        alone, beside = (statistics.median(self.of[kind]) for kind in ("alone", "beside"))
        print(f"p{100 * self.share:.0f}: {alone:.2f} ms alone, {beside:.2f} ms beside, {beside / alone:.3f} x", flush=True)
        return beside / alone
