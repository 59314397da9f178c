# SPDX-License-Identifier: Apache-2.0
"""The tree of octomap_msgs: voxels with their keys; what no tree can be is refused."""

import random
import unittest

import numpy as np
import tree
from rds_map.cdr import MalformedMessage
from rds_map.payload import voxels_of


class Payload(unittest.TestCase):
    def test_an_empty_tree_has_no_voxels(self):
        keys, values = voxels_of(b"")
        self.assertEqual((keys.shape, values.size), ((0, 3), 0))

    def test_one_voxel_has_its_key_and_values(self):
        keys, values = voxels_of(tree.path_to((32768, 5, 65535)) + tree.node(0.85, (1, 2, 3)))
        self.assertEqual(keys.tolist(), [[32768, 5, 65535]])
        self.assertEqual(values["log_odds"].tolist(), [np.float32(0.85)])
        self.assertEqual(values["color"].tolist(), [[1, 2, 3]])

    def test_brothers_and_cousins_keep_their_places(self):
        block = tree.path_to((8, 8, 8), 14) + tree.node(0, (0, 0, 0), 0b1000_0001)  # depth 14: sides of 4, at 8
        block += tree.node(0, (0, 0, 0), 0b0000_0110) + tree.node(1, (1, 0, 0)) + tree.node(2, (2, 0, 0))
        block += tree.node(0, (0, 0, 0), 0b1000_0000) + tree.node(3, (3, 0, 0))
        keys, values = voxels_of(block)
        found = dict(zip(map(tuple, keys.tolist()), values["log_odds"].tolist()))
        self.assertEqual(found, {(9, 8, 8): 1, (8, 9, 8): 2, (11, 11, 11): 3})

    def test_a_pruned_leaf_stands_for_its_voxels(self):
        keys, values = voxels_of(tree.path_to((16, 16, 16), 15) + tree.node(1, (9, 9, 9)))
        self.assertEqual(sorted(map(tuple, keys.tolist())), [(x, y, z) for x in (16, 17) for y in (16, 17) for z in (16, 17)])
        self.assertTrue((values["log_odds"] == 1).all())

    def test_refuses_what_is_no_tree(self):
        whole = tree.path_to((1, 2, 3)) + tree.node(1, (0, 0, 0))
        for spoiled, reason in [(whole[:-1], "middle of a node"), (whole[:-8], "do not fit|ends before"),
                                (whole + tree.node(1, (0, 0, 0)), "do not fit"),
                                (tree.node(1, (0, 0, 0)), "larger than any map"),
                                (tree.node(1, (0, 0, 0), 1), "ends before"),
                                (tree.path_to((0, 0, 0)) + tree.node(0, (0, 0, 0), 1) + tree.node(1, (0, 0, 0)), "below the finest"),
                                (tree.path_to((0, 0, 0)) + tree.node(float("nan"), (0, 0, 0)), "not finite")]:
            with self.assertRaisesRegex(MalformedMessage, reason):
                voxels_of(spoiled)

    def test_spoiled_trees_are_read_or_refused(self):
        dice = random.Random(2)
        whole = tree.path_to((8, 8, 8), 15) + tree.node(0, (0, 0, 0), 255) + 8 * tree.node(1, (5, 5, 5))
        refused = 0
        for _ in range(300):
            spoiled = bytearray(whole)
            spoiled[dice.randrange(len(spoiled))] = dice.randrange(256)
            try:
                keys, values = voxels_of(bytes(spoiled))
                self.assertEqual(len(keys), len(values))
            except MalformedMessage:
                refused += 1
        self.assertGreater(refused, 20)


if __name__ == "__main__":
    unittest.main()
