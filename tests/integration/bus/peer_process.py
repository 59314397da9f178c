# SPDX-License-Identifier: Apache-2.0
"""Processes that the tests of the bus start."""

import signal
import subprocess
import threading

VENDORS = ("fastdds", "cyclonedds")

class Peer:
    """A process whose output lines are collected as they come; it ends when its standard input closes."""

    def __init__(self, *command, environment=None):
        self.process = subprocess.Popen(list(map(str, command)), env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.lines = []
        self.more = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            with self.more:
                self.lines.append(line.strip())
                self.more.notify_all()

    def wait_for(self, condition, seconds=60):
        with self.more:
            return self.more.wait_for(lambda: condition(self.lines), seconds)

    def send(self, number):
        self.process.send_signal(number)

    def tell(self, lines):
        """Writes lines to its standard input."""
        for line in lines:
            self.process.stdin.write(f"{line}\n")
            self.process.stdin.flush()

    def lives(self):
        return self.process.poll() is None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.send(signal.SIGCONT)
        self.process.wait(30)
        self.process.stdout.close()
