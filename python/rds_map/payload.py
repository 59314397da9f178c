# SPDX-License-Identifier: Apache-2.0
"""The payload of octomap_msgs/Octomap (ColorOcTree, binary = false): nodes of 8 bytes in depth-first order, a parent before
its children. Source: ColorOcTree::writeData of OctoMap (Hornung et al. 2013)."""

import numpy as np

from rds_map.cdr import MalformedMessage

NODE = np.dtype([("log_odds", "<f4"), ("color", "u1", 3), ("children", "u1")])
DEPTH = 16  # levels below the root
MOST_VOXELS = 100_000_000  # limits as the mapper has them (services/mapper/core/octree/tree_bytes.hpp)
FREE_VOXELS = 300_000
VOXELS_PER_BYTE = 64

_BITS = np.unpackbits(np.arange(256, dtype=np.uint8)[:, None], axis=1, bitorder="little")
_DEGREE = _BITS.sum(axis=1).astype(np.int64)
_OCTANT = np.argsort(1 - _BITS, axis=1, kind="stable")  # [children, n]: the n-th child that is there


def _families(degree):
    """Finds each node's parent: a node that is followed by as many leaves as it has children has these; without them it is a
    leaf itself.

    @return rounds of (children, parents, rank among its parent's children), lowest nodes first; indices of nodes.
    """
    degree = degree.copy()
    nodes = np.arange(degree.size)
    rounds = []
    while nodes.size > 1:
        wanted = degree[nodes]
        leaves_before = np.concatenate([[0], np.cumsum(wanted == 0)])
        inner = np.flatnonzero(wanted)
        inner = inner[inner + wanted[inner] < nodes.size]
        parents = inner[leaves_before[inner + 1 + wanted[inner]] - leaves_before[inner + 1] == wanted[inner]]
        if parents.size == 0:
            raise MalformedMessage("a tree whose nodes do not fit each other")
        if len(rounds) == DEPTH:
            raise MalformedMessage("a node below the finest level")
        count = wanted[parents]
        parent = np.repeat(parents, count)
        rank = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        child = parent + 1 + rank
        rounds.append((nodes[child], nodes[parent], rank))
        degree[nodes[parents]] = 0
        nodes = np.delete(nodes, child)
    if degree[0] != 0:
        raise MalformedMessage("a tree that ends before its last node")
    return rounds


def _places(nodes, rounds):
    """Keys of the lowest voxels, and depths, of all nodes."""
    keys = np.zeros((nodes.size, 3), np.uint16)
    depths = np.zeros(nodes.size, np.uint8)
    for children, parents, rank in reversed(rounds):
        octant = _OCTANT[nodes["children"][parents], rank]
        depths[children] = depths[parents] + 1
        half = np.left_shift(1, DEPTH - depths[children].astype(np.int64))
        keys[children] = keys[parents] + half[:, None] * (octant[:, None] >> [0, 1, 2] & 1)
    return keys, depths


def _expand(keys, depths, values, most):
    """A leaf above the finest level stands for all voxels below it."""
    sides = np.left_shift(1, DEPTH - depths.astype(np.int64))
    if (sides.astype(float)**3).sum() > most:
        raise MalformedMessage("leaves larger than any map")
    parts = []
    for side in np.unique(sides):
        of_side = np.flatnonzero(sides == side)
        offsets = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        parts.append(((keys[of_side, None, :] + offsets).reshape(-1, 3), np.repeat(values[of_side], len(offsets))))
    return np.concatenate([part[0] for part in parts]).astype(np.uint16), np.concatenate([part[1] for part in parts])


def voxels_of(payload):
    """@param payload  bytes.

    @return keys (N×3 uint16) and values (N: log_odds, color) of all voxels at the finest level, in no particular order.
    @raises MalformedMessage
    """
    if len(payload) % NODE.itemsize != 0:
        raise MalformedMessage(f"the tree ends after {len(payload)} bytes in the middle of a node")
    nodes = np.frombuffer(payload, NODE)
    if nodes.size == 0:
        return np.empty((0, 3), np.uint16), nodes
    if not np.isfinite(nodes["log_odds"]).all():
        raise MalformedMessage("log-odds that are not finite")
    degree = _DEGREE[nodes["children"]]
    keys, depths = _places(nodes, _families(degree))
    is_leaf = degree == 0
    most = min(MOST_VOXELS, FREE_VOXELS + VOXELS_PER_BYTE * len(payload))
    return _expand(keys[is_leaf], depths[is_leaf], nodes[is_leaf], most)
