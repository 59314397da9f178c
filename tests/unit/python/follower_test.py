# SPDX-License-Identifier: Apache-2.0
"""Whatever order messages come in, the follower has the newest map that they allow."""

import unittest

import tree
from rds_map.follower import MOST_WAITING, Follower

A, B = (32768, 32768, 32768), (32768, 32768, 32770)
GREY = (90, 91, 92)
PAYLOAD = tree.path_to(A) + tree.node(1, GREY)
NODES = 17


class FollowerTest(unittest.TestCase):
    def setUp(self):
        self.follower = Follower()

    def place(self):
        return self.follower.voxels.map_id, self.follower.voxels.revision, len(self.follower.voxels)

    def test_a_full_map_waits_for_its_description(self):
        self.assertFalse(self.follower.take_full(tree.full(PAYLOAD)))
        self.assertFalse(self.follower.take_info(tree.info(5, NODES, sec=11)), "of another stamp")
        self.assertFalse(self.follower.take_info(tree.info(5, NODES, describes_full=False)))
        self.assertTrue(self.follower.take_info(tree.info(5, NODES)))
        self.assertEqual(self.place(), (7, 5, 1))

    def test_a_description_waits_for_its_full_map(self):
        self.assertFalse(self.follower.take_info(tree.info(5, NODES)))
        self.assertTrue(self.follower.take_full(tree.full(PAYLOAD)))
        self.assertEqual(self.place(), (7, 5, 1))

    def test_a_description_of_another_size_is_of_another_mapper(self):
        self.follower.take_info(tree.info(5, NODES + 1))
        self.assertFalse(self.follower.take_full(tree.full(PAYLOAD)))
        self.assertIsNone(self.follower.voxels)

    def test_deltas_that_come_early_wait(self):
        for base in (7, 6, 5):
            self.assertFalse(self.follower.take_delta(tree.delta(base, base + 1, [(B, base, 0, GREY)])))
        self.follower.take_full(tree.full(PAYLOAD))
        self.assertTrue(self.follower.take_info(tree.info(5, NODES)))
        self.assertEqual(self.place(), (7, 8, 2))

    def test_the_next_full_map_closes_a_gap(self):
        self.follower.take_delta(tree.delta(0, 1, [(B, 1, 0, GREY)]))
        self.assertFalse(self.follower.take_delta(tree.delta(2, 3, [(B, 2, 0, GREY)])))
        self.follower.take_info(tree.info(2, NODES))
        self.assertTrue(self.follower.take_full(tree.full(PAYLOAD)))
        self.assertEqual(self.place(), (7, 3, 2))

    def test_a_mapper_that_begins_anew_replaces_the_map(self):
        self.follower.take_delta(tree.delta(0, 9, [(A, 1, 0, GREY), (B, 1, 0, GREY)]))
        self.follower.take_info(tree.info(2, NODES, map_id=8))
        self.assertTrue(self.follower.take_full(tree.full(PAYLOAD)))
        self.assertEqual(self.place(), (8, 2, 1))
        self.assertFalse(self.follower.take_delta(tree.delta(9, 10, [(B, 1, 0, GREY)])), "of the old one")
        self.assertTrue(self.follower.take_delta(tree.delta(2, 3, [(B, 1, 0, GREY)], map_id=8)))

    def test_what_is_told_of_an_earlier_map_is_over(self):
        self.follower.take_info(tree.info(9, NODES, map_id=6))
        self.follower.take_info(tree.info(2, NODES, sec=12, map_id=7))
        self.assertFalse(self.follower.take_full(tree.full(PAYLOAD)), "its description was of map 6")

    def test_labels_are_told_beside_the_deltas(self):
        self.follower.take_delta(tree.delta(0, 1, [(A, 1, 2, GREY)]))
        self.assertEqual(self.follower.voxels.names.tolist(), [""])
        self.assertTrue(self.follower.take_info(tree.info(1, 0, describes_full=False)))
        self.assertEqual(self.follower.voxels.names.tolist(), ["cup"])
        self.assertFalse(self.follower.take_info(tree.info(1, 0, describes_full=False)))

    def test_malformed_messages_are_counted_with_a_sentence(self):
        self.follower.take_delta(tree.delta(0, 1, [(A, 1, 0, GREY)], colors=[1]))
        self.follower.take_info(tree.info(2, 16))
        self.follower.take_full(tree.full(PAYLOAD[:-8]))
        self.assertEqual(self.follower.rejected, {"rds/map/delta": 1, "rds/map/full": 1})
        self.assertIn("rds/map/full: a tree", self.follower.last_fault)
        self.assertIsNone(self.follower.voxels)

    def test_what_waits_is_bounded(self):
        for base in range(1, 2 * MOST_WAITING):
            self.follower.take_delta(tree.delta(base, base + 1))
        self.assertEqual(len(self.follower._waiting), MOST_WAITING)


if __name__ == "__main__":
    unittest.main()
