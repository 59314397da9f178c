// SPDX-License-Identifier: Apache-2.0
#include <random>

#include <gmock/gmock.h>

#include "common/mcap/encoding.hpp"
#include "tests/unit/common/mcap/memory_file.hpp"

namespace rds::mcap {
namespace {

using test::MemoryFile;
using test::Seen;
using testing::HasSubstr;

constexpr std::size_t kPrefix = kPrefixBytes;

Bytes noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % 7);
  return bytes;
}

/// Twelve messages of two topics, in chunks of about 2 kB.
struct Example {
  explicit Example(Compression compression = Compression::kLz4) {
    Writer writer({.compression = compression, .chunk_bytes = 2000, .library = "test"}, file.sink());
    const auto pictures = test::add_topic(writer, "/picture", "sensor_msgs/msg/Image");
    const auto states = test::add_topic(writer, "/state", "std_msgs/msg/String");
    for (unsigned i = 0; i < 12; ++i) {
      const bool is_picture = i % 3 == 0;
      const Bytes data = noise(is_picture ? 3000 : 100 * i, i);
      messages.emplace_back(is_picture ? "/picture" : "/state", 1000 + i, data);
      const std::uint16_t channel = is_picture ? pictures : states;
      EXPECT_TRUE(writer.write({channel, 0, 1000 + i, 1000 + i, data}));
      ends.push_back(file.size());
      waiting.push_back(writer.waiting_bytes());
    }
    EXPECT_TRUE(writer.finish());
  }
  MemoryFile file;
  Seen messages;
  std::vector<std::uint64_t> ends;  // of the file after each message
  std::vector<std::size_t> waiting;
};

class McapCompressions : public testing::TestWithParam<Compression> {};
INSTANTIATE_TEST_SUITE_P(All, McapCompressions,
                         testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd));

TEST_P(McapCompressions, AllMessagesComeBackInOrder) {
  const Example example(GetParam());
  Seen seen;
  const Scan scan = test::read_all(example.file, seen);
  EXPECT_EQ(seen, example.messages);
  EXPECT_TRUE(scan.complete);
  EXPECT_EQ(scan.damaged, 0U);
  EXPECT_EQ(scan.messages, 12U);
}

TEST_P(McapCompressions, ATornFileGivesAllThatWasWrittenBefore) {
  const Example example(GetParam());
  MemoryFile whole = example.file;
  std::size_t most = 0;
  for (std::size_t size = kMagic.size(); size < whole.bytes().size(); size += 7) {
    Seen seen;
    const Scan scan = test::read_all(MemoryFile(View(whole.bytes()).first(size)), seen);
    EXPECT_FALSE(scan.complete);
    EXPECT_EQ(scan.damaged, 0U) << size;
    EXPECT_TRUE(std::equal(seen.begin(), seen.end(), example.messages.begin())) << size;
    std::size_t promised = 0;  // messages whose chunk was given to the sink
    for (std::size_t i = 0; i < example.ends.size(); ++i)
      if (example.waiting[i] == 0 && example.ends[i] <= size) promised = i + 1;
    EXPECT_GE(seen.size(), promised) << size;
    most = std::max(most, seen.size());
  }
  EXPECT_EQ(most, 12U);
}

