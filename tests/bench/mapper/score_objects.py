#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares objects.json of a run with the truth of `rds simulate`: right label, centre near enough, one id each.

score_objects.py DATASET OUT [--every N] [--range M] [--detections FILE]

The map is laid on the dataset's frame by its keyframes (rigid, least squares). A true object counts as to be found if in
at least --min-views of the frames (every N-th) its box in the picture is mostly there (--detections has a box of its label
with IoU >= 0.5, nearer than --range). What was found of an object that hardly showed is neither right nor wrong.
--labels-of FILE asks only for labels that a run's detections.jsonl has at all.

Two shares tell how right the labels of the voxels (map.ot) are, a voxel's width of tolerance:
labelled  of the occupied voxels in the true boxes of found objects, what they stand on left out: have a label that is
          true there
true      of the voxels that bear a found object's label, in its found box: lie in a true box of that label
"""
import argparse
import bisect
import json
import math
import pathlib
import struct

import numpy as np

# As maps show labels (services/mapper/core/octree/label_table.cpp).
COLORS = {
    "chair": (31, 119, 180), "sofa": (148, 103, 189), "diningtable": (255, 127, 14), "tvmonitor": (23, 190, 207),
    "bottle": (44, 160, 44), "pottedplant": (106, 191, 75)}


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


def world_from_map(out, poses):
    """Rotation and translation that lay the keyframes of a run on the true poses."""
    stamps, rows = poses
    _, keyframes = read_poses(out / "keyframes.txt")
    true = np.array([rows[min(bisect.bisect_left(stamps, k[0] - 1e-4), len(rows) - 1)][1:4] for k in keyframes])
    own = np.array([k[1:4] for k in keyframes])
    u, _, vt = np.linalg.svd((true - true.mean(0)).T @ (own - own.mean(0)))
    rotation = u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
    return rotation, true.mean(0) - rotation @ own.mean(0)


def read_map(path):
    """Centres [m] and colours of the occupied voxels of a ColorOcTree, and their width [m]."""
    header, _, data = path.read_bytes().partition(b"\ndata\n")
    width = float(header.split(b"\nres ")[1].split()[0])
    centers, colors, at = [], [], 0

    def read(center, half):
        nonlocal at
        log_odds, r, g, b, children = struct.unpack_from("<f4B", data, at)
        at += 8
        if children == 0 and log_odds > 0:
            side = np.arange(-half + width / 2, half, width)
            cells = np.stack(np.meshgrid(side, side, side), -1).reshape(-1, 3) + center
            centers.append(cells)
            colors.append(np.tile((r, g, b), (len(cells), 1)))
        for i in range(8):
            if children >> i & 1:
                read(center + np.where([i & 1, i & 2, i & 4], half / 2, -half / 2), half / 2)

    read(np.zeros(3), width * 2 ** 15)
    return np.concatenate(centers), np.concatenate(colors), width


def inside(points, thing, margin, above=0.0):
    """Points in a thing's box, grown by a margin; its lower face raised by `above` [m]."""
    low = np.array(thing["center"]) - np.array(thing["size"]) / 2 - margin
    high = np.array(thing["center"]) + np.array(thing["size"]) / 2 + margin
    return ((points >= low + (0, 0, above)) & (points <= high)).all(1)


def label_shares(out, truth, strange, found, match, frame):
    """Counts of voxels (right, all) for the two shares; what is in the boxes of strange things may be of them."""
    in_map, colors, width = read_map(out / "map.ot")
    rotation, translation = frame
    in_world = in_map @ rotation.T + translation
    bears = {label: (colors == color).all(1) for label, color in COLORS.items()}
    true = {label: np.zeros(len(in_map), bool) for label in COLORS}
    for thing in truth:
        true[thing["label"]] |= inside(in_world, thing, width)
    right = np.zeros(len(in_map), bool)
    for label in COLORS:
        right |= bears[label] & true[label]
    asked = np.zeros(len(in_map), bool)
    for i in match:
        asked |= inside(in_world, truth[i], 0.0, above=width)
    for thing in strange:
        asked &= ~inside(in_world, thing, width)
    borne = np.zeros(len(in_map), bool)
    for j in match.values():
        borne |= bears[found[j]["label"]] & inside(in_map, found[j]["box"], 0.0)
    return ((right & asked).sum(), asked.sum()), ((right & borne).sum(), borne.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--detections", type=pathlib.Path, help="default: DATASET/detections_truth.jsonl")
    parser.add_argument("--every", type=int, default=8)
    parser.add_argument("--near", type=float, default=0.15, help="of the centres [m]")
    parser.add_argument("--range", type=float, default=4.0, help="[m]")
    parser.add_argument("--min-views", type=int, default=5)
    parser.add_argument("--labels-of", type=pathlib.Path, help="detections.jsonl")
    args = parser.parse_args()
    truth = json.loads((args.dataset / "objects.json").read_text())
    found = [thing for thing in json.loads((args.out / "objects.json").read_text()) if not thing.get("gone")]
    lines = (args.detections or args.dataset / "detections_truth.jsonl").read_text().splitlines()
    frames = [json.loads(line) for line in lines[::args.every]]
    poses = read_poses(args.dataset / "groundtruth.txt")
    frame = world_from_map(args.out, poses)
    for thing in found:
        thing["box"] = {"center": thing["center"], "size": thing["size"]}  # in the map
        thing["center"] = [round(float(c), 4) for c in frame[0] @ np.array(thing["center"]) + frame[1]]
    strange = []
    if args.labels_of:
        known = {d["label"] for line in args.labels_of.read_text().splitlines() for d in json.loads(line)["detections"]}
        strange = [thing for thing in truth if thing["label"] not in known]
        truth = [thing for thing in truth if thing["label"] in known]
    counts = views(truth, frames, poses, read_camera(args.dataset / "camera.yaml"), args.range)
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

    if not match or not (args.out / "map.ot").exists():
        return
    for name, (good, count) in zip(("labelled", "true"), label_shares(args.out, truth, strange, found, match, frame)):
        print(f"{name} {good / max(1, count):.3f} of {count} voxels")


if __name__ == "__main__":
    main()
