// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/common/messages/wire_recordings.hpp"

namespace rds::messages {
namespace {

#define SKIP_WITHOUT(recordings) \
  if ((recordings).empty())      \
  GTEST_SKIP() << "RDS_SHARED is not set, so there are no messages of an independent encoder (data/wire)"

/// The recordings list the constants of a message with its values; ours are not part of a message.
Json without_constants(const Json& json) {
  if (json.is_array()) {
    Json list = Json::array();
    for (const Json& element : json) list.push_back(without_constants(element));
    return list;
  }
  if (!json.is_object()) return json;
  Json object = Json::object();
  for (const auto& [key, value] : json.items()) {
    const bool constant =
        std::none_of(key.begin(), key.end(), [](unsigned char c) { return std::islower(c) != 0; });
    if (!constant) object[key] = without_constants(value);
  }
  return object;
}

TEST(Wire, ThereAreEighteenRecordings) {
  const auto recordings = wire_recordings();
  SKIP_WITHOUT(recordings);
  EXPECT_EQ(recordings.size(), 18U);
  for (const WireRecording& recording : recordings) EXPECT_NE(recording.type, nullptr) << recording.name;
}

TEST(Wire, MessagesDecodeToTheirValues) {
  const auto recordings = wire_recordings();
  SKIP_WITHOUT(recordings);
  for (const auto& [type, name, bytes, values] : recordings) {
    const MessagePtr message = make_message(*type);
    ASSERT_TRUE(type->ops->decode(bytes.data(), bytes.size(), message.get())) << name;
    EXPECT_EQ(type->to_json(message.get()), without_constants(values)) << name;
  }
}

TEST(Wire, ValuesEncodeToTheSameBytes) {
  const auto recordings = wire_recordings();
  SKIP_WITHOUT(recordings);
  for (const auto& [type, name, bytes, values] : recordings) {
    const MessagePtr message = make_message(*type);
    const auto result = type->from_json(values, message.get());
    ASSERT_TRUE(result.has_value()) << name << ": " << result.error();
    auto encoded = encode(*type, message.get());
    ASSERT_LE(encoded.size(), bytes.size()) << name;
    ASSERT_LT(bytes.size() - encoded.size(), 4U) << name;
    encoded.resize(bytes.size());  // some encoders pad to four bytes with zeros
    EXPECT_EQ(encoded, bytes) << name;
  }
}

TEST(Wire, EveryTruncationIsRefused) {
  const auto recordings = wire_recordings();
  SKIP_WITHOUT(recordings);
  for (const auto& [type, name, bytes, values] : recordings) {
    const MessagePtr message = make_message(*type);
    ASSERT_TRUE(type->ops->decode(bytes.data(), bytes.size(), message.get())) << name;
    const std::size_t whole = type->ops->encoded_size(message.get());
    for (std::size_t size = 0; size < whole; ++size) {
      const std::vector<std::uint8_t> torn(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(type->ops->decode(torn.data(), torn.size(), message.get())) << name << " cut to " << size;
    }
  }
}

/// What decodes encodes to no more than a small multiple of the bytes it came from.
TEST(Wire, MutationsNeverCrashAndNeverGrow) {
  const auto recordings = wire_recordings();
  SKIP_WITHOUT(recordings);
  std::mt19937 random(1);
  for (const auto& [type, name, bytes, values] : recordings) {
    for (int round = 0; round < 1500; ++round) {
      std::vector<std::uint8_t> mutated = bytes;
      const unsigned changes = 1 + random() % 4;
      for (unsigned i = 0; i < changes; ++i) {
        const std::uint8_t interesting[] = {0, 1, 127, 128, 255, static_cast<std::uint8_t>(random())};
        mutated[random() % mutated.size()] = interesting[random() % std::size(interesting)];
      }
      if (random() % 8 == 0) mutated.resize(random() % (mutated.size() + 8));
      const MessagePtr message = make_message(*type);
      if (!type->ops->decode(mutated.data(), mutated.size(), message.get())) continue;
      EXPECT_LE(type->ops->encoded_size(message.get()), 2 * mutated.size() + 16) << name;
    }
  }
}

TEST(Wire, OtherEncapsulationsAreRefused) {
  const auto recordings = wire_recordings();
  SKIP_WITHOUT(recordings);
  for (const auto& [type, name, bytes, values] : recordings) {
    const MessagePtr message = make_message(*type);
    for (const int kind : {2, 3, 6, 7, 8, 9, 10, 11, 255}) {  // parameter lists, XCDR2, nonsense
      std::vector<std::uint8_t> other = bytes;
      other[1] = static_cast<std::uint8_t>(kind);
      EXPECT_FALSE(type->ops->decode(other.data(), other.size(), message.get())) << name << " " << kind;
    }
  }
}

}  // namespace
}  // namespace rds::messages