TEST_P(McapCompressions, DecompressionStopsAtTheAnnouncedSize) {
  const Bytes data = noise(300'000, 5);
  Bytes room(10, 0xab);  // of any content
  const View compressed = compress(data, GetParam(), room);
  const Bytes packed(compressed.begin(), compressed.end());
  EXPECT_EQ(decompress(packed, GetParam(), data.size()), data);
  EXPECT_FALSE(decompress(packed, GetParam(), data.size() - 1));
  EXPECT_FALSE(decompress(packed, GetParam(), data.size() + 1));
  EXPECT_FALSE(decompress(View(packed).first(packed.size() / 2), GetParam(), data.size()));
  EXPECT_EQ(decompress(compress({}, GetParam(), room), GetParam(), 0), Bytes());
}

TEST(Mcap, MessagesAreFoundAgainByTheirPlace) {
  const Example example;
  Reader reader(example.file);
  std::vector<Place> places;
  ASSERT_TRUE(reader.scan(
      [&](const Message&, const Channel&, const Schema*, const Place& place) { places.push_back(place); }));
  ASSERT_EQ(places.size(), example.messages.size());
  for (std::size_t i = places.size(); i-- > 0;)
    EXPECT_EQ(reader.data_at(places[i]), std::get<2>(example.messages[i]));
  EXPECT_FALSE(reader.data_at({places[0].record, 1}));
  EXPECT_FALSE(reader.data_at({example.file.size(), 0}));
}

TEST(Mcap, ADamagedChunkCostsItsMessagesOnly) {
  Example example;
  // Well inside the second chunk's compressed bytes.
  example.file.bytes()[example.ends[0] + 200] ^= 0xFFU;
  Seen seen;
  const Scan scan = test::read_all(example.file, seen);
  EXPECT_TRUE(scan.complete);
  EXPECT_EQ(scan.damaged, 1U);
  EXPECT_FALSE(scan.fault.empty());
  EXPECT_LT(seen.size(), 12U);
  ASSERT_GT(seen.size(), 6U);
  EXPECT_EQ(seen.back(), example.messages.back());
}

TEST(Mcap, MessagesOutsideChunksAreRead) {
  MemoryFile file{View(kMagic)};
  Bytes& out = file.bytes();
  append(out, Header{"ros2", "test"});
  append(out, Schema{1, "std_msgs/msg/String", "ros2msg", "string data\n"});
  append(out, Channel{7, 1, "/a", "cdr", {{"x", "y"}}});
  const Bytes data{1, 2, 3};
  append(out, Message{7, 1, 5, 6, data});
  Seen seen;
  const Scan scan = test::read_all(file, seen);
  EXPECT_EQ(seen, (Seen{{"/a", 5, data}}));
  EXPECT_FALSE(scan.complete);
  EXPECT_EQ(scan.good_bytes, file.size());
}

TEST(Mcap, AMessageOfAnUnknownChannelIsCountedAsDamage) {
  MemoryFile file{View(kMagic)};
  append(file.bytes(), Message{7, 1, 5, 6, {}});
  Seen seen;
  const Scan scan = test::read_all(file, seen);
  EXPECT_EQ(scan.damaged, 1U);
  EXPECT_TRUE(seen.empty());
}

TEST(Mcap, WhatIsNoMcapFileIsRefused) {
  Bytes text{'r', 'g', 'b', '.', 't', 'x', 't', '\n', 'x'};
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, text.size()}) {
    const MemoryFile file{View(text).first(size)};
    Reader reader(file);
    EXPECT_THAT(reader.scan([](auto&&...) {}).error(), HasSubstr("no MCAP file"));
  }
}

TEST(Mcap, AHugeLengthCostsNoMemory) {
  Example example;
  // The length of the second chunk's record.
  for (std::size_t i = 1; i < kPrefix; ++i) example.file.bytes()[example.ends[0] + i] = 0x7F;
  Seen seen;
  const Scan scan = test::read_all(example.file, seen);
  EXPECT_FALSE(scan.complete);
  EXPECT_EQ(scan.good_bytes, example.ends[0]);
  EXPECT_EQ(seen.size(), 1U);
}

TEST(Mcap, ARecordOverTheLimitIsLeftOut) {
  const Example example;
  Seen seen;
  const Scan scan = test::read_all(example.file, seen, {.max_record_bytes = 100});
  EXPECT_TRUE(seen.empty());
  EXPECT_GT(scan.damaged, 1U);
  EXPECT_THAT(scan.fault, HasSubstr("too long"));
}

TEST(Mcap, AnEmptyRecordingIsAWholeFile) {
  MemoryFile file;
  Writer writer({}, file.sink());
  ASSERT_TRUE(writer.end_chunk());
  Seen none;
  EXPECT_FALSE(test::read_all(file, none).complete) << "it is one from its beginning";
  ASSERT_TRUE(writer.finish());
  Seen seen;
  EXPECT_TRUE(test::read_all(file, seen).complete);
}

TEST(Mcap, AFaultOfTheSinkIsReported) {
  Writer writer({.chunk_bytes = 10}, [](View) { return tl::make_unexpected(std::string("disk full")); });
  const auto channel = test::add_topic(writer, "/a", "std_msgs/msg/String");
  const Bytes data(100);
  EXPECT_EQ(writer.write({channel, 0, 1, 1, data}).error(), "disk full");
}

}  // namespace
}  // namespace rds::mcap
