#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The viewer beside a run: viewer_test.py FOLDER_OF_PROGRAMS RECORDING FOLDER_FOR_PICTURES

Chromium shows the map, Foxglove's own library decodes every channel, twenty clients of which five are stopped have the same map in the end.
The first two need `tools/setup.sh --viewer`; they are skipped without.
"""

import contextlib
import hashlib
import json
import os
import pathlib
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

FOLDER = pathlib.Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path.insert(0, str(FOLDER))
from web_socket import Refused, WebSocket  # noqa: E402

PROGRAMS, RECORDING, PICTURES = pathlib.Path(sys.argv.pop(1)), sys.argv.pop(1), pathlib.Path(sys.argv.pop(1))
MODULES = FOLDER / "node_modules"
CLIENTS, STOPPED = 20, 5
FRAMES = int(os.environ.get("RDS_VIEWER_FRAMES", "120"))
SHORT = FRAMES // 2
DOMAIN = os.environ.get("RDS_VIEWER_DOMAIN", "88")
RECORDED = ["rds/odometry", "tf", "rds/map/grid", "rds/map/points", "rds/tracking_state"]
LIMIT_S = 120
MOST_MB = 300
HELLO, MAP = 1, 2  # kinds of frames


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def wait_for(condition, what, limit_s=LIMIT_S):
    end = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what} did not come in {limit_s} s")
        time.sleep(0.1)


class Child:
    """A process that is asked line by line."""

    def __init__(self, *command):
        self.process = subprocess.Popen([str(part) for part in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=FOLDER)

    def read(self):
        line = self.process.stdout.readline()
        return json.loads(line) if line.startswith("{") else line.strip()

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.read()

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()


class Viewer(unittest.TestCase):
    def setUp(self):
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)
        self.folder = pathlib.Path(self.stack.enter_context(tempfile.TemporaryDirectory()))
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}/"

    def child(self, *command):
        child = Child(*command)
        self.stack.callback(child.end)
        return child

    def start(self, name, *command, environment=None):
        log = open(self.folder / f"{name}.log", "w+")
        process = subprocess.Popen([str(part) for part in command], stdout=log, stderr=log, env={**os.environ, "RDS_MAPS_DIR": str(self.folder / "maps"), **(environment or {})})

        def end():
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
            log.close()

        self.stack.callback(end)
        return process

    def log(self, name):
        return (self.folder / f"{name}.log").read_text()

    def get(self, path, headers=None):
        request = urllib.request.Request(self.url + path, headers=headers or {})
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.read().decode()

    def need_node(self):
        chromium = os.environ.get("CHROMIUM") or shutil.which("chromium")
        if not shutil.which("node") or not chromium or not (MODULES / "playwright-core").exists():
            self.skipTest("no node, chromium or node_modules (tools/setup.sh --viewer)")

    # ---- a run

    def start_run(self, rate="max", vendor="fastdds", frames=FRAMES):
        out = self.folder / "out"
        run = self.start("run", PROGRAMS / "rds", "run", RECORDING, "--out", out, "--rate", rate, "--frames", frames, "--bus", vendor, "--domain", DOMAIN, f"--view={self.port}", "--view-keep")
        wait_for(lambda: "the page: " in self.log("run") or run.poll() is not None, "the page")
        self.assertIsNone(run.poll(), self.log("run"))
        return run, out

    def viewer_pid(self, run):
        children = pathlib.Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
        return next(pid for pid in children if "rds-viewer" in pathlib.Path(f"/proc/{pid}/cmdline").read_text())

    def resident_mb(self, pid):
        return int(next(line for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines() if line.startswith("VmHWM")).split()[1]) / 1e3

    def map_info(self, out):
        lines = subprocess.run([PROGRAMS / "rds", "map", "info", "--map", out], capture_output=True, text=True, check=True).stdout.splitlines()
        return {name: value.strip() for name, value in (line.split(maxsplit=1) for line in lines)}

    def wait_for_results(self):
        wait_for(lambda: "the page stays" in self.log("run"), "the end of the run: " + self.log("run"), 3 * LIMIT_S)

    def test_clients_of_which_some_are_stopped(self):
        run, out = self.start_run()
        clients = [self.child(sys.executable, "-B", FOLDER / "page_client.py", self.port) for _ in range(CLIENTS)]
        for client in clients:
            self.assertEqual(client.read(), "ready")
        for client in clients[:STOPPED]:
            client.process.send_signal(signal.SIGSTOP)
        self.wait_for_results()
        info = self.map_info(out)
        expected = (int(info["occupied_voxels"]), int(info["occupied_key_sum"]))
        for client in clients[:STOPPED]:
            client.process.send_signal(signal.SIGCONT)
        time.sleep(3)
        told = []
        for client in clients:
            client.process.send_signal(signal.SIGTERM)
            told.append(client.read())
        for figures in told:
            self.assertEqual((figures["voxels"], figures["keySum"]), expected)
        frames = [figures["kinds"].get("3", 0) for figures in told]
        print(f"frames of the camera that each client had, of {FRAMES}: {frames}", flush=True)
        mean = [sum(part) / len(part) for part in (frames[:STOPPED], frames[STOPPED:])]
        self.assertGreater(mean[1], mean[0], "who is stopped skips, and the others do not wait")
        peak = self.resident_mb(self.viewer_pid(run))
        print(f"the viewer's peak: {peak:.0f} MB", flush=True)
        self.assertLess(peak, MOST_MB)
        metrics = self.get("metrics")
        self.assertIn(f"rds_map_occupied_voxels {expected[0]}\n", metrics)
        counted = int(next(line for line in metrics.splitlines() if line.startswith("rds_frame_seconds_count")).split()[1])
        self.assertTrue(0 < counted <= FRAMES, counted)
        for service in ("tracker", "detector", "transformer", "mapper", "loop-closer", "viewer"):
            self.assertIn(f'rds_service_cpu_seconds_total{{service="rds-{service}"}}', metrics)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(30), 0, self.log("run"))

    def test_browser_and_foxglove_on_fast_dds(self):
        self.check_browser_and_foxglove("fastdds")

    def test_browser_and_foxglove_on_cyclone_dds(self):
        self.check_browser_and_foxglove("cyclonedds", SHORT)

    def test_browser_and_foxglove_on_zenoh(self):
        if "Zenoh" not in subprocess.run([PROGRAMS / "rds", "--version"], capture_output=True, text=True, check=True).stdout:
            self.skipTest("built without Zenoh")
        self.check_browser_and_foxglove("zenoh", SHORT)

    def check_browser_and_foxglove(self, vendor, frames=FRAMES):
        self.need_node()
        recorded = self.folder / "bag.db3"
        record = self.start("record", PROGRAMS / "rds", "record", recorded, *RECORDED, "--bus", vendor, "--domain", DOMAIN, "--loopback")
        run, out = self.start_run("0.25", vendor, frames)  # so that the page is there before the run is over, however slowly it is drawn
        page = self.child("node", FOLDER / "page.mjs", self.url, PICTURES)
        programs = {name: self.child("node", FOLDER / "foxglove.mjs", f"ws://127.0.0.1:{self.port}", name) for name in ("foxglove.sdk.v1", "foxglove.websocket.v1")}
        for program in programs.values():
            self.assertEqual(program.read()["channels"], 16)
        ready = page.read()
        boxes = 0
        pictures = False
        while "the page stays" not in self.log("run") and run.poll() is None:
            stats = page.ask("stats")
            boxes = max(boxes, stats["boxes"])
            pictures = pictures or stats["picture"]
            time.sleep(0.3)
        self.wait_for_results()
        info = self.map_info(out)
        wait_for(lambda: page.ask("stats")["voxels"] == int(info["occupied_voxels"]), f"{info}, on the page {page.ask('stats')}", 20)
        stats = page.ask("stats")
        print(stats, ready, flush=True)
        self.assertEqual(stats["keySum"], int(info["occupied_key_sum"]))
        self.assertEqual(stats["errors"], [])
        self.assertTrue(stats["complete"])
        self.assertEqual(stats["objects"], len(json.loads((out / "objects.json").read_text())))
        for what in ("labelled", "labels", "objects", "path", "services"):
            self.assertGreater(stats[what], 0, what)
        self.assertGreater(boxes, 0, "nobody passed")
        self.assertTrue(pictures)
        self.assertEqual(int(stats["keyframes"]), sum(not line.startswith("#") for line in (out / "keyframes.txt").read_text().splitlines()))
        self.check_opening(page.ask("open"), stats["voxels"])
        page.ask(f"shot {vendor} 1440 900")
        if vendor == "fastdds":
            page.ask("shot phone 390 780 color=label&layers=voxels,path,camera,objects,names")
        self.assertEqual(page.ask("stats")["errors"], [])
        record.send_signal(signal.SIGINT)
        record.wait(30)
        self.check_foxglove(programs, recorded)
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(30), 0, self.log("run"))

    def check_opening(self, opened, voxels):
        """The first picture is that of the map, and waits for nothing else."""
        print("opened again:", opened["times"], opened["waits"], flush=True)
        self.assertEqual(opened["kinds"][:2], [HELLO, MAP])
        self.assertEqual(opened["voxels"], voxels, "in the first picture")
        self.assertEqual(sorted(opened["asked"]), sorted(opened["named"]), "each file is asked for once, when index.html is there")

    def check_foxglove(self, programs, recorded):
        on_the_bus = {}
        with contextlib.closing(sqlite3.connect(recorded)) as bag:
            for topic, data in bag.execute("SELECT t.name, m.data FROM messages m JOIN topics t ON m.topic_id = t.id"):
                on_the_bus.setdefault(topic, set()).add(hashlib.sha256(data).hexdigest())
        for protocol, program in programs.items():
            program.process.stdin.close()
            heard = json.loads(program.process.stdout.readline())
            self.assertNotIn("error", heard)
            self.assertEqual(heard.pop("server")["capabilities"], [])
            for topic, of in heard.items():
                self.assertNotIn("error", of, topic)
                self.assertEqual((of["encoding"], of["schemaEncoding"]), ("cdr", "ros2msg"))
            for name in RECORDED:
                topic = "/" + name
                self.assertGreater(heard[topic]["messages"], 0, f"{topic} by {protocol}")
                self.assertLessEqual(set(heard[topic]["sha256"]), on_the_bus[topic], f"{topic}: other bytes than on the bus")
            self.assertGreater(heard["/camera/color/image_raw"]["messages"], 0)
            newest = heard["/rds/map/points"]["newest"]
            self.assertGreater(newest["width"], 0)
            self.assertEqual(newest["data"]["length"], newest["width"] * newest["point_step"])
            self.assertGreater(heard["/rds/map/grid"]["newest"]["data"]["length"], 0)

    # ---- who may connect

    def start_viewer(self, *options, name="viewer", domain=DOMAIN, environment=None):
        viewer = self.start(name, PROGRAMS / "rds-viewer", "--domain", domain, "--loopback", *options, environment=environment)
        wait_for(lambda: "the page is at" in self.log(name) or viewer.poll() is not None, "the page")
        return viewer

    def refused(self, **options):
        with self.assertRaises(Refused) as refusal:
            WebSocket(self.port, **options)
        return str(refusal.exception)

    def test_who_may_connect(self):
        self.start_viewer("--listen", self.port)
        self.assertIn("<!doctype html>", self.get(""))
        for path in ("../../etc/passwd", "%2e%2e/x", "x", "viewer.yaml"):
            with self.assertRaises(urllib.error.HTTPError) as answer:
                self.get(path)
            self.assertIn(answer.exception.code, (400, 404), path)
            answer.exception.close()
        self.assertIn(" 403 ", self.refused(headers=["Origin: https://elsewhere.example"]))
        self.assertIn(" 400 ", self.refused(protocol="mqtt"))
        with self.assertRaises(urllib.error.HTTPError) as answer:
            self.get("metrics", {"Host": "elsewhere.example"})
        self.assertEqual(answer.exception.code, 403)
        answer.exception.close()
        page = WebSocket(self.port, headers=[f"Origin: http://127.0.0.1:{self.port}"])
        page.send('{"command": "reset"}')
        self.assertIn(b"not allowed", self.reply(page))
        page.close()
        twice = self.start_viewer("--listen", self.port, name="twice", domain=str(int(DOMAIN) + 1))
        self.assertEqual(twice.wait(30), 2)
        self.assertIn("cannot be listened on: Address already in use", self.log("twice"))

    def test_others_need_the_token(self):
        token = "0123456789abcdef0123"
        open_to_all = self.start_viewer("--listen", f"0.0.0.0:{self.port}", name="open_to_all")
        self.assertEqual(open_to_all.wait(30), 2)
        self.assertIn("expected a token", self.log("open_to_all"))
        self.start_viewer("--listen", f"0.0.0.0:{self.port}", environment={"RDS_VIEWER_TOKEN": token})
        self.assertIn("<!doctype html>", self.get(""))
        self.assertIn(" 401 ", self.refused())
        self.assertIn(" 401 ", self.refused(target=f"/socket?token={token[:-1]}"))
        self.assertIn(" 401 ", self.refused(protocol="foxglove.sdk.v1"))
        WebSocket(self.port, target=f"/socket?token={token}").close()
        self.assertIn("rds_tracking_state", self.get("metrics", {"Authorization": f"Bearer {token}"}))
        with self.assertRaises(urllib.error.HTTPError) as answer:
            self.get("metrics")
        answer.exception.close()

    def test_commands_reach_the_services_where_they_are_allowed(self):
        self.start("tracker", PROGRAMS / "rds-tracker", "--domain", DOMAIN, "--loopback")
        self.start_viewer("--listen", self.port, "--allow-commands")
        page = WebSocket(self.port)
        for _ in range(20):  # until the tracker is there
            page.send('{"command": "pause"}')
            reply = self.reply(page, limit_s=2)
            if reply:
                break
        self.assertIn(b'"success":true', reply)
        self.assertIn(b"rds-tracker", reply)
        page.close()

    def reply(self, page, limit_s=30):
        """The payload of the next reply; nothing after the limit."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            frame = page.receive()  # figures come once a second
            if frame[3] == 11:
                return frame[8:]
        return b""


if __name__ == "__main__":
    PICTURES.mkdir(parents=True, exist_ok=True)
    unittest.main()
