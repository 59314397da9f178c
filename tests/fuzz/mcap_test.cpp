// SPDX-License-Identifier: Apache-2.0
// Spoiled MCAP files: the reader does not crash, and takes no more memory than it declares.
#include <gmock/gmock.h>

#include "tests/fuzz/feed.hpp"
#include "tests/unit/common/mcap/memory_file.hpp"

namespace rds::fuzz {
namespace {

constexpr std::size_t kMostRecordBytes = 64 * 1024;
/// A record, and what it holds uncompressed, which is there twice while it grows; small things.
constexpr std::size_t kMemory = 4 * kMostRecordBytes;

std::size_t bound(std::size_t bytes) {
  return kMemory + 4 * bytes;
}

Bytes example(mcap::Compression compression) {
  mcap::test::MemoryFile file;
  mcap::Writer writer({.compression = compression, .chunk_bytes = 500, .library = "fuzz"}, file.sink());
  const auto a = mcap::test::add_topic(writer, "/a", "sensor_msgs/msg/Image");
  const auto b = mcap::test::add_topic(writer, "/b", "sensor_msgs/msg/CameraInfo");
  for (std::uint8_t i = 0; i < 9; ++i) {
    const Bytes data(40U * i, i);
    EXPECT_TRUE(writer.write({i % 2 == 0 ? a : b, 0, i, i, data}));
  }
  EXPECT_TRUE(writer.finish());
  return file.bytes();
}

TEST(Mcap, FilesOfAnyone) {
  feed(30,
       {example(mcap::Compression::kNone), example(mcap::Compression::kLz4),
        example(mcap::Compression::kZstd)},
       bound, [](const Bytes& bytes) {
         const mcap::test::MemoryFile file(bytes);
         mcap::Reader reader(file, {.max_record_bytes = kMostRecordBytes});
         mcap::Place last;
         std::uint64_t read = 0;
         const auto scan = reader.scan([&](const mcap::Message& message, const mcap::Channel&,
                                           const mcap::Schema*, const mcap::Place& place) {
           read += message.data.size();
           last = place;
         });
         if (!scan) return false;
         EXPECT_LE(scan->good_bytes, bytes.size());
         EXPECT_LE(read, scan->messages * kMostRecordBytes);
         EXPECT_TRUE(scan->messages == 0 || reader.data_at(last).has_value());
         return scan->complete && scan->damaged == 0;
       });
}

}  // namespace
}  // namespace rds::fuzz
