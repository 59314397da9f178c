# SPDX-License-Identifier: Apache-2.0
"""Messages as cyclonedds writes them are decoded; torn and spoiled ones are refused."""

import random
import unittest

import tree
from rds_map import messages
from rds_map.cdr import MalformedMessage, decode


def some_info():
    return messages.MapInfo(tree.HEADER, 5, True, 3, 7, 9, 0.05, 12, 4, [1.0, 2.0, 3.0], [4.0, 5.0, 6.0], ["", "Stühle"],
                            [1, 2, 3], [1], 100, 99, 0)


class Cdr(unittest.TestCase):
    def test_decodes_every_kind_of_field(self):
        told = tree.through_the_wire(some_info())
        self.assertEqual((told.header.stamp.sec, told.header.frame_id), (10, "map"))
        self.assertEqual((told.describes_full, told.map_id, told.resolution), (True, 7, 0.05))
        self.assertEqual(told.bounds_max.tolist(), [4, 5, 6])
        self.assertEqual(told.labels, ["", "Stühle"])
        self.assertEqual(told.label_keys.tolist(), [1, 2, 3])
        self.assertEqual((told.keyframes_integrated, told.keyframes_waiting), (100, 0))

    def test_decodes_what_a_big_endian_machine_writes(self):
        from cyclonedds.idl._support import Endianness
        told = decode(messages.MapInfo, some_info().serialize(endianness=Endianness.Big, use_version_2=False))
        self.assertEqual(told.label_keys.tolist(), [1, 2, 3])
        self.assertEqual(told.last_keyframe_id, 99)

    def test_an_empty_sequence_of_wide_numbers_moves_nothing(self):
        boxes = messages.PredictedBoxes(tree.HEADER, 1, 1, 1, [], [], [], [], [], [], [], [], [])
        self.assertEqual(tree.through_the_wire(boxes).velocities.size, 0)

    def test_refuses_every_torn_message(self):
        data = some_info().serialize(use_version_2=False)
        for size in range(len(data) - 7):  # the last number and what pads it
            with self.assertRaises(MalformedMessage):
                decode(messages.MapInfo, data[:size])

    def test_a_length_that_lies_takes_no_memory(self):
        data = bytearray(messages.Octomap(tree.HEADER, False, "", 0.05, []).serialize(use_version_2=False))
        at = len(data) - 4 - (-len(data) % 4)
        data[at:at + 4] = b"\xff\xff\xff\xff"
        with self.assertRaisesRegex(MalformedMessage, "4294967295 more were expected"):
            decode(messages.Octomap, bytes(data))

    def test_spoiled_bytes_are_decoded_or_refused(self):
        dice = random.Random(1)
        data = some_info().serialize(use_version_2=False)
        refused = 0
        for _ in range(2000):
            spoiled = bytearray(data)
            for _ in range(3):
                spoiled[dice.randrange(len(spoiled))] = dice.randrange(256)
            try:
                decode(messages.MapInfo, bytes(spoiled))
            except MalformedMessage:
                refused += 1
        self.assertGreater(refused, 100)


if __name__ == "__main__":
    unittest.main()
