#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints what is within 2 m of the robot, each time the map has changed. Needs rds_map (pip install ./python)."""

import argparse

import numpy as np
import rds_map


def report(voxels, position, radius_m):
    """One line: how many occupied voxels there are, and how near each kind of object is."""
    distances = np.linalg.norm(voxels.centers - position, axis=1)
    near = voxels.occupied & (distances < radius_m)
    line = f"revision {voxels.revision}: {np.count_nonzero(near)} voxels within {radius_m:g} m"
    for name in np.unique(voxels.names[near]):
        if name:
            line += f", {name} at {distances[near & (voxels.names == name)].min():.2f} m"
    return line


def main():
    parser = argparse.ArgumentParser(description="Prints what is near the robot.")
    parser.add_argument("--domain", type=int, help="default: ROS_DOMAIN_ID or 0")
    parser.add_argument("--loopback", action="store_true", help="this machine only, as rds run is")
    options = parser.parse_args()
    bus = rds_map.Bus(options.domain, loopback=options.loopback)
    live, robot = rds_map.LiveMap(bus), rds_map.LiveRobot(bus)
    for voxels in live:
        pose = robot.now().pose
        if pose is not None:
            print(report(voxels, pose.position, radius_m=2), flush=True)


if __name__ == "__main__":
    main()
