# SPDX-License-Identifier: Apache-2.0
"""Recordings beside readers and writers that are not ours: records_test.py RDS RECORDING

PyPI's mcap, mcap-ros2-support and rosbags read what `rds convert` makes of RECORDING, and `rds convert` reads what they
write: every message is equal byte for byte. Needs .venv-records in the project's root (tools/setup.sh --ros); skips
without.
"""

import itertools
import os
import pathlib
import sqlite3
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = ROOT / ".venv-records" / "bin" / "python"
if PYTHON.exists() and pathlib.Path(sys.prefix) != PYTHON.parents[1]:
    os.execv(PYTHON, [str(PYTHON), "-B", *sys.argv])
RDS = pathlib.Path(sys.argv.pop(1))
RECORDING = pathlib.Path(sys.argv.pop(1))
MOST_FRAMES = 40  # of the recording

try:
    import mcap.reader
    import mcap.writer
    import mcap_ros2.decoder
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
    from rosbags.rosbag2 import Reader, StoragePlugin, Writer
    from rosbags.rosbag2.enums import CompressionFormat, CompressionMode
    from rosbags.typesys import Stores, get_typestore

    WHY_NOT = ""
except ImportError as missing:
    WHY_NOT = f"no .venv-records ({missing}; tools/setup.sh --ros)"


def rds(*arguments):
    return subprocess.run([str(RDS), *map(str, arguments)], capture_output=True, text=True, timeout=300)


def convert(source, target, *options):
    result = rds("convert", source, target, *options)
    if result.returncode != 0 or not target.exists():
        raise AssertionError(result.stdout + result.stderr)
    return target


def short_copy(recording, folder):
    """The first frames of a folder in TUM form, its pictures linked."""
    folder.mkdir()
    for name in ("rgb", "depth"):
        (folder / name).symlink_to(recording / name)
        lines = (recording / f"{name}.txt").read_text().splitlines()
        data = [line for line in lines if line and not line.startswith("#")][:MOST_FRAMES]
        (folder / f"{name}.txt").write_text("\n".join(data) + "\n")
    for name in ("camera.yaml", "groundtruth.txt"):
        (folder / name).write_text((recording / name).read_text())
    return folder


def by_mcap(path):
    """(topic, type, log time, data) of all messages, with checksums verified."""
    with open(path, "rb") as file:
        reader = mcap.reader.make_reader(file, validate_crcs=True)
        return [(c.topic, s.name, m.log_time, m.data) for s, c, m in reader.iter_messages()]


def by_mcap_unindexed(path):
    with open(path, "rb") as file:
        reader = mcap.reader.NonSeekingReader(file, validate_crcs=True)
        return [(c.topic, s.name, m.log_time, m.data) for s, c, m in reader.iter_messages()]


def by_rosbags(path):
    with Reader(path) as reader:
        return [(c.topic, c.msgtype, time, bytes(data)) for c, time, data in reader.messages()]


