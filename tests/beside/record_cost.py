#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""record_cost.py FOLDER_OF_PROGRAMS RECORDING VENDOR [PAIRS]: `rds record` of colour, depth and outputs beside a run at 30 Hz, with and without it in turns.

What was lost, the recorder's share of a core, the tracker's median.
"""

import pathlib
import re
import signal
import subprocess
import sys

from tracker_run import DOMAIN, Comparison, TrackerRun

RATE = "2.0"  # of a recording at 15 Hz
MOST_RATIO = 1.05


def cpu_s(pid):
    """Of a process that has ended, but was not waited for."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def with_record(programs, recording, vendor):
    """Times of the tracker's frames [ms], the recorder's share of a core."""
    with TrackerRun(programs, recording, vendor, RATE) as run:
        file = run.folder / "all.mcap"
        record = subprocess.Popen([programs / "rds", "record", file, "--bus", vendor, "--domain", DOMAIN, "--loopback"], stdout=subprocess.PIPE, text=True)
        try:
            run.wait_for_last_frame()
            record.send_signal(signal.SIGINT)
            said = record.stdout.read()
            took_s = cpu_s(record.pid)
        finally:
            record.kill()
            record.wait()
        times_ms = run.finish()
    pictures = int(re.search(r"camera/color/image_raw\s+(\d+) messages", said)[1])
    share = took_s / (pictures / 30)
    print(f"  {said.splitlines()[-1].rsplit('/', 1)[1]}, {pictures} pictures of each kind; {100 * share:.1f} % of a core", flush=True)
    assert " 0 dropped, 0 lost by the bus" in said, said
    return times_ms, share


def main():
    programs, recording, vendor = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    comparison = Comparison(0.5)
    for _ in range(int(sys.argv[4]) if len(sys.argv) > 4 else 4):
        with TrackerRun(programs, recording, vendor, RATE) as run:
            comparison.add("alone", run.finish())
        times_ms, share = with_record(programs, recording, vendor)
        comparison.add("beside", times_ms)
    assert comparison.ratio() <= MOST_RATIO, "the recorder costs the tracker time"


main()
