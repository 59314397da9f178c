// SPDX-License-Identifier: Apache-2.0
// A link of 20 Mbit/s, that pictures alone would need four times: what comes of them, and of the small
// messages beside them, on each bus. Prints a line for each.
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/hosts/host_network.hpp"

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr int kRateMbit = 20;
constexpr int kPictures = 100;
constexpr int kSmall = 500;

class NarrowLink : public ::testing::TestWithParam<std::string> {};

TEST_P(NarrowLink, CarriesPicturesBesideSmallMessages) {
  if (const std::string reason = HostNetwork::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  const HostNetwork network({"a", "b"}, {.rate_mbit = kRateMbit});
  const auto peer = [&](const std::string& host, const std::string& mode, const std::string& other) {
    return network.on(host, {RDS_NARROW_PEER, mode, GetParam(), "7", network.address(other)});
  };
  Process reader(peer("b", "read", "a"));
  Process writer(peer("a", "write", "b"));
  ASSERT_EQ(writer.wait(60s), 0) << writer.standard_error();
  ASSERT_EQ(reader.wait(60s), 0) << reader.standard_error();
  json line = json::parse(reader.standard_output());
  line.update(json::parse(writer.standard_output()));
  std::cout << GetParam() << " " << line << std::endl;
  RecordProperty("figures", line.dump());
  if (GetParam() != "zenoh") return;  // what DDS does there is only told
  EXPECT_GE(line["pictures"], kPictures / 5);
  EXPECT_GE(line["small"], kSmall * 98 / 100);
  EXPECT_LE(line["small_p50_ms"], 100.0);  // DDS' are at half a second
  EXPECT_LE(line["small_p99_ms"], 400.0);  // on a quiet machine below 100: README
}

#ifdef RDS_HAS_ZENOH
#define RDS_NARROW_VENDORS "fastdds", "cyclonedds", "zenoh"
#else
#define RDS_NARROW_VENDORS "fastdds", "cyclonedds"
#endif
INSTANTIATE_TEST_SUITE_P(On, NarrowLink, ::testing::Values(RDS_NARROW_VENDORS),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace rds::test