def by_sqlite(path):
    with sqlite3.connect(path) as connection:
        return list(connection.execute("SELECT t.name, t.type, m.timestamp, m.data FROM messages m JOIN topics t ON t.id = m.topic_id ORDER BY timestamp, m.id"))


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Records(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(place.cleanup)
        cls.place = pathlib.Path(place.name)
        cls.tum = short_copy(RECORDING.resolve(), cls.place / "tum")
        cls.bag = convert(cls.tum, cls.place / "first.mcap")
        cls.messages = by_mcap(cls.bag)

    def assert_same(self, messages):
        """Messages of one time may stand in another order."""
        self.assertEqual(len(messages), len(self.messages))
        self.assertTrue(sorted(messages) == sorted(self.messages))

    def test_there_is_something_to_compare(self):
        self.assertGreater(len(self.messages), 3 * MOST_FRAMES)
        self.assertEqual({m[1] for m in self.messages}, {"sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "geometry_msgs/msg/PoseStamped"})

    def test_others_read_our_mcap(self):
        for compression in ("lz4", "zstd", "none"):
            with self.subTest(compression):
                path = convert(self.tum, self.place / f"{compression}.mcap", "--compression", compression)
                for read in (by_mcap, by_mcap_unindexed, by_rosbags):
                    self.assert_same(read(path))

    def test_others_read_our_sqlite(self):
        path = convert(self.tum, self.place / "ours.db3")
        for read in (by_sqlite, by_rosbags):
            self.assert_same(read(path))

    def test_others_decode_our_definitions(self):
        store = get_typestore(Stores.ROS2_JAZZY)
        with open(self.bag, "rb") as file:
            reader = mcap.reader.make_reader(file, decoder_factories=[mcap_ros2.decoder.DecoderFactory()])
            self.assertEqual(reader.get_header().profile, "ros2")
            decoded = {}
            for schema, _, message, ros in reader.iter_decoded_messages():
                self.assertEqual(schema.encoding, "ros2msg")
                again = store.deserialize_cdr(message.data, schema.name)
                self.assertEqual((again.header.stamp.sec, again.header.stamp.nanosec), (ros.header.stamp.sec, ros.header.stamp.nanosec))
                self.assertEqual(ros.header.stamp.sec * 10**9 + ros.header.stamp.nanosec, message.log_time)
                decoded[schema.name] = ros
        image, info = decoded["sensor_msgs/msg/Image"], decoded["sensor_msgs/msg/CameraInfo"]
        self.assertEqual((image.width, image.height), (info.width, info.height))
        self.assertEqual(info.distortion_model, "plumb_bob")

    def test_our_statistics_and_indexes_are_right(self):
        with open(self.bag, "rb") as file:
            summary = mcap.reader.make_reader(file).get_summary()
        statistics = summary.statistics
        self.assertEqual(statistics.message_count, len(self.messages))
        self.assertEqual(statistics.channel_count, len(summary.channels))
        self.assertEqual(statistics.schema_count, len(summary.schemas))
        self.assertEqual(statistics.chunk_count, len(summary.chunk_indexes))
        self.assertEqual(statistics.message_start_time, min(m[2] for m in self.messages))
        self.assertEqual(statistics.message_end_time, max(m[2] for m in self.messages))
        for channel in summary.channels.values():
            self.assertEqual(statistics.channel_message_counts[channel.id], sum(m[0] == channel.topic for m in self.messages))

    def test_our_type_hashes_are_those_of_ros(self):
        store = get_typestore(Stores.ROS2_JAZZY)
        with open(self.bag, "rb") as file:
            summary = mcap.reader.make_reader(file).get_summary()
        for channel in summary.channels.values():
            name = summary.schemas[channel.schema_id].name
            self.assertEqual(channel.metadata["topic_type_hash"], store.hash_rihs01(name), name)

    def test_our_qos_is_what_publishers_offer(self):
        with Reader(self.bag) as reader:
            for connection in reader.connections:
                self.assertEqual([(q.reliability, q.durability) for q in connection.ext.offered_qos_profiles], [(QosReliability.RELIABLE, QosDurability.VOLATILE)])

    def test_we_read_the_bags_of_rosbags(self):
        forever = QosTime(9223372036, 854775807)
        qos = Qos(QosHistory.KEEP_LAST, 5, QosReliability.RELIABLE, QosDurability.VOLATILE, forever, forever, QosLiveliness.AUTOMATIC, forever, False)
        plugins = [(StoragePlugin.SQLITE3, CompressionMode.NONE), (StoragePlugin.MCAP, CompressionMode.NONE), (StoragePlugin.MCAP, CompressionMode.STORAGE)]
        for version, (plugin, mode) in itertools.product((8, 9), plugins):
            with self.subTest(version=version, plugin=plugin.name, mode=mode.name):
                folder = self.place / f"rosbag_{version}_{plugin.name}_{mode.name}"
                writer = Writer(folder, version=version, storage_plugin=plugin)
                if mode != CompressionMode.NONE:
                    writer.set_compression(mode, CompressionFormat.ZSTD)
                store = get_typestore(Stores.ROS2_JAZZY)
                with writer:
                    topics = {}
                    for topic, kind, time, data in self.messages:
                        if topic not in topics:
                            topics[topic] = writer.add_connection(topic, kind, typestore=store, offered_qos_profiles=[qos])
                        writer.write(topics[topic], time, data)
                self.assert_same(by_mcap(convert(folder, folder.with_suffix(".mcap"))))
                self.assert_same(by_sqlite(convert(folder, folder.with_suffix(".db3"))))

    def test_we_read_the_files_of_mcap(self):
        compressions = mcap.writer.CompressionType
        for compression, chunks in itertools.product((compressions.NONE, compressions.LZ4, compressions.ZSTD), (True, False)):
            with self.subTest(compression=compression.name, chunks=chunks):
                path = self.place / f"theirs_{compression.name}_{chunks}.mcap"
                with open(path, "wb") as file:
                    writer = mcap.writer.Writer(file, compression=compression, use_chunking=chunks, chunk_size=3_000_000)
                    writer.start("ros2", "test")
                    channels = {}
                    for topic, kind, time, data in self.messages:
                        if topic not in channels:
                            schema = writer.register_schema(kind, "ros2msg", b"# nothing")
                            channels[topic] = writer.register_channel(topic, "cdr", schema)
                        writer.add_message(channels[topic], time, data, time)
                    writer.add_attachment(time, time, "note", "text/plain", b"text")
                    writer.add_metadata("note", {"a": "b"})
                    writer.finish()
                self.assert_same(by_mcap(convert(path, path.with_suffix(".again.mcap"))))

    def test_a_torn_file_is_recovered(self):
        path = self.place / "torn.mcap"
        whole = self.bag.read_bytes()
        path.write_bytes(whole[: len(whole) * 2 // 3])
        self.assertEqual(rds("record", "--recover", path).returncode, 0)
        messages = by_mcap(path)
        pictures = [sum(m[1] == "sensor_msgs/msg/Image" for m in all) for all in (messages, self.messages)]
        self.assertGreater(pictures[0], pictures[1] // 2)
        self.assertTrue(set(messages) <= set(self.messages))


if __name__ == "__main__":
    unittest.main()
