#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Says `stop` when a person is within 1 m ahead of the robot, or when nobody can tell, and `go` otherwise.

An example, no safety function: people whom the network does not see are not there. Needs rds_map (pip install ./python).
"""

import argparse

import rds_map

AHEAD_M = 1.0
HALF_WIDTH_M = 0.4  # of the robot, with a margin
SILENCE_S = 0.5


def is_ahead(corners_in_camera):
    """@param corners_in_camera  8×3 [m], of a box; x right, z ahead."""
    low, high = corners_in_camera.min(axis=0), corners_in_camera.max(axis=0)
    return high[2] > 0 and low[2] < AHEAD_M and high[0] > -HALF_WIDTH_M and low[0] < HALF_WIDTH_M


def must_stop(robot):
    """@param robot  rds_map.Robot, or None where nothing is heard."""
    if robot is None or robot.pose is None or robot.boxes is None:
        return True
    corners = robot.pose.to_camera(robot.boxes.corners_of("person")).reshape(-1, 8, 3)
    return any(is_ahead(box) for box in corners)


def main():
    parser = argparse.ArgumentParser(description="Says stop when a person is within 1 m ahead.")
    parser.add_argument("--domain", type=int, help="default: ROS_DOMAIN_ID or 0")
    parser.add_argument("--loopback", action="store_true", help="this machine only, as rds run is")
    options = parser.parse_args()
    live = rds_map.LiveRobot(rds_map.Bus(options.domain, loopback=options.loopback))
    said = None
    while True:
        order = "stop" if must_stop(live.wait(SILENCE_S)) else "go"
        if order != said:
            print(order, flush=True)
        said = order


if __name__ == "__main__":
    main()
