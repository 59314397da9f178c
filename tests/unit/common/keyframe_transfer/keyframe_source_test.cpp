// SPDX-License-Identifier: Apache-2.0
// Keyframes by transfer over a real bus, in one process that pretends to be two machines.
#include "common/keyframe_transfer/keyframe_source.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zstd.h>

#include "common/keyframe_transfer/item_bytes.hpp"
#include "common/transfer/bus/item_server.hpp"
#include "tests/unit/common/bus/bus_test_support.hpp"
#include "tests/unit/common/keyframe_codec/example_pictures.hpp"
#include "tests/unit/common/transfer/bus/node.hpp"

namespace rds::keyframe_transfer {
namespace {

using rds_msgs::msg::KeyFrameCompressed;
using rds_msgs::msg::KeyFrameImages;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kEpoch = 77;
constexpr std::uint64_t kRobot = 1;  // not this machine
const std::string kInvalid = "rejected rds/transfer/offers: invalid";

KeyFrameCompressed keyframe(std::uint64_t id) {
  auto images = keyframe_codec::test::example_keyframe();
  images.map_epoch(kEpoch);
  images.keyframe_id(id);
  return keyframe_codec::KeyframeCompressor().compress(images).value();
}

Bytes torn(std::uint64_t id) {
  Bytes bytes = bytes_of(keyframe(id));
  bytes.resize(bytes.size() / 2);
  return bytes;
}

/// Of many more pixels than it says.
Bytes bomb(std::uint64_t id) {
  const Bytes zeros(std::size_t{100} << 20U);
  Bytes data(ZSTD_compressBound(zeros.size()));
  data.resize(ZSTD_compress(data.data(), data.size(), zeros.data(), zeros.size(), 1));
  auto message = keyframe(id);
  message.depth().data() = data;
  return bytes_of(message);
}

/// Of more pixels than a picture may have, and says so.
Bytes too_large(std::uint64_t id) {
  auto message = keyframe(id);
  message.depth().width(65'535);
  message.depth().height(65'535);
  return bytes_of(message);
}

TEST(KeyframeSource, CountsWhatIsNoKeyframeAndTakesTheOthers) {
  transfer::Node tracker(bus::Vendor::kFastDds, "tracker");
  transfer::Node mapper(bus::Vendor::kFastDds, "mapper");
  transfer::ItemServer server(tracker.context, topics::kTracker, transfer::kKeyframes,
                              {.memory_bytes = 10'000'000}, kRobot);
  bus::Inbox<KeyFrameImages> taken;
  const KeyframeSource<KeyFrameImages> source(
      mapper.context, topics::kMapper, [](auto) { return bus::Subscription(); }, taken.callback(),
      [] { return true; });
  const std::vector<std::function<Bytes()>> items{[] { return bytes_of(keyframe(0)); },
                                                  [] { return torn(1); },
                                                  [] { return bomb(2); },
                                                  [] { return too_large(3); },
                                                  [] { return bytes_of(keyframe(5)); },
                                                  [] { return Bytes(1000, 0xFF); },
                                                  [] { return bytes_of(keyframe(6)); }};
  for (std::size_t id = 0; id < items.size(); ++id)
    server.share(kEpoch, transfer::Stream::kKeyframeImages, id, items[id]);
  EXPECT_TRUE(bus::eventually([&] { return taken.size() == 2 && mapper.figure(kInvalid) == 5; }))
      << taken.size() << " taken, " << mapper.figure(kInvalid) << " counted";
}

}  // namespace
}  // namespace rds::keyframe_transfer
