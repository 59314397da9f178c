// SPDX-License-Identifier: Apache-2.0
// What anybody may write on the network, without the network: whatever is read is whole, and the rest is
// refused.
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "common/bus/zenoh/wire/zenoh_attachment.hpp"
#include "common/bus/zenoh/wire/zenoh_names.hpp"
#include "common/bus/zenoh/zenoh_graph.hpp"
#include "common/bus/zenoh/zenoh_inbox.hpp"
#include "sensor_msgs/msg/Image.h"

namespace rds::bus::detail {
namespace {

using sensor_msgs::msg::Image;

constexpr int kMutations = 100'000;
constexpr std::size_t kMostEndpoints = 10'000;
const std::string kHash = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";
const std::string kEndpoint = "/%/%robot/talker/%chatter/std_msgs::msg::dds_::String_/" + kHash;

/// Of this kind: NN, MP, MS, SS or SC.
std::string token_of(const std::string& kind, const std::string& entity = "10") {
  const std::string start = "@ros2_lv/2/8b20917502ee955ac4476e0266340d5c/0/" + entity + "/" + kind;
  return start + (kind == "NN" ? "/%/%robot/talker" : kEndpoint + "/::,7:,:,:,,");
}

/// Changes, inserts or removes up to four bytes.
template <class Bytes>
Bytes mutated(Bytes bytes, std::mt19937& random) {
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  for (std::size_t count = 1 + below(4); count > 0 && !bytes.empty(); --count) {
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size()));
    const auto byte = static_cast<typename Bytes::value_type>(below(256));
    switch (below(3)) {
      case 0:
        *at = byte;
        break;
      case 1:
        bytes.insert(at, byte);
        break;
      default:
        bytes.erase(at,
                    at + static_cast<std::ptrdiff_t>(1 + below(static_cast<std::size_t>(bytes.end() - at))));
    }
  }
  return bytes;
}

/// Hands `read` kMutations spoiled inputs of the seeds in turn; it returns whether it has accepted one.
/// @return how many were refused.
template <class Bytes, class Read>
int refused_of(const std::vector<Bytes>& seeds, Read read) {
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < kMutations; ++i)
    refused += read(mutated(seeds[static_cast<std::size_t>(i) % seeds.size()], random)) ? 0 : 1;
  return refused;
}

TEST(ZenohHostile, TokensAreReadWholeOrNot) {
  ZenohGraph graph(*session_guid("1"));
  const std::vector seeds{token_of("MP"), token_of("MS"), token_of("SS"), token_of("SC"), token_of("NN")};
  const int refused = refused_of(seeds, [&](const std::string& token) {
    graph.take(token, true);
    if (token.size() % 2 == 0) graph.take(token, false);
    const auto read = parse_endpoint_token(token);
    if (!read) return false;
    EXPECT_FALSE(read->endpoint.topic.empty());
    EXPECT_FALSE(read->endpoint.type.empty());
    EXPECT_TRUE(read->endpoint.type_hash.empty() || read->endpoint.type_hash.size() == kHash.size());
    EXPECT_FALSE(is_client_token(token));
    return true;
  });
  EXPECT_GT(refused, kMutations * 3 / 4) << "three of five seeds are no endpoints";
  EXPECT_LT(refused, kMutations);
  EXPECT_LE(graph.discovered().size(), static_cast<std::size_t>(kMutations - refused));
}

TEST(ZenohHostile, KeysSayAHashOrNone) {
  const std::vector seeds{"2/chatter/std_msgs::msg::dds_::String_/" + kHash,
                          "2/node/reset/std_srvs::srv::dds_::Trigger_/" + kHash, "2/" + kHash};
  const int refused = refused_of(seeds, [&](const std::string& key) {
    const std::string_view hash = type_hash_of_key(key);
    EXPECT_TRUE(hash.empty() || hash.size() == kHash.size());
    EXPECT_TRUE(key.ends_with(hash));
    return !hash.empty();
  });
  EXPECT_GT(refused, kMutations / 4);
  EXPECT_LT(refused, kMutations);
}

TEST(ZenohHostile, SessionsAreHexadecimalOrNone) {
  const int refused = refused_of(
      std::vector<std::string>{"8b20917502ee955ac4476e0266340d5c", "a"}, [](const std::string& id) {
        const bool hexadecimal = id.find_first_not_of("0123456789abcdef") == std::string::npos;
        EXPECT_EQ(session_guid(id).has_value(), hexadecimal && !id.empty() && id.size() <= 32);
        return hexadecimal;
      });
  EXPECT_GT(refused, kMutations / 4);
}

TEST(ZenohHostile, AttachmentsAreReadWholeOrNot) {
  const auto good = to_bytes({7, 1, gid_of_token(token_of("MP"))});
  SequenceGaps gaps;
  const std::vector<std::vector<std::uint8_t>> seeds{{good.begin(), good.end()}};
  const int refused = refused_of(seeds, [&](const std::vector<std::uint8_t>& bytes) {
    const auto read = parse_attachment(bytes);
    if (!read) return false;
    EXPECT_EQ(bytes.size(), kAttachmentSize);
    EXPECT_GE(read->sequence, 0);
    (void)gaps.count(*read);
    return true;
  });
  EXPECT_GT(refused, kMutations / 4);
  EXPECT_LT(refused, kMutations);
}

TEST(ZenohHostile, PayloadsAreReadWholeOrNot) {
  const TypeOps& type = type_ops<Image>();
  Image image;
  image.header().frame_id("camera");
  image.encoding("rgb8");
  image.data().resize(12);
  std::vector<std::uint8_t> good(type.encoded_size(&image));
  good.resize(type.encode(&image, good.data(), good.size()));
  Image read;
  const int refused =
      refused_of(std::vector<std::vector<std::uint8_t>>{good}, [&](const std::vector<std::uint8_t>& bytes) {
        if (!type.decode(bytes.data(), bytes.size(), &read)) return false;
        EXPECT_LE(read.data().size() + read.encoding().size() + read.header().frame_id().size(),
                  bytes.size());
        return true;
      });
  EXPECT_GT(refused, kMutations / 10);
  EXPECT_LT(refused, kMutations);
}

TEST(ZenohHostile, NobodyFillsTheMemoryWithNames) {
  ZenohGraph graph(*session_guid("1"));
  for (int i = 0; i < kMutations; ++i) {
    graph.take(token_of("MP", std::to_string(i)), true);
    graph.take(token_of("SC", std::to_string(i)), true);
  }
  EXPECT_EQ(graph.discovered().size(), kMostEndpoints);
}

TEST(ZenohHostile, NobodyFillsTheMemoryWithWhatWaits) {
  ZenohInbox<std::unique_ptr<int>> inbox(10);
  for (int i = 0; i < kMutations; ++i) inbox.push(std::make_unique<int>(i), 1);
  EXPECT_EQ(inbox.displaced(), kMutations - 10U);
  for (int i = 0; i < 3; ++i) inbox.push(std::make_unique<int>(i), kLargestMessage / 2);
  EXPECT_EQ(*inbox.pop(), 1) << "two of the large ones wait";
  inbox.push(std::make_unique<int>(9), 2 * kLargestMessage);
  EXPECT_EQ(*inbox.pop(), 9) << "the newest always does";
  EXPECT_EQ(inbox.pop(), nullptr);
}

}  // namespace
}  // namespace rds::bus::detail
