#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares objects.json of a run with the truth of `rds simulate`: right label, centre near enough, one id each.

score_objects.py DATASET OUT [--every N] [--range M] [--detections FILE]

The map frame must be the dataset's (`rds run --poses DATASET/groundtruth.txt`, or map_sequence). A true object counts as
to be found if in at least --min-views of the frames (every N-th) its box in the picture is mostly there (--detections has a
box of its label with IoU >= 0.5, nearer than --range). What was found of an object that hardly showed is neither right
nor wrong.
"""
import argparse
import bisect
import json
import math
import pathlib


def read_camera(path):
    values = {}
    for line in path.read_text().splitlines():
        key, _, value = line.split("#")[0].partition(":")
        if value.strip() and "[" not in value:
            values[key.strip()] = float(value)
    return values


def read_poses(path):
    rows = [list(map(float, l.split())) for l in path.read_text().splitlines() if l and l[0] != "#"]
    return [r[0] for r in rows], rows


def to_camera(pose, point):
    _, tx, ty, tz, x, y, z, w = pose
    p = [point[0] - tx, point[1] - ty, point[2] - tz]
    r = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [sum(r[i][j] * p[i] for i in range(3)) for j in range(3)]


def box_in_picture(thing, pose, camera):
    xs, ys = [], []
    for corner in range(8):
        point = [c + s / 2 * (1 if corner >> axis & 1 else -1)
                 for axis, (c, s) in enumerate(zip(thing["center"], thing["size"]))]
        x, y, z = to_camera(pose, point)
        if z < 0.2:
            return None
        xs.append(camera["fx"] * x / z + camera["cx"])
        ys.append(camera["fy"] * y / z + camera["cy"])
    return [min(xs), min(ys), max(xs), max(ys)]


def iou(a, b):
    w = min(a[2], b[2]) - max(a[0], b[0])
    h = min(a[3], b[3]) - max(a[1], b[1])
    if w <= 0 or h <= 0:
        return 0.0
    area = lambda r: (r[2] - r[0]) * (r[3] - r[1])
    return w * h / (area(a) + area(b) - w * h)


def views(truth, frames, poses, camera, max_range):
    stamps, rows = poses
    counts = [0] * len(truth)
    for frame in frames:
        pose = rows[min(bisect.bisect_left(stamps, frame["stamp"] - 1e-4), len(rows) - 1)]
        for i, thing in enumerate(truth):
            box = box_in_picture(thing, pose, camera)
            counts[i] += box is not None and any(
                d["label"] == thing["label"] and d["depth_m"] < max_range and iou(d["box"], box) >= 0.5
                for d in frame["detections"])
    return counts


def pair(truth, found, near):
    """Nearest first; each truth and each found once."""
    pairs = sorted((math.dist(t["center"], f["center"]), i, j) for i, t in enumerate(truth)
                   for j, f in enumerate(found) if t["label"] == f["label"])
    match = {}
    for distance, i, j in pairs:
        if distance <= near and i not in match and j not in match.values():
            match[i] = j
    return match


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--detections", type=pathlib.Path, help="default: DATASET/detections_truth.jsonl")
    parser.add_argument("--every", type=int, default=8)
    parser.add_argument("--near", type=float, default=0.15, help="of the centres [m]")
    parser.add_argument("--range", type=float, default=4.0, help="[m]")
    parser.add_argument("--min-views", type=int, default=5)
    args = parser.parse_args()
    truth = json.loads((args.dataset / "objects.json").read_text())
    found = json.loads((args.out / "objects.json").read_text())
    lines = (args.detections or args.dataset / "detections_truth.jsonl").read_text().splitlines()
    frames = [json.loads(line) for line in lines[::args.every]]
    counts = views(truth, frames, read_poses(args.dataset / "groundtruth.txt"), read_camera(args.dataset / "camera.yaml"),
                   args.range)
    match = pair(truth, found, args.near)
    wanted = {i for i, count in enumerate(counts) if count >= args.min_views}
    right = wanted & match.keys()
    spare = {match[i] for i in match.keys() - wanted}
    hardly_shown = [thing for i, thing in enumerate(truth) if i not in wanted]
    wrong = [f for j, f in enumerate(found) if j not in match.values() and not any(
        f["label"] == t["label"] and math.dist(f["center"], t["center"]) < math.hypot(*t["size"]) / 2 for t in hardly_shown)]
    for i, thing in enumerate(truth):
        if i not in wanted and i not in match:
            continue
        near = min(((math.dist(thing["center"], f["center"]), f) for f in found if f["label"] == thing["label"]),
                   key=lambda pair: pair[0], default=(math.inf, None))
        print(f"{'ok  ' if i in match else 'MISS'} {thing['label']:12} views {counts[i]:4} distance {near[0]:.3f} "
              f"true size {thing['size']} found size {near[1] and near[1]['size']}")
    for thing in wrong:
        print(f"WRONG {thing['label']:12} at {thing['center']} size {thing['size']} observations {thing['observations']}")
    precision = len(right) / max(1, len(right) + len(wrong))
    recall = len(right) / max(1, len(wanted))
    f1 = 2 * precision * recall / max(1e-9, precision + recall)
    print(f"wanted {len(wanted)} right {len(right)} wrong {len(wrong)} unasked {len(spare)} "
          f"precision {precision:.3f} recall {recall:.3f} F1 {f1:.3f} "
          f"people {sum(f['label'] == 'person' for f in found)}")


if __name__ == "__main__":
    main()
