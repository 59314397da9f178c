# SPDX-License-Identifier: Apache-2.0
"""Full map and deltas give the voxels of the newest revision; what does not fit is refused and changes nothing."""

import unittest

import numpy as np
import tree
from rds_map.cdr import MalformedMessage
from rds_map.labels import label_color
from rds_map.replica import Answer, Replica

A, B, C = (32768, 32768, 32768), (32768, 32768, 32770), (32767, 1, 2)
GREY = (90, 91, 92)


def first():
    return tree.delta(0, 1, [(B, -0.4, 0, GREY), (A, 0.85, 1, GREY)])


class ReplicaTest(unittest.TestCase):
    def setUp(self):
        self.replica = Replica()

    def values(self):
        voxels = self.replica.voxels
        return dict(zip(map(tuple, voxels.keys.tolist()), zip(voxels.log_odds.tolist(), voxels.labels.tolist())))

    def test_the_first_delta_begins_a_map(self):
        self.assertIs(self.replica.apply_delta(first()), Answer.APPLIED)
        voxels = self.replica.voxels
        self.assertEqual(voxels.keys.tolist(), [list(A), list(B)])
        self.assertEqual(voxels.occupied.tolist(), [True, False])
        np.testing.assert_array_equal(voxels.centers[0], [0.025] * 3)
        self.assertEqual((voxels.revision, voxels.map_id, voxels.resolution), (1, 7, 0.05))

    def test_a_delta_sets_adds_and_deletes(self):
        self.replica.apply_delta(first())
        before = self.replica.voxels
        self.replica.apply_delta(tree.delta(1, 4, [(C, 1.5, 0, GREY), (A, 2.0, 2, GREY)], deleted=[B]))
        self.assertEqual(self.values(), {C: (1.5, 0), A: (2.0, 2)})
        self.assertEqual(before.log_odds.tolist(), [np.float32(0.85), np.float32(-0.4)], "an older revision was written to")
        with self.assertRaises(ValueError):
            self.replica.voxels.log_odds[0] = 1

    def test_of_a_voxel_that_is_there_twice_the_last_counts(self):
        self.replica.apply_delta(tree.delta(0, 1, [(A, 1.0, 1, GREY), (A, 2.0, 2, GREY)]))
        self.assertEqual(self.values(), {A: (2.0, 2)})

    def test_what_does_not_follow_is_left(self):
        self.assertIs(self.replica.apply_delta(tree.delta(5, 6)), Answer.GAP)
        self.replica.apply_delta(first())
        self.assertIs(self.replica.apply_delta(first()), Answer.OLD)
        self.assertIs(self.replica.apply_delta(tree.delta(2, 3)), Answer.GAP)
        self.assertIs(self.replica.apply_delta(tree.delta(1, 2, map_id=8)), Answer.OTHER_MAP)
        self.assertEqual(self.replica.voxels.revision, 1)
        self.assertIs(self.replica.apply_delta(tree.delta(0, 1, map_id=8)), Answer.APPLIED)
        self.assertEqual((len(self.replica.voxels), self.replica.voxels.map_id), (0, 8))

    def test_a_full_map_tells_labels_by_colour_and_by_key(self):
        payload = tree.path_to(A, 15) + tree.node(0, (0, 0, 0), 0b111)
        payload += tree.node(1, label_color("chair")) + tree.node(-1, label_color("chair")) + tree.node(1, label_color("chair"))
        told = tree.info(6, 19, label_keys=[*A, *C], label_values=[2, 1])
        self.assertIs(self.replica.apply_full(tree.full(payload), told), Answer.APPLIED)
        x, y, z = A
        self.assertEqual(self.values(), {A: (1, 2), (x + 1, y, z): (-1, 0), (x, y + 1, z): (1, 1)})
        self.assertEqual(self.replica.voxels.names.tolist(), ["cup", "chair", ""])
        self.assertIs(self.replica.apply_full(tree.full(payload), told), Answer.OLD)

    def test_labels_of_no_table_have_the_colour_of_their_name(self):
        self.assertEqual(label_color("tv"), label_color("tvmonitor"))
        self.assertEqual(label_color("bicycle"), (122, 235, 62))  # as rds::mapper::label_color
        self.assertEqual(label_color(""), (255, 255, 255))

    def test_a_malformed_delta_changes_nothing(self):
        self.replica.apply_delta(first())
        voxel = [(A, 1.0, 0, GREY)]
        for spoiled in [{"keys": [1, 2]}, {"colors": [1]}, {"labels": [1, 2]}, {"log_odds": [float("nan")]}, {"log_odds": [1e9]},
                        {"resolution": 0.0}, {"resolution": 0.1}, {"resolution": float("nan")}, {"deleted_keys": [1]},
                        {"revision": 1}]:
            with self.subTest(spoiled), self.assertRaises(MalformedMessage):
                self.replica.apply_delta(tree.delta(1, **({"revision": 2, "voxels": voxel} | spoiled)))
        self.assertEqual((self.replica.voxels.revision, len(self.replica.voxels)), (1, 2))

    def test_a_malformed_full_map_changes_nothing(self):
        self.replica.apply_delta(first())
        payload = tree.path_to(A) + tree.node(1, GREY)
        for full, told in [({"binary": True}, {}), ({"id": "OcTree"}, {}), ({"resolution": -1.0}, {}), ({"resolution": 0.1}, {}),
                           ({}, {"label_keys": [1, 2]}), ({}, {"label_keys": [1, 2, 3], "label_values": [1, 2]})]:
            with self.subTest(f"{full} {told}"), self.assertRaises(MalformedMessage):
                self.replica.apply_full(tree.full(payload, **full), tree.info(9, 17, **told))
        with self.assertRaises(MalformedMessage):
            self.replica.apply_full(tree.full(payload[:-8]), tree.info(9, 16))
        self.assertEqual((self.replica.voxels.revision, len(self.replica.voxels)), (1, 2))


if __name__ == "__main__":
    unittest.main()
